#include "firmware/half_space/host/growth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "firmware/half_space/host/screen_setup.h"
#include "firmware/half_space/host/tree_object.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr double kDegree = 3.14159265358979323846 / 180;

GrowthParameters parameters(std::uint64_t seed = 1) {
  GrowthParameters p;
  p.start = start_normals("round", 6, 1.0);
  p.mean_angle = 30 * kDegree, p.sigma_angle = 5 * kDegree, p.angle_limit = 80 * kDegree;
  p.seed = seed;
  return p;
}

GrowthParameters without_noise(std::uint64_t seed = 1) {
  GrowthParameters p = parameters(seed);
  p.sigma_b = p.sigma_angle = p.sigma_length = 0;
  p.prune = false;
  return p;
}

TEST(Growth, NGenerationsMakeTwoToTheNTimesAsManyPlanes) {  // FG86-A11
  for (int n = 0; n <= 5; ++n) {
    GrowthParameters p = parameters();
    p.generations = n;
    p.prune = false;
    const Grown grown = grow(p);
    EXPECT_EQ(grown.planes.size(), 6u << n);
    EXPECT_EQ(grown.splits, 6 * ((1 << n) - 1));
  }
}

TEST(Growth, EverySplitAddsOnePlaneSoSixSplitsMakeTwelveOfSix) {  // FG86-A20
  for (int splits = 0; splits <= 6; ++splits) {
    GrowthParameters p = parameters();
    p.splits = splits;
    p.prune = false;
    EXPECT_EQ(grow(p).planes.size(), 6u + static_cast<unsigned>(splits));
  }
}

TEST(Growth, WithoutNoiseEveryChildsTipLiesInItsParentsPlane) {  // FG86-A32
  GrowthParameters p = without_noise();
  p.start = {{0.3, 1.1, -0.4}};
  const Grown grown = grow(p);
  ASSERT_EQ(grown.planes.size(), 2u);
  const double length = glm::length(p.start[0]);
  const glm::dvec3 u = p.start[0] / length, b = u * (length * (1 - p.mean_b));
  for (const scene::HalfSpace& child : grown.planes) {
    const glm::dvec3 tip = b + child.normal * (child.offset - glm::dot(child.normal, b));
    EXPECT_NEAR(glm::dot(u, tip), length, 1e-12);
    EXPECT_NEAR(glm::dot(u, child.normal), std::cos(30 * kDegree), 1e-12);
  }
  // On opposite sides of the parent, in one plane with it.
  EXPECT_NEAR(glm::dot(grown.planes[0].normal, grown.planes[1].normal), std::cos(60 * kDegree), 1e-12);
}

TEST(Growth, EachChildsLengthUsesItsOwnAngle) {  // FG86-K4
  GrowthParameters p = without_noise();
  p.start = {{0, 0, 1}};
  p.sigma_angle = 15 * kDegree;
  const Grown grown = grow(p);
  const glm::dvec3 b(0, 0, 1 - p.mean_b);
  ASSERT_NE(grown.planes[0].normal.z, grown.planes[1].normal.z);
  for (const scene::HalfSpace& child : grown.planes)
    EXPECT_NEAR(child.offset - glm::dot(child.normal, b), p.mean_b / child.normal.z, 1e-12);
}

TEST(Growth, IsScaleFree) {  // FG86-K5
  GrowthParameters small = parameters(), large = parameters();
  small.generations = large.generations = 3;
  for (glm::dvec3& normal : large.start) normal *= 1024.0;
  const Grown a = grow(small), b = grow(large);
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    EXPECT_EQ(a.planes[i].normal, b.planes[i].normal);
    EXPECT_NEAR(a.planes[i].offset * 1024, b.planes[i].offset, 1e-9);
  }
}

TEST(Growth, TheAzimuthOfSplitsCoversTheCircle) {  // FG86-K7
  std::set<int> octants;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    GrowthParameters p = without_noise(seed);
    p.start = {{0, 0, 1}};
    const glm::dvec3 n = grow(p).planes[0].normal;
    octants.insert(static_cast<int>(std::floor((std::atan2(n.y, n.x) / kDegree + 180) / 45.001)));
  }
  EXPECT_EQ(octants.size(), 8u);
}

TEST(Growth, AnglesShrinkByTheRatioAGeneration) {
  GrowthParameters p = without_noise();
  p.start = {{0, 0, 1}};
  p.ratio = 0.5;
  p.splits = 2;
  p.generations = 2;
  const Grown grown = grow(p);
  ASSERT_EQ(grown.planes.size(), 3u);
  EXPECT_NEAR(glm::dot(grown.planes[0].normal, grown.planes[1].normal), std::cos(30 * kDegree), 1e-12);
}

