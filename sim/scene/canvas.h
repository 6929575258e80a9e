#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "sim/scene/image_io.h"

namespace dendro::scene {

using Colour = std::array<std::uint8_t, 3>;

/// A white picture to draw on in pixels, x to the right, y down; what lies outside is cut off.
class Canvas {
 public:
  Canvas(int width, int height);

  void set(int x, int y, const Colour& colour);
  /// Columns [x0, x1), rows [y0, y1).
  void fill(int x0, int y0, int x1, int y1, const Colour& colour);
  /// Both ends included.
  void line(double x0, double y0, double x1, double y1, const Colour& colour, int thickness = 1);
  /// ASCII in letters of 5 x 7 dots, `scale` pixels each, from the upper left corner; other bytes become `?`.
  void text(int x, int y, const std::string& text, const Colour& colour, int scale = 2);
  /// Read from bottom to top; (x, y) is the lower left corner of the picture of the text.
  void text_upwards(int x, int y, const std::string& text, const Colour& colour, int scale = 2);

  static int text_width(const std::string& text, int scale = 2) { return static_cast<int>(text.size()) * 6 * scale; }
  static int text_height(int scale = 2) { return 7 * scale; }

  const RgbImage& image() const { return image_; }

 private:
  RgbImage image_;
};

/// The colour of a share in 0..1, dark violet to yellow, growing in lightness; shares outside are taken as the ends.
Colour false_colour(double share);

}  // namespace dendro::scene
