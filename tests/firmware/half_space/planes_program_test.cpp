#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "firmware/half_space/pixel_planes/prepare_planes.h"
#include "firmware/half_space/planes_job.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

ScreenPlane plane(double a, double b, double c, double d) {
  return {a, b, c, d, c > 0 ? PlaneKind::kBack : c < 0 ? PlaneKind::kFront : PlaneKind::kEdgeOn, 0};
}

bool holds(const StreamPlane& p, const ArraySite& site, unsigned bits, unsigned guard) {
  for (const int x : {0, site.width - 1})
    for (const int y : {0, site.height - 1}) {
      const double z = static_cast<double>(p.expression.a) * x + static_cast<double>(p.expression.b) * y + p.expression.c;
      if (z - 1 < -std::ldexp(1.0, static_cast<int>(bits + guard) - 1) || z + 1 >= std::ldexp(1.0, static_cast<int>(bits + guard) - 1))
        return false;
    }
  return true;
}

TEST(PlanesProgram, GuardBitsAreTheFewestThatHoldThePlaneOnTheArray) {
  std::mt19937_64 random(5);
  const ArraySite site;
  const PixelLayout layout;
  std::uniform_real_distribution<double> unit(-1, 1);
  int more = 0;
  for (int n = 0; n < 500; ++n) {
    const double slope = std::pow(2.0, 12 * unit(random));
    const StreamPlane p = make_stream_plane(plane(slope * unit(random), slope * unit(random), 1, -30000 * slope * unit(random)),
                                            site, layout, 10, 2, 16, {});
    ASSERT_EQ(p.kind, PlaneKind::kBack);
    ASSERT_TRUE(holds(p, site, layout.depth_bits, p.guard));
    if (p.guard > 2) {
      ++more;
      ASSERT_FALSE(holds(p, site, layout.depth_bits, p.guard - 1));
    }
  }
  EXPECT_GT(more, 50);
}

TEST(PlanesProgram, APlaneTooSteepForAnyGuardIsAnEdge) {
  const StreamPlane p = make_stream_plane(plane(1, 0, 1e-12, -200), {}, {}, 10, 2, 16, {});
  EXPECT_EQ(p.kind, PlaneKind::kEdgeOn);
  // Inside where x <= 200: the stream is negative outside.
  EXPECT_LT(p.expression.a * 201 + p.expression.c, 0);
  EXPECT_GT(p.expression.a * 199 + p.expression.c, 0);
}

TEST(PlanesProgram, AnEdgeFarAwayIsAConstantOfItsSide) {
  for (const double d : {1e12, -1e12}) {
    const StreamPlane p = make_stream_plane(plane(1, 0.5, 0, d), {}, {}, 10, 2, 16, {});
    for (const int x : {0, 511})
      for (const int y : {0, 511}) EXPECT_EQ(p.expression.a * x + p.expression.b * y + p.expression.c < 0, d > 0);
    EXPECT_LE(p.guard, 14u);
  }
}

TEST(PlanesProgram, APlaneThatIsNotFiniteIsAnErrorOfItsObject) {
  try {
    make_stream_plane(plane(NAN, 0, 1, 0), {}, {}, 10, 2, 16, {"s.toml", 9});
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_EQ(error.file(), "s.toml");
    EXPECT_EQ(error.line(), 9);
  }
}

scene::Scene solid(const std::string& name) {
  scene::Scene scene;
  scene.name = name;
  scene.image.width = scene.image.height = 128;
  scene.camera.height = 2.6;
  scene.camera.position = {0, 0, 5};
  scene.options = scene::Options("half_space");
  scene::Object object;
  object.solid = "icosahedron";
  object.rotate = {10, 20, 0};
  scene.objects = {object};
  return scene;
}

std::string error_of(const scene::Scene& scene, const ArraySite& site) {
  try {
    prepare_planes(scene, site);
  } catch (const UserError& error) {
    return error.key() + ": " + error.message();
  }
  return "";
}

TEST(PlanesProgram, RegistersFillTheMemoryAndNoMore) {
  const scene::Scene scene = solid("s");
  EXPECT_EQ(choose_layout(scene, {}).depth_bits, 16u);
  EXPECT_EQ(choose_layout(scene, {}).used, 72u);
  EXPECT_EQ(choose_layout(scene, {128, 128, 208, 1}).depth_bits, 24u);
  scene::Scene index = scene, scratch = scene, deep = scene;
  index.options.set("colouring", {std::string("index"), {}});
  EXPECT_EQ(choose_layout(index, {}).depth_bits, 12u);
  scratch.options.set("variant", {std::string("scratch"), {}});
  EXPECT_EQ(choose_layout(scratch, {512, 512, 72, 2}).depth_bits, 12u);
  EXPECT_NE(error_of(scratch, {}).find("variant: the scratch copy needs a memory with two ports"), std::string::npos);
  deep.options.set("depth_bits", {std::int64_t{17}, {}});
  EXPECT_NE(error_of(deep, {}).find("are 75 of a pixel; the memory has 72"), std::string::npos);
}

TEST(PlanesProgram, APictureLargerThanTheArrayIsAnError) {
  EXPECT_NE(error_of(solid("s"), {64, 128, 72, 1}).find("image.width: 128 is more than the 64 pixels of the array"),
            std::string::npos);
}

TEST(PlanesProgram, OptionsOfTheFrameBufferProgramHaveNoEffect) {
  scene::Scene scene = solid("s");
  scene.options.set("boxing", {false, {}});
  scene.options.set("far_shade", {0.5, {}});
  EXPECT_EQ(error_of(scene, {}), "");
  scene.options.set("far_shadow", {0.5, {}});
  EXPECT_NE(error_of(scene, {}), "");
}

TEST(PlanesProgram, BackPlanesAreSentFirstAndFrontPlanesLast) {
  const PreparedPlanes prepared = prepare_planes(solid("s"), {});
  ASSERT_EQ(prepared.hulls.size(), 1u);
  const auto& planes = prepared.hulls[0].planes;
  ASSERT_EQ(planes.size(), 20u);
  for (std::size_t i = 1; i < planes.size(); ++i)
    EXPECT_FALSE(planes[i - 1].kind == PlaneKind::kFront && planes[i].kind == PlaneKind::kBack);
  EXPECT_EQ(prepared.planes(PlaneKind::kFront), prepared.faces.size());
}

}  // namespace
}  // namespace dendro::half_space
