#pragma once

#include <cstdint>

namespace dendro::dr64 {

/// Image memory of 512x512 lores pixels. README.md is the data sheet.
struct Spec {
  unsigned cards_per_bank = 3;   ///< 3 or 4
  unsigned banks = 1;            ///< 1 or 2
  int card_busy_ticks = 2;
  int read_ticks = 4;            ///< grant to data usable, image memory
  int masked_write_extra_ticks = 0;
  int fetch_bits = 128;          ///< bits per video fetch and card
  int fetch_ticks = 2;           ///< 0: the display has its own slot
  std::int64_t refresh_interval_ps = 0;  ///< 0: the display scan refreshes

  unsigned cards() const { return cards_per_bank * banks; }
  std::uint32_t pixel_mask() const { return cards_per_bank == 4 ? 0xFFFFFFFFu : 0xFFFFFFu; }
};

constexpr unsigned kWidth = 512, kHeight = 512;  ///< lores pixels of a DR64 bank [NYU-H]

}  // namespace dendro::dr64