TEST(Growth, PruningKeepsTheCentreInsideByAtLeastTheChildrensLengths) {  // FG86-A31, K18
  int pruned = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    GrowthParameters p = parameters(seed);
    p.generations = 4;
    p.mean_angle = 50 * kDegree, p.sigma_angle = 15 * kDegree;
    const Grown grown = grow(p);
    for (const scene::HalfSpace& plane : grown.planes) ASSERT_GT(plane.offset, 0) << seed;
    pruned += grown.pruned;
  }
  EXPECT_GT(pruned, 1000);
}

TEST(Growth, ANormalThatLosesBothChildrenStaysUnlessItIsToldToGo) {  // FG86-K18
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    GrowthParameters p = parameters(seed);
    p.generations = 3;
    p.mean_angle = 60 * kDegree;
    const std::size_t kept = grow(p).planes.size();
    p.keep_parent = false;
    const std::size_t gone = grow(p).planes.size();
    EXPECT_LE(gone, kept);
    differ += gone < kept;
  }
  EXPECT_GT(differ, 0);
}

TEST(Growth, ABranchDoesNotDependOnWhatHappensInAnother) {
  GrowthParameters one = parameters(), other = parameters();
  one.generations = other.generations = 3;
  one.prune = other.prune = false;
  other.start[0] = {0.2, 3, 0.1};  // lengths and directions of one start normal only
  const Grown a = grow(one), b = grow(other);
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    if (i < 8) {
      EXPECT_NE(a.planes[i].offset, b.planes[i].offset);
    } else {
      EXPECT_EQ(a.planes[i].offset, b.planes[i].offset);
      EXPECT_EQ(a.planes[i].normal, b.planes[i].normal);
    }
  }
}

TEST(Growth, TheSeedDecidesEverything) {
  GrowthParameters p = parameters(7);
  p.generations = 2;
  const Grown a = grow(p), again = grow(p);
  ASSERT_EQ(a.planes.size(), again.planes.size());
  for (std::size_t i = 0; i < a.planes.size(); ++i) EXPECT_EQ(a.planes[i].offset, again.planes[i].offset);
  EXPECT_NE(grow(parameters(8)).planes[0].offset, a.planes[0].offset);
}

TEST(Growth, RelaxedPlanesHoldEveryCornerOfTheCrownAndTheOriginalOnesDoNot) {  // FG86-K19
  int crowns = 0, cut = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    GrowthParameters p = parameters(seed);
    p.generations = 1 + static_cast<int>(seed % 3);
    p.mean_angle = 40 * kDegree;
    const Grown grown = grow(p);
    if (!scene::is_bounded(grown.planes)) continue;
    const auto corners = scene::intersection_vertices(grown.planes);
    ASSERT_TRUE(corners) << seed;
    ++crowns;
    bool outside = false;
    for (const glm::dvec3& corner : *corners) {
      for (const scene::HalfSpace& plane : grown.relaxed)
        ASSERT_LE(glm::dot(plane.normal, corner), plane.offset + 1e-9) << seed;
      for (const scene::HalfSpace& plane : grown.original)
        outside = outside || glm::dot(plane.normal, corner) > plane.offset + 1e-6;
    }
    cut += outside;
  }
  EXPECT_GT(crowns, 100);
  EXPECT_GT(cut, crowns / 2) << "most crowns bulge through their start planes";
}

TEST(Growth, TheRidgeOfASymmetricSplitReachesBCOverTheSquaredCosine) {  // FG86-K19
  GrowthParameters p = without_noise();
  p.start = {{0, 0, 1}};
  const Grown grown = grow(p);
  ASSERT_EQ(grown.relaxed.size(), 1u);
  const double c = std::cos(30 * kDegree);
  EXPECT_NEAR(grown.relaxed[0].offset, (1 - p.mean_b) + p.mean_b / (c * c), 1e-12);
}

