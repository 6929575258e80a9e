#include "firmware/half_space/reference/hulls_reference.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <random>

#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 7;

ErrorReport error_of(const PreparedHulls& prepared) {
  const std::vector<std::uint8_t> nearest = nearest_of(run_hulls_fixed_point(prepared));
  return compare(render_hulls_reference(prepared), nearest, prepared.maxdepth,
                 shown(nearest, prepared.shades).data());
}

/// The least front depth of the hulls that cover a pixel, in rationals.
mpq_class exact_nearest(const PreparedHulls& prepared, int x, int y) {
  mpq_class nearest = prepared.maxdepth;
  for (const Hull& hull : prepared.hulls) {
    mpq_class front = 0, back = prepared.maxdepth;
    bool outside = false;
    for (const ScreenPlane& plane : hull.screen) {
      const mpq_class rest = mpq_class(plane.a) * x + mpq_class(plane.b) * y + mpq_class(plane.d);
      if (plane.c == 0) {
        outside = outside || rest > 0;
        continue;
      }
      const mpq_class z = -rest / mpq_class(plane.c);
      if (plane.c > 0 && z < back) back = z;
      if (plane.c < 0 && z > front) front = z;
    }
    if (!outside && back < prepared.maxdepth && front < back && front < nearest) nearest = front;
  }
  return nearest;
}

TEST(HullsReference, AgreesWithRationals) {
  std::mt19937 random(kSeed);
  const PreparedHulls prepared = prepare_hulls(random_hulls(random, 64, 4));
  const HullsReference reference = render_hulls_reference(prepared);
  int covered = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double exact = exact_nearest(prepared, x, y).get_d();
      ASSERT_NEAR(reference.depth[64 * y + x], exact, 1e-8) << "seed " << kSeed << " at " << x << "," << y;
      covered += exact < prepared.maxdepth;
    }
  EXPECT_GT(covered, 500);
}

TEST(HullsFixedPoint, OfIntersectingHullsLiesInTheEnclosureOfTheReferenceAtEveryPixel) {  // FG86-A34
  std::mt19937 random(kSeed);
  for (int i = 0; i < 25; ++i) {
    const PreparedHulls prepared = prepare_hulls(random_hulls(random, 64, 3));
    const ErrorReport error = error_of(prepared);
    EXPECT_EQ(0, extra(error, "outside_enclosure")) << "seed " << kSeed << " scene " << i;
    EXPECT_LT(error.max_depth_error, 0.52);
    EXPECT_GT(error.covered_pixels, 100);
  }
}

TEST(HullsReference, EnclosureIsOneDepthAtMostPixels) {
  std::mt19937 random(kSeed);
  const HullsReference reference = render_hulls_reference(prepare_hulls(random_hulls(random, 128, 3)));
  int certain = 0;
  for (std::size_t i = 0; i < reference.depth.size(); ++i)
    certain += reference.upper[i] - reference.lower[i] <= 1;
  EXPECT_GT(certain, static_cast<int>(reference.depth.size()) * 95 / 100)
      << "an enclosure of everything would prove nothing";
}

TEST(HullsReference, AHullDrawnOneUnitTooNearLeavesTheEnclosure) {
  std::mt19937 random(kSeed);
  const PreparedHulls prepared = prepare_hulls(random_hulls(random, 64, 2));
  std::vector<std::uint8_t> nearest = nearest_of(run_hulls_fixed_point(prepared));
  int moved = 0;
  for (std::uint8_t& depth : nearest)
    if (depth < prepared.maxdepth && depth > 1) depth -= 2, ++moved;
  const std::vector<std::uint8_t> rgb(3 * nearest.size());
  const ErrorReport error = compare(render_hulls_reference(prepared), nearest, prepared.maxdepth, rgb.data());
  EXPECT_GT(extra(error, "outside_enclosure"), 0.9 * moved);
}

TEST(HullsFixedPoint, AHullWithoutABackPlaneShowsBackgroundAndIsReported) {
  scene::Scene scene = empty_scene(64);
  scene::Object open;
  open.source_where = {"test.toml", 10};
  for (const scene::Vector3& normal : {scene::Vector3{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}})
    open.planes.push_back({normal, 0.5});
  scene.objects = {open, open};
  scene = with(with(scene, "unbounded", std::string("background")), "depth_range",
               scene::OptionValue::Array{{3.0, {}}, {7.0, {}}});
  const PreparedHulls prepared = prepare_hulls(scene);
  for (const std::uint8_t depth : nearest_of(run_hulls_fixed_point(prepared)))
    ASSERT_EQ(depth, prepared.maxdepth);
  const ErrorReport error = error_of(prepared);
  EXPECT_EQ(error.covered_pixels, 0);
  EXPECT_EQ(extra(error, "unbounded_share"), 1.0);
  EXPECT_GT(extra(error, "unbounded_pixels"), 400);
}

TEST(HullsPreparation, PlanesWithoutABoundAreRefusedUnlessAskedFor) {
  scene::Scene scene = empty_scene(64);
  scene::Object open;
  open.source_where = {"test.toml", 10};
  open.planes = {{{0, 0, 1}, 0.5}};
  scene.objects = {open, open};
  EXPECT_THROW(prepare_hulls(scene), UserError);
}

TEST(HullsPreparation, TwoRegistersCannotHoldTwoHulls) {
  std::mt19937 random(kSeed);
  const scene::Scene two = random_hulls(random, 64, 2);
  EXPECT_TRUE(needs_three_registers(two));
  EXPECT_THROW(needs_three_registers(with(two, "registers", std::int64_t{2})), UserError);
  EXPECT_FALSE(needs_three_registers(icosahedron()));
  EXPECT_TRUE(needs_three_registers(with(icosahedron(), "registers", std::int64_t{3})));
}

}  // namespace
}  // namespace dendro::half_space
