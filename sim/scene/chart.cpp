#include "sim/scene/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "sim/scene/canvas.h"

namespace dendro::scene {
namespace {

constexpr int kWidth = 900, kHeight = 560;
constexpr int kLeft = 120, kRight = 30, kTop = 50, kBottom = 80;
constexpr int kBarRoom = 150;  // right of a heat map
constexpr int kZeroRoom = 130;  // left of a logarithmic scale that has a place for 0
constexpr Colour kInk = {40, 40, 40}, kGrid = {225, 225, 225}, kNothing = {200, 200, 200};
constexpr Colour kCurves[] = {{31, 119, 180}, {214, 39, 40},  {44, 160, 44},
                              {148, 103, 189}, {255, 127, 14}, {23, 190, 207}};

/// Maps values of one axis to pixels.
struct Scale {
  double low = 0, high = 1;
  bool logarithmic = false;
  double from = 0, to = 1;
  double zero_at = std::numeric_limits<double>::quiet_NaN();  ///< where 0 stands on a logarithmic scale

  double share(double v) const {
    return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
  }
  double at(double v) const { return logarithmic && v == 0 ? zero_at : from + share(v) * (to - from); }
};

std::string cut(const std::string& text, int pixels, int scale) {
  const auto fits = static_cast<std::size_t>(std::max(pixels / (6 * scale), 1));
  return text.size() <= fits ? text : text.substr(0, fits - 1) + "~";
}

Scale scale_of(const std::vector<double>& values, const ChartAxis& axis, bool from_zero) {
  Scale scale;
  if (!axis.categories.empty()) {
    scale.low = -0.5;
    scale.high = static_cast<double>(axis.categories.size()) - 0.5;
    return scale;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  if (axis.low < axis.high) low = axis.low, high = axis.high;
  for (const double v : values) {
    if (!std::isfinite(v) || (v == 0 && !axis.zero.empty())) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (low > high) return scale;
  scale.logarithmic = axis.logarithmic && low > 0;
  if (scale.logarithmic) {
    const double room = low == high ? 2 : std::pow(high / low, 0.03);
    scale.low = low / room;
    scale.high = high * room;
    return scale;
  }
  if (from_zero && low >= 0) low = 0;
  const double room = low == high ? std::max(std::fabs(low) * 0.1, 1e-9) : (high - low) * 0.04;
  scale.low = low == 0 && from_zero ? 0 : low - room;
  scale.high = high + room;
  return scale;
}

std::vector<double> marks_of(const Scale& scale, const ChartAxis& axis, int count) {
  if (!axis.categories.empty()) {
    const auto n = axis.categories.size();
    const std::size_t every = (n + static_cast<std::size_t>(count) - 1) / static_cast<std::size_t>(count);
    std::vector<double> marks;
    for (std::size_t i = 0; i < n; i += every) marks.push_back(static_cast<double>(i));
    return marks;
  }
  if (!scale.logarithmic) return round_marks(scale.low, scale.high, count);
  std::vector<double> marks;
  const bool fine = scale.high / scale.low < 200;
  for (double decade = std::pow(10, std::floor(std::log10(scale.low))); decade <= scale.high; decade *= 10)
    for (const double m : {1.0, 2.0, 5.0})
      if ((m == 1.0 || fine) && m * decade >= scale.low && m * decade <= scale.high) marks.push_back(m * decade);
  return marks;
}

std::string mark_text(double mark, const ChartAxis& axis) {
  return axis.categories.empty() ? short_number(mark) : axis.categories[static_cast<std::size_t>(mark)];
}

void draw_x_axis(Canvas& canvas, const Scale& scale, const ChartAxis& axis, int top, int bottom, bool grid) {
  const std::vector<double> marks = marks_of(scale, axis, 8);
  const double span = std::fabs(scale.to - scale.from);
  const int room = marks.empty() ? 0 : static_cast<int>(span / static_cast<double>(marks.size()));
  for (const double mark : marks) {
    const int x = static_cast<int>(std::lround(scale.at(mark)));
    if (grid) canvas.line(x, top, x, bottom, kGrid);
    canvas.line(x, bottom, x, bottom + 5, kInk);
    const std::string text = cut(mark_text(mark, axis), room, 2);
    canvas.text(x - Canvas::text_width(text) / 2, bottom + 10, text, kInk);
  }
  const int middle = static_cast<int>((scale.from + scale.to) / 2);
  canvas.text(middle - Canvas::text_width(axis.label) / 2, bottom + 42, axis.label, kInk);
}

/// Keeps the left end of the axis for values of 0.
void draw_zero(Canvas& canvas, Scale& x, const ChartAxis& axis) {
  x.zero_at = x.from + kZeroRoom / 3.0;
  x.from += kZeroRoom;
  const int bottom = kHeight - kBottom, at = static_cast<int>(x.zero_at), end = static_cast<int>(x.from);
  canvas.line(at, kTop, at, bottom, kGrid);
  for (int y = kTop; y < bottom; y += 10) canvas.line(end, y, end, std::min(y + 5, bottom), kInk);
  const std::string text = cut(axis.zero, kZeroRoom, 2);
  canvas.text(at - Canvas::text_width(text) / 2, bottom + 10, text, kInk);
}

void draw_y_axis(Canvas& canvas, const Scale& scale, const ChartAxis& axis, int left, int right, bool grid) {
  for (const double mark : marks_of(scale, axis, 7)) {
    const int y = static_cast<int>(std::lround(scale.at(mark)));
    if (grid) canvas.line(left, y, right, y, kGrid);
    canvas.line(left - 5, y, left, y, kInk);
    const std::string text = cut(mark_text(mark, axis), left - (axis.label.empty() ? 12 : 40), 2);
    canvas.text(left - 10 - Canvas::text_width(text), y - Canvas::text_height() / 2, text, kInk);
  }
  const int middle = static_cast<int>((scale.from + scale.to) / 2);
  canvas.text_upwards(8, middle + Canvas::text_width(axis.label) / 2, axis.label, kInk);
}

void draw_frame(Canvas& canvas, int left, int top, int right, int bottom) {
  canvas.line(left, top, right, top, kInk);
  canvas.line(left, bottom, right, bottom, kInk);
  canvas.line(left, top, left, bottom, kInk);
  canvas.line(right, top, right, bottom, kInk);
}

void draw_title(Canvas& canvas, const std::string& title) {
  const std::string text = cut(title, kWidth - 40, 2);
  canvas.text((kWidth - Canvas::text_width(text)) / 2, 18, text, kInk);
}

/// The row nearest to `wanted` in which a label covers no other one.
int free_row(std::map<int, std::string>& labels, int wanted, const std::string& text) {
  constexpr int kApart = 18;
  const auto covers = [&](int row) {
    for (auto at = labels.lower_bound(row - kApart + 1); at != labels.end() && at->first < row + kApart; ++at)
      if (at->second != text) return true;
    return false;
  };
  int away = 0;
  while (covers(wanted + away)) away = away > 0 ? -away : 1 - away;
  labels[wanted + away] = text;
  return wanted + away;
}

/// Separate points; those of later series are drawn around those of earlier ones, so that equal ones are all seen.
/// `labels` gathers where labels stand: one that would cover another moves away, the same at the same place stays.
void draw_points(Canvas& canvas, const ChartSeries& series, const Scale& x, const Scale& y, std::size_t index,
                 std::map<int, std::string>& labels) {
  const Colour& colour = kCurves[index % std::size(kCurves)];
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double px = x.at(series.x[i]), py = y.at(series.y[i]);
    if (!std::isfinite(px) || !std::isfinite(py)) continue;
    const int cx = static_cast<int>(std::lround(px)), cy = static_cast<int>(std::lround(py));
    const int r = 5 + 4 * static_cast<int>(index);
    if (index == 0) canvas.fill(cx - r, cy - r, cx + r + 1, cy + r + 1, colour);
    for (const int side : {-r, r}) {
      canvas.line(cx - r, cy + side, cx + r, cy + side, colour, 2);
      canvas.line(cx + side, cy - r, cx + side, cy + r, colour, 2);
    }
    const int width = Canvas::text_width(series.labels[i]);
    const int left = cx + 18 + width > kWidth - kRight ? cx - 18 - width : cx + 18;
    canvas.text(left, free_row(labels, cy, series.labels[i]) - Canvas::text_height() / 2, series.labels[i], kInk);
  }
}

void draw_series(Canvas& canvas, const ChartSeries& series, const Scale& x, const Scale& y, const Colour& colour) {
  bool joined = false;
  double last_x = 0, last_y = 0;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
      joined = false;
      continue;
    }
    const double px = x.at(series.x[i]), py = y.at(series.y[i]);
    if (joined) canvas.line(last_x, last_y, px, py, colour, 2);
    if (series.x.size() <= 100) {
      const int cx = static_cast<int>(std::lround(px)), cy = static_cast<int>(std::lround(py));
      canvas.fill(cx - 3, cy - 3, cx + 4, cy + 4, colour);
    }
    joined = true;
    last_x = px;
    last_y = py;
  }
}

/// How much of the curves lies in [left, right) x [top, bottom) of the picture.
int covered(const std::vector<ChartSeries>& series, const Scale& x, const Scale& y, const std::array<int, 4>& box) {
  constexpr int kSteps = 16;  // between two points of a curve
  int inside = 0;
  for (const ChartSeries& s : series)
    for (std::size_t i = 0; i < s.x.size(); ++i)
      for (int step = 0; step < kSteps; ++step) {
        const std::size_t next = s.labels.empty() ? std::min(i + 1, s.x.size() - 1) : i;
        const double t = static_cast<double>(step) / kSteps;
        const double px = x.at(s.x[i]) * (1 - t) + x.at(s.x[next]) * t;
        const double py = y.at(s.y[i]) * (1 - t) + y.at(s.y[next]) * t;
        inside += px >= box[0] && px < box[1] && py >= box[2] && py < box[3];
      }
  return inside;
}

/// In the corner where it covers least.
void draw_legend(Canvas& canvas, const std::vector<ChartSeries>& series, const Scale& x, const Scale& y) {
  if (series.size() < 2) return;
  std::size_t longest = 0;
  for (const ChartSeries& s : series) longest = std::max(longest, s.name.size());
  const int width = 52 + static_cast<int>(longest) * 12, height = 8 + 22 * static_cast<int>(series.size());
  std::array<int, 4> best{};
  int least = std::numeric_limits<int>::max();
  for (const int top : {kTop + 10, kHeight - kBottom - 10 - height})
    for (const int left : {kWidth - kRight - 8 - width, kLeft + 8}) {
      const std::array<int, 4> box{left, left + width, top, top + height};
      const int covers = covered(series, x, y, box);
      if (covers < least) least = covers, best = box;
    }
  canvas.fill(best[0], best[2], best[1], best[3], {255, 255, 255});
  for (std::size_t i = 0; i < series.size(); ++i) {
    const int row = best[2] + 8 + 22 * static_cast<int>(i);
    canvas.fill(best[0] + 6, row + 5, best[0] + 34, row + 9, kCurves[i % std::size(kCurves)]);
    canvas.text(best[0] + 42, row, series[i].name, kInk);
  }
}

std::pair<double, double> range_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return low > high ? std::pair(0.0, 1.0) : std::pair(low, high);
}

