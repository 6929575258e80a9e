#include "firmware/half_space/host/trunk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "sim/base/error.h"
#include "tests/firmware/half_space/tree_scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

scene::Object cube() {
  scene::Object object;
  object.solid = "cube";
  object.source_where = {"test.toml", 10};
  return object;
}

std::string refusal(const scene::Object& object) {
  try {
    read_trunk(object);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Trunk, ACylinderHasEightPlanesAndAConeSevenAndBothAreAsLargeAsTheirShape) {
  const TrunkShape shape{{1, 5, -2}, {1, 2, -2}, 0.4};
  for (const auto& [kind, planes] : {std::pair(TrunkKind::kCylinder, 8u), {TrunkKind::kCone, 7u}}) {
    const scene::PlaneSet set = trunk_planes(kind, shape);
    EXPECT_EQ(set.size(), planes);
    const auto corners = scene::intersection_vertices(set);
    ASSERT_TRUE(corners);
    glm::dvec3 lowest(INFINITY), highest(-INFINITY);
    double widest = 0;
    for (const glm::dvec3& p : *corners) {
      lowest = glm::min(lowest, p), highest = glm::max(highest, p);
      widest = std::max(widest, std::hypot(p.x - 1, p.z + 2));
    }
    EXPECT_NEAR(lowest.y, 2, 1e-9);
    EXPECT_NEAR(highest.y, 5, 1e-9);
    EXPECT_NEAR(widest, 0.4, 1e-9) << "corners lie on the circle";
  }
}

TEST(Trunk, AnAxisThatLeansStaysInsideItsPlanes) {
  const TrunkShape shape{{0.5, 4, 0}, {0, 1, 0.3}, 0.2};
  for (const TrunkKind kind : {TrunkKind::kCylinder, TrunkKind::kCone})
    for (const scene::HalfSpace& plane : trunk_planes(kind, shape))
      for (const double at : {0.01, 0.5, 0.99}) {
        const glm::dvec3 p = shape.top + (shape.bottom - shape.top) * at;
        EXPECT_LT(glm::dot(plane.normal, p), plane.offset);
      }
}

TEST(Trunk, SizesAreSharesOfTheCrownAndShrinkWithTheScale) {
  ObjectPlanes crown;
  for (const auto& [normal, offset] : {std::pair(glm::dvec3(1, 0, 0), 3.0),
                                       {{-1, 0, 0}, 1.0},
                                       {{0, 1, 0}, 6.0},
                                       {{0, -1, 0}, -2.0},
                                       {{0, 0, 1}, 1.0},
                                       {{0, 0, -1}, 1.0}})
    crown.planes.push_back({normal, offset});
  const auto size = crown_size(crown);
  ASSERT_TRUE(size);
  EXPECT_NEAR(size->width, 3, 1e-9) << "the mean of 4 and 2";
  EXPECT_NEAR(size->height, 4, 1e-9);
  EXPECT_NEAR(size->centre.x, 1, 1e-9);
  EXPECT_NEAR(size->centre.y, 4, 1e-9);
  TrunkSettings settings;
  settings.width = 0.2, settings.height = 0.75;
  const TrunkShape whole = trunk_shape(settings, *size, 1), half = trunk_shape(settings, *size, 0.5);
  EXPECT_NEAR(whole.radius, 0.3, 1e-9);
  EXPECT_NEAR(whole.bottom.y, 1, 1e-9);
  EXPECT_NEAR(half.radius, 0.15, 1e-9);
  EXPECT_NEAR(half.bottom.y, 2.5, 1e-9);
  crown.planes.pop_back();
  EXPECT_FALSE(crown_size(crown)) << "unbounded";
}

TEST(Trunk, AMeshsOwnTrunkIsFoundAgain) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(0, 6.2831853), height(0, 10);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 4000; ++i) {
    const double y = height(random), a = angle(random);
    points.push_back({0.1 * y + 0.25 * std::cos(a), y, -1 + 0.25 * std::sin(a)});
  }
  const TrunkShape shape = fit_trunk(points, {{0, 6, 0}, 4, 8}, cube());
  EXPECT_NEAR(shape.radius, 0.25, 0.02);
  EXPECT_NEAR(shape.bottom.y, 0, 0.05);
  EXPECT_NEAR(shape.bottom.x, 0, 0.05);
  EXPECT_NEAR(shape.top.y, 6, 1e-9);
  EXPECT_NEAR(shape.top.x, 0.6, 0.05) << "it leans";
  EXPECT_NEAR(shape.top.z, -1, 0.05);
  EXPECT_THROW(fit_trunk(points, {{0, -1, 0}, 4, 8}, cube()), UserError);
}

TEST(Trunk, AWordOfATrapeziumHasSixteenFractionBits) {
  Trapezium trapezium;
  trapezium.left = 10.5, trapezium.right = 20.25, trapezium.left_step = -0.5,
  trapezium.right_step = 1.0 / 65536;
  EXPECT_EQ(trapezium.words(), (std::vector<std::uint32_t>{0xA8000, 0x144000, 0xFFFF8000, 1}));
}

TEST(Trunk, APainterSTrunkIsClippedToThePicture) {
  scene::Affine view;  // one pixel a metre, y down
  view.linear[1][1] = -1;
  const auto inside = trapezium_of({{30, -10, 0}, {30, -40, 0}, 3}, view, 1, 64, 64);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->box.y0, 10);
  EXPECT_EQ(inside->box.y1, 40);
  EXPECT_EQ(inside->box.x0, 27);
  EXPECT_EQ(inside->box.x1, 33);
  const auto low = trapezium_of({{-2, -50, 0}, {-2, -90, 0}, 3}, view, 1, 64, 64);
  ASSERT_TRUE(low);
  EXPECT_EQ(low->box.y1, 63);
  EXPECT_EQ(low->box.x0, 0);
  EXPECT_FALSE(trapezium_of({{-10, -50, 0}, {-10, -90, 0}, 3}, view, 1, 64, 64)) << "left of it";
  EXPECT_FALSE(trapezium_of({{30, 20, 0}, {30, 5, 0}, 3}, view, 1, 64, 64)) << "above it";
}

TEST(Trunk, WrongKeysAreRefused) {
  EXPECT_EQ(refusal(cube()), "");
  EXPECT_NE(
      refusal(with_trunk(cube(), {{"trunk", std::string("palm")}})).find("none, cylinder, cone, painter"),
      std::string::npos);
  EXPECT_NE(refusal(with_trunk(cube(), {{"trunk_width", 0.2}})).find("object.trunk_width: goes with trunk"),
            std::string::npos);
  EXPECT_NE(
      refusal(with_trunk(cube(), {{"trunk", std::string("cone")}, {"trunk_width", -0.2}})).find("outside"),
      std::string::npos);
  EXPECT_NE(refusal(with_trunk(cube(), {{"trunk_hight", 0.2}})).find("did you mean trunk_height?"),
            std::string::npos);
  scene::Object mesh = with_trunk(cube(), {{"trunk", std::string("cone")}, {"trunk_width", 0.2}});
  mesh.groups = {{"trunk", "stem*"}};
  EXPECT_NE(refusal(mesh).find("goes without groups.trunk"), std::string::npos);
}

}  // namespace
}  // namespace dendro::half_space
