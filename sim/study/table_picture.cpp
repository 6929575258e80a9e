#include "sim/study/table_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/scene/canvas.h"
#include "sim/scene/chart.h"

namespace dendro::study {
namespace {

using scene::Canvas;
using scene::Colour;

constexpr int kWidth = 1240, kLeft = 620, kRight = 30, kTop = 60, kBottom = 60, kLine = 26;
constexpr Colour kInk = {40, 40, 40}, kGrid = {225, 225, 225}, kInside = {44, 140, 60},
                 kOutside = {214, 39, 40};

bool is_drawn(const TableRow& row) {
  if (!row.simulated || !row.published || !row.low || *row.published <= 0 || *row.low <= 0) return false;
  return *row.low != *row.published || *row.high != *row.published;
}

/// Shares of the published value to columns.
struct Axis {
  double low = 0.5, high = 2;

  int column(double share) const {
    const double at = std::log(share / low) / std::log(high / low);
    return kLeft + static_cast<int>(std::lround(at * (kWidth - kLeft - kRight)));
  }
};

Axis axis_of(const std::vector<const TableRow*>& rows) {
  Axis axis;
  for (const TableRow* row : rows) {
    axis.low = std::min(axis.low, *row->low / *row->published);
    axis.high = std::max(axis.high, *row->high / *row->published);
  }
  axis.low /= 1.1, axis.high *= 1.1;
  return axis;
}

void draw_marks(Canvas& canvas, const Axis& axis, int bottom) {
  const bool fine = axis.high / axis.low < 100;
  for (double decade = std::pow(10, std::floor(std::log10(axis.low))); decade < axis.high; decade *= 10)
    for (const double m : {1.0, 2.0, 5.0}) {
      const double share = m * decade;
      if (share < axis.low || share > axis.high || (m != 1 && !fine)) continue;
      const int x = axis.column(share);
      canvas.line(x, kTop, x, bottom, std::abs(share - 1) < 1e-9 ? kInk : kGrid,
                  std::abs(share - 1) < 1e-9 ? 2 : 1);
      const std::string text = scene::short_number(share);
      canvas.text(x - Canvas::text_width(text) / 2, bottom + 8, text, kInk);
    }
}

void draw_row(Canvas& canvas, const Axis& axis, const TableRow& row, int y) {
  std::string label = row.id.substr(row.id.find('-') + 1) + " " + row.what;
  const std::size_t room = (kLeft - 30) / 12;
  if (label.size() > room) label = label.substr(0, room - 1) + "~";
  canvas.text(15, y - Canvas::text_height() / 2, label, kInk);
  const Colour& colour = row.inside() ? kInside : kOutside;
  const int from = axis.column(*row.low / *row.published), to = axis.column(*row.high / *row.published);
  canvas.fill(from, y - 4, std::max(to, from + 3), y + 5, colour);
  const int nominal = axis.column(*row.simulated / *row.published);
  canvas.fill(nominal - 1, y - 9, nominal + 2, y + 10, kInk);
}

}  // namespace

std::optional<scene::RgbImage> draw_table(const std::vector<TableRow>& rows) {
  std::vector<const TableRow*> drawn;
  std::size_t equal = 0;
  for (const TableRow& row : rows) {
    if (is_drawn(row)) drawn.push_back(&row);
    equal += row.simulated && row.published && row.low && *row.low == *row.published &&
             *row.high == *row.published;
  }
  if (drawn.empty()) return std::nullopt;
  const int bottom = kTop + kLine * static_cast<int>(drawn.size());
  Canvas canvas(kWidth, bottom + kBottom);
  const Axis axis = axis_of(drawn);
  canvas.text(
      15, 18,
      fmt::format("{}: simulated over published; bar: all assumptions, tick: nominal; {} rows are equal",
                  drawn.front()->paper, equal),
      kInk);
  draw_marks(canvas, axis, bottom);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    draw_row(canvas, axis, *drawn[i], kTop + kLine * static_cast<int>(i) + kLine / 2);
  return canvas.image();
}

}  // namespace dendro::study