void draw_bar(Canvas& canvas, double low, double high, const std::string& label) {
  const int left = kWidth - kBarRoom + 20, right = left + 24, top = kTop, bottom = kHeight - kBottom;
  for (int y = top; y <= bottom; ++y)
    canvas.fill(left, y, right, y + 1, false_colour(static_cast<double>(bottom - y) / (bottom - top)));
  draw_frame(canvas, left, top, right, bottom);
  canvas.text(right + 8, top, short_number(high), kInk);
  canvas.text(right + 8, bottom - Canvas::text_height(), short_number(low), kInk);
  const std::string text = cut(label, bottom - top - 60, 2);
  canvas.text_upwards(right + 12, (top + bottom + Canvas::text_width(text)) / 2, text, kInk);
}

/// A few pixels at the ends of rows take so much that all others would look the same beside them, so the scale ends
/// where all but a hundredth of the pixels are that have anything.
float full_scale(const std::vector<float>& values) {
  std::vector<float> some;
  std::copy_if(values.begin(), values.end(), std::back_inserter(some), [](float v) { return v > 0; });
  if (some.empty()) return 0;
  const auto at = some.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(some.size() - 1));
  std::nth_element(some.begin(), at, some.end());
  return *at;
}

}  // namespace

std::vector<double> round_marks(double low, double high, int count) {
  const double rough = (high - low) / std::max(count, 1);
  if (!(rough > 0) || !std::isfinite(rough)) return {};
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  double step = decade * 10;
  for (const double m : {1.0, 2.0, 5.0})
    if (m * decade >= rough) {
      step = m * decade;
      break;
    }
  std::vector<double> marks;
  for (double n = std::ceil(low / step); n * step <= high + step * 1e-9; ++n) marks.push_back(n * step);
  return marks;
}

