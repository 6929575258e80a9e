#pragma once

#include <string>
#include <vector>

#include "sim/scene/image_io.h"

namespace dendro::scene {

/// How one direction of a chart is written.
struct ChartAxis {
  std::string label;
  bool logarithmic = false;             ///< only when all values are positive
  std::vector<std::string> categories;  ///< not empty: values are indices of these, evenly spaced
  double low = 0, high = 0;             ///< low < high: the scale of a line chart reaches over both
  std::string zero = {};                ///< logarithmic x only: what stands under the place, left of the scale, for 0
};

/// One curve; a value that is not finite leaves a gap.
struct ChartSeries {
  std::string name;
  std::vector<double> x, y;
  std::vector<std::string> labels = {};  ///< not empty: beside the points, which are not joined then
};

struct LineChart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;
};

/// A grid of values; those that are not finite stay grey.
struct HeatMap {
  std::string title;
  ChartAxis x, y;              ///< categories name every column and every row
  std::string value_label;
  std::vector<double> values;  ///< row by row, the first row at the bottom
};

/// Curves with axes, round numbers at the marks and a legend when there are several.
RgbImage draw(const LineChart& chart);

/// Cells in false colours with a colour bar.
RgbImage draw(const HeatMap& map);

/// A picture of one value per pixel in false colours, pixel for pixel, with a labelled colour bar below. The scale ends
/// at the 99th percentile of the values above zero; a `+` behind its end says that there are larger ones.
RgbImage draw_per_pixel(int width, int height, const std::vector<float>& values, const std::string& label);

/// Up to about `count` round numbers (1, 2 or 5 times a power of ten) inside [low, high].
std::vector<double> round_marks(double low, double high, int count);

/// "1200", "0.05", "3e+07": short forms for marks.
std::string short_number(double value);

}  // namespace dendro::scene
