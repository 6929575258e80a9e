#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/parts/dr64/dr64.h"

namespace dendro::video {

enum class DisplayMode { kBlanked, kLores30, kLores60, kHires30 };

struct Spec {
  DisplayMode mode = DisplayMode::kLores30;
  std::int64_t phase_ps = 0;  ///< how far into its frame the display is at tick 0
};

constexpr unsigned kLutEntries = 1024;
constexpr unsigned kCrossbarLines = 34;

struct State {
  std::array<std::uint32_t, 8> fbc{};
  std::array<std::uint32_t, kLutEntries> lut{};
  std::array<std::uint8_t, kCrossbarLines> crossbar{};
  std::uint32_t luvo_crossbar = 0x24;
};

/// The registers after power-on for a display mode.
State power_on(DisplayMode mode);

/// The display's periodic times in picoseconds, worked out from the FBC registers. All zero: nothing is displayed.
struct Raster {
  std::int64_t line_ps = 0;
  std::int64_t field_lines = 0, blank_lines = 0;
  std::int64_t horizontal_blank_ps = 0;
  std::int64_t fetch_period_ps = 0;
  std::int64_t fetches_per_line = 0;

  std::int64_t field_ps() const { return field_lines * line_ps; }

  bool operator==(const Raster& o) const {
    return line_ps == o.line_ps && field_lines == o.field_lines && blank_lines == o.blank_lines &&
           horizontal_blank_ps == o.horizontal_blank_ps && fetch_period_ps == o.fetch_period_ps &&
           fetches_per_line == o.fetches_per_line;
  }
  bool operator!=(const Raster& o) const { return !(*this == o); }
};

Raster raster_of(const State& state, const Spec& spec, int fetch_bits);

/// 8-bit RGB of the visible area.
struct Frame {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

Frame monitor(const State& state, const dr64::Core& memory);

/// Which lores pixel of bank 0 (y x 512 + x) the monitor shows, or shows a part of, at each place of its Frame.
std::vector<std::uint32_t> shown_pixels(const State& state);

}  // namespace dendro::video