std::string short_number(double value) { return fmt::format("{:.4g}", value == 0 ? 0.0 : value); }

RgbImage draw(const LineChart& chart) {
  std::vector<double> xs, ys;
  for (const ChartSeries& s : chart.series) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
  }
  Canvas canvas(kWidth, kHeight);
  Scale x = scale_of(xs, chart.x, false), y = scale_of(ys, chart.y, true);
  x.from = kLeft;
  x.to = kWidth - kRight;
  y.from = kHeight - kBottom;
  y.to = kTop;
  draw_title(canvas, chart.title);
  if (x.logarithmic && !chart.x.zero.empty()) draw_zero(canvas, x, chart.x);
  draw_x_axis(canvas, x, chart.x, kTop, kHeight - kBottom, true);
  draw_y_axis(canvas, y, chart.y, kLeft, kWidth - kRight, true);
  draw_frame(canvas, kLeft, kTop, kWidth - kRight, kHeight - kBottom);
  std::map<int, std::string> labels;
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    if (chart.series[i].labels.empty())
      draw_series(canvas, chart.series[i], x, y, kCurves[i % std::size(kCurves)]);
    else
      draw_points(canvas, chart.series[i], x, y, i, labels);
  draw_legend(canvas, chart.series, x, y);
  return canvas.image();
}

