#include "firmware/zbuffer_views/reference/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "firmware/zbuffer_views/reference/raster.h"
#include "sim/base/random.h"

namespace dendro::zbuffer_views {
namespace {

std::vector<Fragment> fragments(const std::vector<double>& depths) {
  std::vector<Fragment> list;
  for (const double z : depths) list.push_back({0, static_cast<std::uint32_t>(list.size()), z});
  return list;
}

std::vector<double> depths(const std::vector<Fragment>& stored) {
  std::vector<double> list;
  for (const Fragment& f : stored) list.push_back(f.z);
  return list;
}

// MO95-K3
TEST(Layers, InsertingDependsOnTheOrderAndPeelingDoesNot) {
  EXPECT_EQ(depths(insert_layers(fragments({0, 0.6, 1.2}), 3, 1)), (std::vector<double>{0, 1.2}));
  EXPECT_EQ(depths(insert_layers(fragments({1.2, 0.6, 0}), 3, 1)), (std::vector<double>{0}));
  std::vector<double> order = {0, 0.6, 1.2};
  do EXPECT_EQ(depths(peel_layers(fragments(order), 3, 1)), (std::vector<double>{0, 1.2}));
  while (std::next_permutation(order.begin(), order.end()));
}

TEST(Layers, ADistanceOfExactlyTheThresholdSeparates) {
  for (const bool turned : {false, true}) {
    const auto two = fragments(turned ? std::vector<double>{1, 0} : std::vector<double>{0, 1});
    EXPECT_EQ(insert_layers(two, 2, 1).size(), 2u);
    EXPECT_EQ(peel_layers(two, 2, 1).size(), 2u);
    EXPECT_EQ(insert_layers(two, 2, std::nextafter(1.0, 2.0)).size(), 1u);
    EXPECT_EQ(peel_layers(two, 2, std::nextafter(1.0, 2.0)).size(), 1u);
  }
}

TEST(Layers, AreSortedSeparateAndAgreeOnTheNearest) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 2000; ++round) {
    std::vector<double> list(1 + random() % 9);
    for (double& z : list) z = base::uniform(random, 0, 4);
    const int count = 1 + static_cast<int>(random() % 4);
    const auto inserted = depths(insert_layers(fragments(list), count, 0.5));
    const auto peeled = depths(peel_layers(fragments(list), count, 0.5));
    for (const auto& stored : {inserted, peeled}) {
      ASSERT_LE(stored.size(), static_cast<std::size_t>(count));
      ASSERT_EQ(stored.front(), *std::min_element(list.begin(), list.end()));
      for (std::size_t k = 1; k < stored.size(); ++k) ASSERT_GT(stored[k], stored[k - 1]);
    }
    for (std::size_t k = 1; k < peeled.size(); ++k) ASSERT_GE(peeled[k] - peeled[k - 1], 0.5);
  }
}

TEST(Layers, WithoutAThresholdAreTheNearestFragments) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 500; ++round) {
    std::vector<double> list(1 + random() % 9);
    for (double& z : list) z = static_cast<double>(random() % 5);
    auto sorted = list;
    std::sort(sorted.begin(), sorted.end());
    sorted.resize(std::min<std::size_t>(sorted.size(), 3));
    EXPECT_EQ(depths(insert_layers(fragments(list), 3, 0)), sorted);
    EXPECT_EQ(depths(peel_layers(fragments(list), 3, 0)), sorted);
  }
}

// N-B5
TEST(NormalBytes, AreWithinTheirErrorEverywhereAndCloserAtThePoles) {
  std::mt19937_64 random(4);
  const double degree = std::acos(-1.0) / 180;
  double worst = 0;
  const auto error = [](const glm::dvec3& n) {
    return 2 * std::asin(std::min(1.0, glm::length(NormalBytes::of(n).decoded() - n) / 2));
  };
  for (int i = 0; i < 200000; ++i) {
    const double y = base::uniform(random, -1, 1), lon = base::uniform(random, 0, 7), r = std::sqrt(1 - y * y);
    worst = std::max(worst, error({r * std::sin(lon), y, r * std::cos(lon)}));
  }
  EXPECT_LT(worst, 0.7831 * degree);
  EXPECT_GT(worst, 0.75 * degree);
  EXPECT_LT(error({0, 1, 0}), 1e-7);
  EXPECT_LT(error({0, -1, 0}), 1e-7);
  EXPECT_EQ(NormalBytes::of({-1e-9, 0, 1}).longitude, 0);
}

// A square cut into triangles at random points: every sample inside belongs to one of them, samples on edges included.
TEST(Scan, TrianglesThatMeetCoverEverySampleOnce) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 300; ++round) {
    const double q = round % 2 == 0 ? 1 : 0.25;  // corners on samples, or between
    const auto corner = [&] { return glm::dvec3(q * static_cast<double>(random() % 40), q * static_cast<double>(random() % 40), 0); };
    const glm::dvec3 a(0, 0, 0), b(40 * q, 0, 0), c(40 * q, 40 * q, 0), d(0, 40 * q, 0), middle = corner();
    std::vector<int> visits(41 * 41, 0);
    for (const auto& [p, n] : {std::pair(a, b), std::pair(b, c), std::pair(c, d), std::pair(d, a)}) {
      std::array<glm::dvec3, 3> t = {p, n, middle};
      if (random() % 2) std::swap(t[0], t[1]);
      scan_triangle(t, 41, 41, [&](int i, int j, const std::array<double, 3>& w) {
        ++visits[static_cast<std::size_t>(j * 41 + i)];
        EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
        EXPECT_NEAR(w[0] * t[0].x + w[1] * t[1].x + w[2] * t[2].x, i, 1e-9);
      });
    }
    for (int j = 0; j < 41; ++j)
      for (int i = 0; i < 41; ++i)
        EXPECT_EQ(visits[static_cast<std::size_t>(j * 41 + i)], i < 40 * q && j < 40 * q) << i << " " << j;
  }
}

}  // namespace
}  // namespace dendro::zbuffer_views
