#include "sim/scene/plane_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "sim/scene/hull.h"
#include "sim/scene/mesh.h"

namespace dendro::scene {
namespace {

constexpr unsigned kSeed = 20;

std::vector<glm::dvec3> random_points(std::mt19937& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(normal(random), 3 * normal(random) + 50, normal(random));
  return points;
}

double highest(const PlaneSet& planes, const glm::dvec3& p) {
  double most = -INFINITY;
  for (const HalfSpace& plane : planes) most = std::max(most, glm::dot(plane.normal, p) - plane.offset);
  return most;
}

const PlaneSet kCube{{{1, 0, 0}, 1},  {{-1, 0, 0}, 1}, {{0, 1, 0}, 1},
                     {{0, -1, 0}, 1}, {{0, 0, 1}, 1},  {{0, 0, -1}, 1}};

TEST(Solids, HaveTheirNumberOfFacesAndCornersOnTheUnitSphere) {
  const std::vector<std::pair<std::size_t, std::size_t>> faces_corners{
      {4, 4}, {6, 8}, {8, 6}, {12, 20}, {20, 12}};
  ASSERT_EQ(solid_names().size(), faces_corners.size());
  for (std::size_t i = 0; i < faces_corners.size(); ++i) {
    const PlaneSet planes = solid_planes(solid_names()[i]);
    EXPECT_EQ(planes.size(), faces_corners[i].first) << solid_names()[i];
    const auto corners = intersection_vertices(planes);
    ASSERT_TRUE(corners) << solid_names()[i];
    EXPECT_EQ(corners->size(), faces_corners[i].second) << solid_names()[i];
    for (const glm::dvec3& corner : *corners)
      EXPECT_NEAR(glm::length(corner), 1.0, 1e-12) << solid_names()[i];
  }
}

TEST(Solids, TheIcosahedronHasFourFacesExactlyEdgeOnAlongEachAxis) {
  const PlaneSet planes = solid_planes("icosahedron");
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_EQ(
        std::count_if(planes.begin(), planes.end(), [&](const HalfSpace& p) { return p.normal[axis] == 0; }),
        4);
}

TEST(PlaneSet, IsBoundedOnlyWhenItsNormalsSpanSpacePositively) {
  EXPECT_TRUE(is_bounded(kCube));
  for (std::size_t missing = 0; missing < kCube.size(); ++missing) {
    PlaneSet open = kCube;
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(missing));
    EXPECT_FALSE(is_bounded(open)) << missing;
  }
  EXPECT_FALSE(is_bounded({}));
  EXPECT_FALSE(is_bounded({{{1, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{0, 1, 0}, 1}, {{0, -1, 0}, 1}})) << "a tube";
  EXPECT_TRUE(is_bounded(solid_planes("tetrahedron")));
}

TEST(PlaneSet, WithoutCommonInteriorHasNoCorners) {
  PlaneSet empty = kCube;
  empty[0].offset = -2;  // x <= -2 and x >= -1
  EXPECT_LT(chebyshev_ball(empty).radius, 0.0);
  EXPECT_FALSE(intersection_vertices(empty));
  PlaneSet flat = kCube;
  flat[0].offset = -1;  // x = -1
  EXPECT_FALSE(intersection_vertices(flat));
}

TEST(ChebyshevBall, OfABoxHasHalfItsSmallestSide) {
  PlaneSet box = kCube;
  box[0].offset = 104, box[1].offset = -100;  // 100 <= x <= 104
  const Ball ball = chebyshev_ball(box);
  EXPECT_NEAR(ball.radius, 1.0, 1e-9);
  EXPECT_LE(highest(box, ball.centre), -1.0 + 1e-9);
}

TEST(ChebyshevBall, TouchesFourPlanesOfARandomSetAndCrossesNone) {
  std::mt19937 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    const PlaneSet planes = hull_planes(random_points(random, 30), 0);
    const Ball ball = chebyshev_ball(planes);
    const auto touching = std::count_if(planes.begin(), planes.end(), [&](const HalfSpace& p) {
      return std::abs(p.offset - glm::dot(p.normal, ball.centre) - ball.radius) < 1e-7;
    });
    EXPECT_GE(touching, 4) << "seed " << kSeed << " round " << round;
    EXPECT_GT(ball.radius, 0.0);
  }
}

TEST(PlaneSet, OfAllHullFacetsHasTheHullsCorners) {
  std::mt19937 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    const std::vector<glm::dvec3> points = random_points(random, 40);
    const auto hull = convex_hull(points);
    ASSERT_TRUE(hull);
    const auto corners = intersection_vertices(hull_planes(points, 0));
    ASSERT_TRUE(corners) << "seed " << kSeed << " round " << round;
    ASSERT_EQ(corners->size(), hull->vertices.size());
    for (const std::uint32_t v : hull->vertices) {
      double nearest = INFINITY;
      for (const glm::dvec3& corner : *corners) nearest = std::min(nearest, glm::distance(corner, points[v]));
      EXPECT_LT(nearest, 1e-7) << "seed " << kSeed << " round " << round;
    }
  }
}