RgbImage draw(const HeatMap& map) {
  const int columns = static_cast<int>(map.x.categories.size()), rows = static_cast<int>(map.y.categories.size());
  const auto [low, high] = range_of(map.values);
  Canvas canvas(kWidth, kHeight);
  Scale x = scale_of({}, map.x, false), y = scale_of({}, map.y, false);
  x.from = kLeft;
  x.to = kWidth - kBarRoom;
  y.from = kHeight - kBottom;
  y.to = kTop;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double v = map.values[static_cast<std::size_t>(row) * columns + column];
      const Colour colour = std::isfinite(v) ? false_colour(high > low ? (v - low) / (high - low) : 0.5) : kNothing;
      canvas.fill(static_cast<int>(std::lround(x.at(column - 0.5))), static_cast<int>(std::lround(y.at(row + 0.5))),
                  static_cast<int>(std::lround(x.at(column + 0.5))), static_cast<int>(std::lround(y.at(row - 0.5))),
                  colour);
    }
  draw_title(canvas, map.title);
  draw_x_axis(canvas, x, map.x, kTop, kHeight - kBottom, false);
  draw_y_axis(canvas, y, map.y, kLeft, kWidth - kBarRoom, false);
  draw_frame(canvas, kLeft, kTop, kWidth - kBarRoom, kHeight - kBottom);
  draw_bar(canvas, low, high, map.value_label);
  return canvas.image();
}

RgbImage draw_per_pixel(int width, int height, const std::vector<float>& values, const std::string& label) {
  constexpr int kRoom = 44;
  const float full = full_scale(values);
  Canvas canvas(width, height + kRoom);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float v = values[static_cast<std::size_t>(y) * width + x];
      canvas.set(x, y, false_colour(full > 0 ? v / full : 0));
    }
  for (int x = 0; x < width; ++x)
    canvas.fill(x, height + 4, x + 1, height + 18, false_colour(static_cast<double>(x) / std::max(width - 1, 1)));
  const bool above = std::any_of(values.begin(), values.end(), [&](float v) { return v > full; });
  const std::string end = short_number(full) + (above ? "+" : "");
  canvas.text(2, height + 24, "0", kInk);
  canvas.text(width - Canvas::text_width(end) - 2, height + 24, end, kInk);
  canvas.text((width - Canvas::text_width(label)) / 2, height + 24, label, kInk);
  return canvas.image();
}

}  // namespace dendro::scene
