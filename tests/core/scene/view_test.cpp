#include "sim/scene/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "sim/base/error.h"

namespace dendro::scene {
namespace {

Camera camera_at(const Vector3& position, const Vector3& target, double height) {
  Camera camera;
  camera.position = position, camera.target = target, camera.height = height;
  return camera;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << " " << a.y << " " << a.z << ", wanted " << b.x << " " << b.y << " " << b.z;
}

TEST(ParallelView, TargetLandsOnTheCentreOfThePicture) {
  const Affine view = parallel_view(camera_at({1, 2, 9}, {1, 2, 0}, 4), {640, 480, {}});
  expect_near(view({1, 2, 0}), {319.5, 239.5, 9});
}

TEST(ParallelView, HeightOfThePictureIsTheWorldHeight) {
  const Affine view = parallel_view(camera_at({0, 0, 5}, {0, 0, 0}, 4), {512, 256, {}});
  EXPECT_DOUBLE_EQ(view({0, 2, 0}).y, -0.5) << "the top edge";
  EXPECT_DOUBLE_EQ(view({0, -2, 0}).y, 255.5);
  EXPECT_DOUBLE_EQ(view({4, 0, 0}).x, 511.5) << "pixels are square";
}

TEST(ParallelView, RightIsRightUpIsUpAndDepthGrowsAway) {
  for (const Vector3 position : {Vector3{0, 0, 5}, Vector3{5, 1, 0}, Vector3{-3, 2, -4}}) {
    const Camera camera = camera_at(position, {0, 0, 0}, 2);
    const CameraAxes axes(camera);
    const Affine view = parallel_view(camera, {100, 100, {}});
    const glm::dvec3 centre = view({0, 0, 0});
    expect_near(view(axes.right) - centre, {50, 0, 0}, 1e-10);
    expect_near(view(axes.up) - centre, {0, -50, 0}, 1e-10);
    expect_near(view(axes.forward) - centre, {0, 0, 1}, 1e-10);
    EXPECT_GT(axes.up.y, 0.0);
    expect_near(glm::cross(axes.right, axes.up), -axes.forward);
  }
}

TEST(ParallelView, FromPlusZHasXToTheRight) {
  EXPECT_EQ(CameraAxes(camera_at({0, 0, 5}, {0, 0, 0}, 2)).right, glm::dvec3(1, 0, 0));
}

TEST(ParallelView, ImpossibleCamerasAreRefused) {
  const Image image;
  EXPECT_THROW(parallel_view(camera_at({0, 0, 1}, {0, 0, 1}, 2), image), UserError);
  EXPECT_THROW(parallel_view(camera_at({0, 3, 0}, {0, 0, 0}, 2), image), UserError)
      << "up along the line of sight";
  EXPECT_THROW(parallel_view(camera_at({0, 0, 1}, {0, 0, 0}, 0), image), UserError);
  EXPECT_THROW(parallel_view(camera_at({0, 0, 1}, {0, 0, 0}, NAN), image), UserError);
  EXPECT_THROW(parallel_view(camera_at({0, 0, INFINITY}, {0, 0, 0}, 1), image), UserError);
  Camera perspective = camera_at({0, 0, 1}, {0, 0, 0}, 1);
  perspective.projection = Camera::Projection::kPerspective;
  EXPECT_THROW(parallel_view(perspective, image), UserError);
}

TEST(Angles, AreExactAtMultiplesOfNinetyDegrees) {
  const double sines[] = {0, 1, 0, -1};
  for (int quarter = -8; quarter <= 8; ++quarter) {
    EXPECT_EQ(sine_of_degrees(90.0 * quarter), sines[quarter & 3]) << quarter;
    EXPECT_EQ(cosine_of_degrees(90.0 * quarter), sines[(quarter + 1) & 3]) << quarter;
  }
  EXPECT_DOUBLE_EQ(sine_of_degrees(30), 0.5);
  EXPECT_DOUBLE_EQ(cosine_of_degrees(300), 0.5);
}

TEST(Placement, TurnsScalesAndShiftsInThatOrder) {
  Object object;
  object.rotate = {0, 90, 0};
  object.scale = 2;
  object.units = "cm";
  object.at = {10, 0, 0};
  expect_near(Placement(object)({0, 1, 100}), {12, 0.02, 0});
}

TEST(Placement, PutsTheFilesUpAxisUp) {
  for (const auto& [axis, up] :
       {std::pair("x", glm::dvec3(1, 0, 0)), {"y", glm::dvec3(0, 1, 0)}, {"z", glm::dvec3(0, 0, 1)}}) {
    Object object;
    object.up_axis = axis;
    const Placement place(object);
    EXPECT_EQ(place(up), glm::dvec3(0, 1, 0)) << axis;
    EXPECT_DOUBLE_EQ(glm::determinant(place.rotation), 1.0) << axis << ": no mirror image";
  }
}

TEST(Placement, MovesAPlaneWithThePointsOnIt) {
  Object object;
  object.rotate = {20, -75, 130};
  object.scale = 0.3;
  object.up_axis = "z";
  object.at = {4, -5, 6};
  const Placement place(object);
  const HalfSpace plane{glm::normalize(glm::dvec3(1, 2, -3)), 7};
  const glm::dvec3 on = plane.normal * plane.offset + glm::cross(plane.normal, glm::dvec3(3, 1, 4));
  const HalfSpace moved = place(plane);
  EXPECT_NEAR(glm::dot(moved.normal, place(on)), moved.offset, 1e-12);
  EXPECT_LT(glm::dot(moved.normal, place(on - plane.normal)), moved.offset) << "inside stays inside";
}

TEST(Placement, ImpossibleObjectsAreRefused) {
  const auto refused = [](const auto& change) {
    Object object;
    change(object);
    EXPECT_THROW(Placement{object}, UserError);
  };
  refused([](Object& o) { o.units = "furlong"; });
  refused([](Object& o) { o.up_axis = "w"; });
  refused([](Object& o) { o.scale = 0; });
  refused([](Object& o) { o.scale = -1; });
  refused([](Object& o) { o.at[1] = NAN; });
  refused([](Object& o) { o.rotate[2] = INFINITY; });
}

}  // namespace
}  // namespace dendro::scene
