#include "models/parts/video/video.h"

#include <algorithm>

namespace dendro::video {
namespace {

constexpr std::int64_t kFbcTickPs = 200000;  // the unit of the FBC's horizontal time [DER from BRL-C]

enum FbcRegister { kLocation, kSize, kWindow, kZoom, kRate, kControl };

constexpr std::uint32_t xy(unsigned x, unsigned y) { return (x & 0xFFFF) | (y & 0xFFFF) << 16; }
constexpr unsigned low(std::uint32_t reg) { return reg & 0xFFFF; }
constexpr unsigned high(std::uint32_t reg) { return reg >> 16; }

struct Control {
  bool hires, repeat_field;
  unsigned page, pixel_clock_ns;
};

Control control_of(const State& state) {
  const std::uint32_t c = state.fbc[kControl];
  return {(c >> 3 & 1) != 0, (c >> 10 & 1) != 0, c >> 7 & 1, c >> 16 & 0x3F};
}

// The window y that puts row 0 at the viewport's top [BRL-C].
int nominal_window_y(const Control& control, unsigned viewport_y) {
  const int y = static_cast<int>(viewport_y) + 4;
  if (control.hires) return -std::max(69, y) + 6;
  if (control.repeat_field) return -std::max(34, y / 2) + 3;
  return -std::max(35, y) + 7;
}

int window_y(const State& state) {
  const int y = static_cast<int>(high(state.fbc[kWindow]) & 0xFFF);
  return y >= 2048 ? y - 4096 : y;
}

/// The part of the frame buffer that the monitor shows.
class Window {
 public:
  explicit Window(const State& state)
      : control_(control_of(state)), zoom_x_(low(state.fbc[kZoom]) + 1), zoom_y_(high(state.fbc[kZoom]) + 1) {
    width = static_cast<int>(low(state.fbc[kSize])) + 1;
    height = (static_cast<int>(high(state.fbc[kSize])) + 1) / (control_.repeat_field ? 2 : 1);
    x0_ = low(state.fbc[kWindow]) / (control_.hires ? 1 : 4);
    y0_ = window_y(state) - nominal_window_y(control_, high(state.fbc[kLocation])) / static_cast<int>(zoom_y_);
  }

  /// Of the pixel at a place of the monitor.
  unsigned x(int px) const { return (x0_ + static_cast<unsigned>(px) / zoom_x_) % side(); }
  unsigned y(int py) const { return static_cast<unsigned>(y0_ + py / static_cast<int>(zoom_y_)) % side(); }
  const Control& control() const { return control_; }

  int width, height;

 private:
  unsigned side() const { return control_.hires ? 1024 : 512; }

  Control control_;
  unsigned zoom_x_, zoom_y_;
  unsigned x0_ = 0;
  int y0_ = 0;
};

std::uint32_t through_crossbar(const State& state, std::uint32_t pixel) {
  std::uint32_t out = 0;
  for (unsigned line = 0; line < 32; ++line) {
    const unsigned input = state.crossbar[line];
    if (input < 32) out |= ((pixel >> input) & 1u) << line;
  }
  return out;
}

}  // namespace

State power_on(DisplayMode mode) {
  State state;
  constexpr std::uint32_t kDrive = 1u << 24, kRs343 = 1u << 9, kRepeat = 1u << 10, kHires = 1u << 3;
  switch (mode) {
    case DisplayMode::kBlanked:
    case DisplayMode::kLores30:
      state.fbc = {xy(0, 32), xy(511, 511), xy(0, 4096 - 29), 0, xy(300, 560), kDrive | 45u << 16};
      break;
    case DisplayMode::kLores60:
      state.fbc = {xy(0, 68), xy(511, 1023), xy(0, 4096 - 33), 0, xy(144, 1143), kDrive | 18u << 16 | kRs343 | kRepeat};
      break;
    case DisplayMode::kHires30:
      state.fbc = {xy(0, 64), xy(1023, 1023), xy(0, 4096 - 63), 0, xy(144, 1144), kDrive | 19u << 16 | kRs343 | kHires};
      break;
  }
  for (unsigned i = 0; i < kLutEntries; ++i) {
    const std::uint32_t level = (i & 0xFF) * 4;
    state.lut[i] = level | level << 10 | level << 20;
  }
  for (unsigned line = 0; line < kCrossbarLines; ++line) state.crossbar[line] = static_cast<std::uint8_t>(line);
  return state;
}

Raster raster_of(const State& state, const Spec& spec, int fetch_bits) {
  Raster raster;
  const Control control = control_of(state);
  const std::int64_t line_ps = low(state.fbc[kRate]) * kFbcTickPs;
  const std::int64_t field_lines = high(state.fbc[kRate]) / 2;
  if (spec.mode == DisplayMode::kBlanked || line_ps == 0 || field_lines == 0 || control.pixel_clock_ns == 0)
    return raster;
  const std::int64_t pixels = low(state.fbc[kSize]) + 1;
  const std::int64_t pixel_ps = std::int64_t{control.pixel_clock_ns} * 1000 * (control.hires ? 1 : 2);
  const std::int64_t per_fetch = fetch_bits / (control.hires ? 2 : 8);
  raster.line_ps = line_ps;
  raster.field_lines = field_lines;
  raster.blank_lines = field_lines - std::min<std::int64_t>((high(state.fbc[kSize]) + 1) / 2, field_lines);
  raster.horizontal_blank_ps = std::max<std::int64_t>(0, line_ps - pixels * pixel_ps);
  raster.fetch_period_ps = per_fetch * pixel_ps;
  const std::int64_t room = line_ps - raster.horizontal_blank_ps;
  const std::int64_t fitting = (room + raster.fetch_period_ps - 1) / raster.fetch_period_ps;
  raster.fetches_per_line = std::min((pixels + per_fetch - 1) / per_fetch, fitting);
  return raster;
}

Frame monitor(const State& state, const dr64::Core& memory) {
  const Window window(state);
  const Control& control = window.control();
  Frame frame;
  frame.width = window.width;
  frame.height = window.height;
  frame.rgb.reserve(std::size_t{3} * frame.width * frame.height);
  for (int py = 0; py < frame.height; ++py) {
    const unsigned y = window.y(py);
    for (int px = 0; px < frame.width; ++px) {
      const unsigned x = window.x(px);
      const std::uint32_t lines =
          through_crossbar(state, control.hires ? memory.hires(x, y) : memory.lores(x, y));
      for (unsigned channel = 0; channel < 3; ++channel) {
        const unsigned byte = (state.luvo_crossbar >> (2 * channel)) & 3;
        const unsigned entry = ((lines >> (8 * byte)) & 0xFF) + 512 * control.page;
        frame.rgb.push_back(static_cast<std::uint8_t>((state.lut[entry] >> (10 * channel + 2)) & 0xFF));
      }
    }
  }
  return frame;
}

std::vector<std::uint32_t> shown_pixels(const State& state) {
  const Window window(state);
  const bool hires = window.control().hires;
  std::vector<std::uint32_t> shown;
  shown.reserve(static_cast<std::size_t>(window.width) * window.height);
  for (int py = 0; py < window.height; ++py) {
    const unsigned y = window.y(py);
    for (int px = 0; px < window.width; ++px) {
      const unsigned x = window.x(px);
      shown.push_back(hires ? y / 2 * dr64::kWidth + x / 4 + 256 * (y & 1) : y * dr64::kWidth + x);
    }
  }
  return shown;
}

}  // namespace dendro::video
