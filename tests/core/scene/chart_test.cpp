#include "sim/scene/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/scene/canvas.h"

namespace dendro::scene {
namespace {

Colour at(const RgbImage& image, int x, int y) {
  const auto* p = &image.rgb[std::size_t{3} * (static_cast<std::size_t>(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

int count(const RgbImage& image, const Colour& colour) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += at(image, x, y) == colour ? 1 : 0;
  return n;
}

TEST(Canvas, EveryPrintableLetterLooksDifferent) {
  std::map<std::vector<std::uint8_t>, char> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Canvas canvas(5, 7);
    canvas.text(0, 0, std::string(1, c), {0, 0, 0}, 1);
    const auto [other, fresh] = seen.emplace(canvas.image().rgb, c);
    EXPECT_TRUE(fresh) << c << " looks like " << other->second;
    if (c != ' ') {
      EXPECT_LT(0, count(canvas.image(), {0, 0, 0})) << c;
    }
  }
}

TEST(Canvas, TextUpwardsIsTheTextTurned) {
  Canvas across(12, 7), upwards(7, 12);
  across.text(0, 0, "Fg", {0, 0, 0}, 1);
  upwards.text_upwards(0, 12, "Fg", {0, 0, 0}, 1);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 12; ++x) EXPECT_EQ(at(across.image(), x, y), at(upwards.image(), y, 11 - x)) << x << " " << y;
}

TEST(Canvas, WhatLiesOutsideIsCutOff) {
  Canvas canvas(4, 4);
  canvas.line(-10, -10, 20, 20, {1, 2, 3}, 3);
  canvas.text(-3, 2, "XX", {1, 2, 3});
  EXPECT_EQ((Colour{1, 2, 3}), at(canvas.image(), 0, 0));
}

TEST(FalseColour, LightnessGrowsWithTheShare) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const Colour c = false_colour(i / 100.0);
    const double light = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_LT(last, light) << i;
    last = light;
  }
  EXPECT_EQ(false_colour(0), false_colour(-5));
  EXPECT_EQ(false_colour(1), false_colour(5));
}

TEST(Marks, AreRoundAndInside) {
  EXPECT_EQ((std::vector<double>{0, 20, 40, 60, 80, 100}), round_marks(0, 100, 7));
  EXPECT_EQ((std::vector<double>{-1, 0, 1}), round_marks(-1.4, 1.9, 4));
  EXPECT_TRUE(round_marks(3, 3, 5).empty());
}

/// Columns in which the curve's colour is, with its mean row.
std::map<int, double> curve(const RgbImage& image) {
  const Colour blue = {31, 119, 180};
  std::map<int, double> rows;
  for (int x = 0; x < image.width; ++x) {
    double sum = 0;
    int n = 0;
    for (int y = 0; y < image.height; ++y)
      if (at(image, x, y) == blue) {
        sum += y;
        ++n;
      }
    if (n > 0) rows[x] = sum / n;
  }
  return rows;
}

TEST(LineChart, AGrowingCurveRises) {
  LineChart chart{"t", {"x", false, {}}, {"y", false, {}}, {{"s", {1, 2, 3, 4}, {1, 2, 4, 8}}}};
  const auto rows = curve(draw(chart));
  ASSERT_LT(600u, rows.size());
  EXPECT_GT(rows.begin()->second, rows.rbegin()->second + 300) << "row 0 is on top";
}

TEST(LineChart, AGeometricRowIsStraightOnLogarithmicAxes) {
  LineChart chart{"t", {"x", true, {}}, {"y", true, {}}, {{"s", {1, 10, 100}, {2, 20, 200}}}};
  const auto rows = curve(draw(chart));
  const double first = rows.begin()->second, last = rows.rbegin()->second;
  const int x0 = rows.begin()->first, x1 = rows.rbegin()->first;
  for (const auto& [x, y] : rows)
    EXPECT_NEAR(first + (last - first) * (x - x0) / (x1 - x0), y, 4) << x;  // half a marker
}

TEST(LineChart, AMissingValueLeavesAGap) {
  LineChart chart{"t", {"x", false, {}}, {"y", false, {}}, {{"s", {1, 2, 3, 4, 5}, {1, 1, NAN, 1, 1}}}};
  const auto whole = curve(draw({"t", {"x", false, {}}, {"y", false, {}}, {{"s", {1, 2, 3, 4, 5}, {1, 1, 1, 1, 1}}}}));
  EXPECT_LT(curve(draw(chart)).size(), whole.size() * 3 / 4);
}

TEST(LineChart, ZeroHasAPlaceLeftOfALogarithmicScaleAndPointsWithLabelsStandAlone) {
  const LineChart chart{"t", {"x", true, {}, 0.001, 1, "none"}, {"y", true, {}}, {{"s", {0, 0.1}, {10, 10}, {"a", "b"}}}};
  const auto columns = curve(draw(chart));
  const int first = columns.begin()->first, last = columns.rbegin()->first;
  EXPECT_LT(first, 200);
  EXPECT_GT(last, 500);
  EXPECT_EQ(24u, columns.size()) << "two squares of 12 pixels, nothing between them";
}

TEST(LineChart, TheLegendStandsWhereNoCurveIs) {
  const Colour blue = {31, 119, 180};
  const std::vector<double> along = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  for (const auto& curves : {std::pair(std::vector<double>(9, 10), std::vector<double>(9, 9)),  // right of the middle
                             std::pair(along, std::vector<double>(9, 0))}) {
    const LineChart two{"t", {"x", false, {}}, {"y", false, {}}, {{"a", along, curves.first}, {"b", along, curves.second}}};
    const RgbImage image = draw(two);
    std::map<int, int> columns;
    for (int x = 0; x < image.width; ++x)
      for (int y = 0; y < image.height; ++y) columns[x] += at(image, x, y) == blue;
    int seen = 0;
    for (const auto& [x, n] : columns) seen += n > 0;
    EXPECT_LT(700, seen) << "the first curve from its beginning to its end";
  }
}

TEST(LineChart, LabelsOfNeighboursDoNotCoverEachOther) {
  const auto ink_rows = [](double second) {
    const RgbImage image = draw(LineChart{
        "t", {"x", true, {}, 1, 100}, {"y", true, {}, 1, 100}, {{"s", {10, 10}, {10, second}, {"XXX", "XXX!"}}}});
    std::map<int, int> rows;
    for (int y = 60; y < 470; ++y)
      for (int x = 510; x < 540; ++x) rows[y] += at(image, x, y) == Colour{40, 40, 40};
    return std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.second > 0; });
  };
  EXPECT_EQ(ink_rows(40), ink_rows(10)) << "as many rows of letters as when they are far apart";
}

TEST(HeatMap, CellsStandInTheirPlacesAndMissingOnesAreGrey) {
  HeatMap map{"t", {"x", false, {"a", "b"}}, {"y", false, {"c", "d"}}, "v", {0, 1, 2, NAN}};
  const RgbImage image = draw(map);
  // The first row is at the bottom; quarters of the drawing area.
  EXPECT_EQ(false_colour(0), at(image, 250, 400));
  EXPECT_EQ(false_colour(0.5), at(image, 600, 400));
  EXPECT_EQ(false_colour(1), at(image, 250, 150));
  EXPECT_EQ((Colour{200, 200, 200}), at(image, 600, 150));
}

TEST(PerPixel, EveryPixelHasTheColourOfItsShare) {
  const RgbImage image = draw_per_pixel(2, 2, {0, 5, 10, 10}, "n");
  EXPECT_EQ(false_colour(0), at(image, 0, 0));
  EXPECT_EQ(false_colour(0.5), at(image, 1, 0));
  EXPECT_EQ(false_colour(1), at(image, 0, 1));
}

}  // namespace
}  // namespace dendro::scene