TEST(Hull, OfACubeHasSixFacetsOfTheirAreaAndFourNeighboursEach) {
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 2 : 0, i & 2 ? 2 : 0, i & 4 ? 2 : 0);
  const auto hull = convex_hull(corners);
  ASSERT_TRUE(hull);
  ASSERT_EQ(hull->facets.size(), 6u);
  for (const HullFacet& facet : hull->facets) {
    EXPECT_NEAR(facet.area, 4.0, 1e-12);
    EXPECT_EQ(facet.neighbours.size(), 4u);
    EXPECT_EQ(facet.corners.size(), 4u);
    EXPECT_NEAR(glm::dot(facet.normal, facet.centroid), facet.offset, 1e-12);
    EXPECT_NEAR(glm::distance(facet.centroid, glm::dvec3(1) + facet.normal), 0.0, 1e-12);
  }
}

TEST(Hull, OfPointsInAPlaneOrTooFewDoesNotExist) {
  EXPECT_FALSE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.3, 0}}));
  EXPECT_FALSE(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_FALSE(convex_hull({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}));
}

TEST(MergedPlanes, AlwaysContainTheHullAreBoundedAndAsManyAsAsked) {
  const Mesh mesh = load_mesh(std::string(MESHES) + "/tree_pine_orange_large.obj");
  const std::size_t facets = convex_hull(mesh.vertices)->facets.size();
  for (std::size_t count : {std::size_t{5}, std::size_t{6}, std::size_t{12}, std::size_t{32}, facets}) {
    const PlaneSet planes = hull_planes(mesh.vertices, count);
    EXPECT_EQ(planes.size(), count);
    EXPECT_TRUE(is_bounded(planes)) << count;
    for (const glm::dvec3& p : mesh.vertices) ASSERT_LT(highest(planes, p), 1e-9) << count;
    for (const HalfSpace& plane : planes) {
      EXPECT_NEAR(glm::length(plane.normal), 1.0, 1e-12);
      double touch = -INFINITY;
      for (const glm::dvec3& p : mesh.vertices)
        touch = std::max(touch, glm::dot(plane.normal, p) - plane.offset);
      EXPECT_NEAR(touch, 0.0, 1e-9) << "every plane touches the hull";
    }
  }
}

TEST(MergedPlanes, OfACubeWithOneCutCornerLoseTheCutFirst) {
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 7; ++i) corners.emplace_back(i & 1 ? 2 : 0, i & 2 ? 2 : 0, i & 4 ? 2 : 0);
  for (const glm::dvec3& cut : {glm::dvec3(1.9, 2, 2), glm::dvec3(2, 1.9, 2), glm::dvec3(2, 2, 1.9)})
    corners.push_back(cut);
  ASSERT_EQ(hull_planes(corners, 0).size(), 7u);
  for (const HalfSpace& plane : hull_planes(corners, 6)) {
    const glm::dvec3 n = glm::abs(plane.normal);
    EXPECT_GT(std::max({n.x, n.y, n.z}), 0.99)
        << "the small facet was merged into a side, no side into another";
  }
}

TEST(MergedPlanes, AreTheSameOnEveryRun) {
  std::mt19937 random(kSeed);
  const std::vector<glm::dvec3> points = random_points(random, 200);
  const PlaneSet first = hull_planes(points, 24), second = hull_planes(points, 24);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].normal, second[i].normal);
    EXPECT_EQ(first[i].offset, second[i].offset);
  }
}

TEST(MergedPlanes, AreRefusedForFlatPointsAndForMorePlanesThanFacets) {
  EXPECT_THROW(hull_planes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, 0), std::invalid_argument);
  EXPECT_THROW(hull_planes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 5), std::invalid_argument);
  EXPECT_THROW(hull_planes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 3), std::invalid_argument);
}

TEST(SupportPlanes, TouchThePointsInTheGivenDirections) {
  std::mt19937 random(kSeed);
  const std::vector<glm::dvec3> points = random_points(random, 100);
  const std::vector<glm::dvec3> directions = sphere_directions(26);
  const PlaneSet planes = support_planes(points, directions);
  ASSERT_EQ(planes.size(), 26u);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_NEAR(glm::dot(planes[i].normal, directions[i]), 1.0, 1e-12);
    const PlaneSet alone{planes[i]};
    double touch = -INFINITY;
    for (const glm::dvec3& p : points) touch = std::max(touch, highest(alone, p));
    EXPECT_NEAR(touch, 0.0, 1e-12);
  }
}

TEST(SphereDirections, AreUnitAndBoundASetForEveryCountFromFour) {
  for (std::size_t count = 4; count <= 100; ++count) {
    const std::vector<glm::dvec3> directions = sphere_directions(count);
    for (const glm::dvec3& d : directions) EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
    EXPECT_TRUE(is_bounded(support_planes({{0, 0, 0}}, directions))) << count;
  }
}

}  // namespace
}  // namespace dendro::scene
