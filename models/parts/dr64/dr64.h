#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/parts/dr64/dr64_spec.h"

namespace dendro::dr64 {

/// Contents of the cards and their write masks.
struct State {
  std::vector<std::uint32_t> pixels;  ///< banks x 512 x 512 lores pixel words, row by row
  std::uint32_t mask_word = 0xFFFFFFFF, mask_lores = 0xFFFFFFFF, mask_hires = 0xFFFFFFFF;
};

/// What an access needs of the cards, and whether anything answers.
struct Work {
  bool answered = false;
  std::uint32_t cards = 0;  ///< bit c: card c takes part
  bool masked = false;      ///< a write with some write enables off
};

/// What the memory cards do; when they do it is Timing's business. Sources in README.md.
class Core {
 public:
  explicit Core(const Spec& spec);

  /// Which cards an access would take. Changes nothing.
  Work probe(std::uint32_t address, unsigned function, bool write) const;
  std::uint32_t read(std::uint32_t address, unsigned function) const;
  void write(std::uint32_t address, std::uint32_t data, unsigned function);

  /// Lores pixel that an access touches, y x 512 + x within its bank (of a word access the first of eight); none when
  /// nothing answers or a mask is loaded.
  std::optional<std::size_t> touched(std::uint32_t address, unsigned function, bool write) const;

  /// Lores pixel as the display sees it: x, y in 0..511, bank 0.
  std::uint32_t lores(unsigned x, unsigned y) const { return state_.pixels[y * kWidth + x]; }
  /// Hires pixel, x, y in 0..1023, bank 0.
  std::uint32_t hires(unsigned x, unsigned y) const;

  const Spec& spec() const { return spec_; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  bool pixel_index(std::uint32_t address, bool hires, std::size_t& index, unsigned& nibble_bit) const;

  Spec spec_;
  State state_;
};

}  // namespace dendro::dr64
