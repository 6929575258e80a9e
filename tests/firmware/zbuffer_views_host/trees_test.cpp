#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/zbuffer_views/host/fir.h"
#include "firmware/zbuffer_views/host/magnolia.h"
#include "firmware/zbuffer_views/host/wood.h"
#include "tests/firmware/zbuffer_views_host/rig.h"

namespace dendro::zbuffer_views {
namespace {

Tree plain(TreeModel model) { return tree_of(std::move(model), {}); }

std::size_t count(const TreeModel& model, Part part) {
  return static_cast<std::size_t>(std::count(model.parts.begin(), model.parts.end(), part));
}

TEST(GrownTrees, AreTheSameForTheSameSeedOnly) {
  FirParameters fir;
  fir.age = 8;
  const TreeModel one = grow_fir(fir), again = grow_fir(fir);
  EXPECT_EQ(one.vertices, again.vertices);
  EXPECT_EQ(one.triangles, again.triangles);
  fir.seed = 2;
  EXPECT_NE(grow_fir(fir).vertices, one.vertices);
}

TEST(GrownTrees, HaveTheTrianglesThatWereAskedFor) {
  for (const double wanted : {50e3, 200e3, 600e3}) {
    FirParameters fir;
    fir.triangles = wanted;
    EXPECT_NEAR(static_cast<double>(grow_fir(fir).triangles.size()), wanted, 0.01 * wanted);
  }
  for (const double wanted : {20e3, 60e3, 200e3}) {
    MagnoliaParameters magnolia;
    magnolia.triangles = wanted;
    EXPECT_NEAR(static_cast<double>(grow_magnolia(magnolia).triangles.size()), wanted, 0.12 * wanted);
  }
}

TEST(GrownTrees, DefaultsLieInThePlausibleRanges) {
  const Tree fir = plain(grow_fir({})), magnolia = plain(grow_magnolia({}));
  EXPECT_GT(fir.model.triangles.size(), 150000u);
  EXPECT_LT(fir.model.triangles.size(), 250000u);
  EXPECT_GT(magnolia.model.triangles.size(), 45000u);
  EXPECT_LT(magnolia.model.triangles.size(), 80000u);
  EXPECT_NEAR(2 * fir.half_height, 3.8, 0.5);
  EXPECT_NEAR(2 * magnolia.half_height, 5, 0.7);
  EXPECT_LT(fir.radius, fir.half_height);
  FirParameters younger;
  younger.age = 10;
  EXPECT_LT(plain(grow_fir(younger)).half_height, 0.7 * fir.half_height);
}

TEST(GrownTrees, HaveAllThreePartsMostlyLeavesAndNoTriangleWithoutAnArea) {
  for (const TreeModel& model : {grow_fir({}), grow_magnolia({})}) {
    EXPECT_GT(count(model, Part::kTrunk), 0u);
    EXPECT_GT(count(model, Part::kBranch), 0u);
    EXPECT_GT(count(model, Part::kLeaf), model.triangles.size() / 2);
    for (const auto& t : model.triangles) {
      const glm::dvec3& a = model.vertices[t[0]];
      ASSERT_GT(glm::length(glm::cross(model.vertices[t[1]] - a, model.vertices[t[2]] - a)), 0);
    }
  }
}

TEST(GrownTrees, StandOnTheGroundWithCoordinatesOfSinglePrecision) {
  for (const TreeModel& model : {grow_fir({}), grow_magnolia({})})
    for (const glm::dvec3& p : model.vertices) {
      ASSERT_GT(p.y, -0.05);
      for (int i = 0; i < 3; ++i) ASSERT_EQ(p[i], single(p[i]));
    }
}

TEST(GrownTrees, MagnoliaLeavesLookUpWithTheirTopSide) {
  const TreeModel model = grow_magnolia({});
  glm::dvec3 sum{};
  double area = 0;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    if (model.parts[i] != Part::kLeaf) continue;
    const auto& t = model.triangles[i];
    const glm::dvec3& a = model.vertices[t[0]];
    const glm::dvec3 n = glm::cross(model.vertices[t[1]] - a, model.vertices[t[2]] - a);
    sum += n, area += glm::length(n);
  }
  EXPECT_GT(sum.y, 0.4 * area);
  EXPECT_LT(std::hypot(sum.x, sum.z), 0.1 * area);
}

TEST(GrownTrees, WoodLooksOutwards) {
  TreeModel model;
  add_wood(model, {{{0, 0, 0}, 0.5}, {{0, 1, 0}, 0.5}, {{0.2, 2, 0}, 0.4}, {{0.2, 3, 0}, 0.1}}, 7, Part::kTrunk);
  for (const auto& t : model.triangles) {
    const glm::dvec3 &a = model.vertices[t[0]], &b = model.vertices[t[1]], &c = model.vertices[t[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a), middle = (a + b + c) / 3.0;
    EXPECT_GT(normal.x * (middle.x - 0.1) + normal.z * middle.z, 0);
  }
}

}  // namespace
}  // namespace dendro::zbuffer_views