TEST(Growth, ExtremeParametersGiveFinitePlanesOrAnError) {  // N-A9
  for (const double angle : {0.0, 60.0, 79.9, 89.0})
    for (const double sigma : {0.0, 15.0, 80.0})
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        GrowthParameters p = parameters(seed);
        p.generations = 4;
        p.mean_angle = angle * kDegree, p.sigma_angle = sigma * kDegree;
        p.sigma_b = 1, p.sigma_length = 1;
        try {
          for (const scene::HalfSpace& plane : grow(p).planes) {
            ASSERT_TRUE(std::isfinite(plane.offset));
            ASSERT_NEAR(glm::length(plane.normal), 1, 1e-9);
          }
        } catch (const GrowthError&) {
          EXPECT_GE(angle, 79.9) << "80 degrees are a child of 4.6 times the length, beyond the limit";
        }
      }
}

TEST(Growth, ASplitsPrintedStepsTakeFewerThanTwentyOperationsWithoutRedraws) {  // FG86-A18
  const Grown grown = grow(without_noise());
  EXPECT_EQ(grown.splits, 6);
  EXPECT_EQ(grown.printed.flops, 6u * 16u);
  EXPECT_EQ(grown.printed.look_ups, 6u * 7u);
  EXPECT_GT(grown.vectors.flops, 6u * 30u);
}

TEST(TreeScene, TheFirstBoxHoldsTheCrownAlsoWithLargeAngles) {
  for (std::int64_t seed = 1; seed <= 12; ++seed) {
    scene::Scene scene = tree(2, 160);
    auto& object = scene.objects[0].tree_parameters;
    object["mu_alpha"] = {45.0, {}};
    object["seed"] = {seed, {}};
    const Prepared boxed = prepare(scene), full = prepare(with(scene, "starting_box", std::string("full")));
    ASSERT_LT(boxed.program.box.width() * boxed.program.box.height(), 160 * 160) << seed;
    // Outside the box the full picture is background.
    const FixedPointPicture picture = run_fixed_point(full.program);
    for (int y = 0; y < 160; ++y)
      for (int x = 0; x < 160; ++x) {
        const Box& box = boxed.program.box;
        const bool inside = x >= box.x0 && x <= box.x1 && y >= box.y0 && y <= box.y1;
        ASSERT_TRUE(inside || picture.pixels[160 * y + x] == kBackgroundWord)
            << seed << " at " << x << "," << y;
      }
  }
}

TEST(TreeScene, AnUnboundedCrownIsBackgroundWhereItIsOpenAndSaysHowMuch) {
  int open = 0;
  for (std::int64_t seed = 1; seed <= 10; ++seed) {
    scene::Scene scene = tree(1, 64);
    scene.objects[0].tree_parameters["start"] = open_start();
    scene.objects[0].tree_parameters["seed"] = {seed, {}};
    const Prepared prepared = prepare(scene);
    const UnboundedPixels count = count_unbounded(prepared.screen, 64, 64, prepared.program.maxdepth);
    open += count.unbounded > 0;
    const FixedPointPicture picture = run_fixed_point(prepared.program);
    std::int64_t covered = 0;
    for (const std::uint32_t word : picture.pixels) covered += (word >> kFaceLow & kFaceMask) != 0;
    EXPECT_LE(std::abs(covered - count.covered), 4 + count.covered / 20) << seed;
  }
  EXPECT_GT(open, 3);
}

TEST(TreeScene, WrongParametersAreTheUsersFault) {
  const auto refused = [](const std::string& key, const scene::OptionValue& value) {
    scene::Scene scene = tree(1);
    scene.objects[0].tree_parameters[key] = value;
    EXPECT_THROW(prepare(scene), UserError) << key;
  };
  refused("generations", {std::int64_t{9}, {}});
  refused("start_normals", {std::int64_t{0}, {}});
  refused("start", {scene::OptionValue::Array{}, {}});
  refused("alpha_max", {2.0, {}});  // of angles of 30 +- 5 degrees
  refused("alpha_maximum", {80.0, {}});
  refused("copies", {std::int64_t{4}, {}});
  scene::Scene palm = tree(1);
  palm.objects[0].tree = "palm";
  EXPECT_THROW(prepare(palm), UserError);
}

TEST(TreeScene, CopiesAreDifferentTreesOnTheirGround) {
  const PreparedHulls prepared = prepare_hulls(grove(40));
  ASSERT_EQ(prepared.hulls.size(), 40u);
  EXPECT_EQ(prepared.planes(), 480u);
  EXPECT_EQ(prepared.splits, 240u);
  std::set<double> offsets;
  for (const Hull& hull : prepared.hulls) offsets.insert(hull.screen[0].a);
  EXPECT_EQ(offsets.size(), 40u);
}

}  // namespace
}  // namespace dendro::half_space
