#include <gtest/gtest.h>

#include <algorithm>

#include "firmware/half_space/pixel_planes/prepare_planes.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/parts/igc/igc.h"
#include "sim/study/run.h"
#include "tests/support/tape.h"

namespace dendro::study {
namespace {

Catalogue catalogue() { return {{pixel_planes::pixel_planes_type()}, algorithms(), SHARE}; }

RunRequest request(const Catalogue& all, const std::string& scene, const std::vector<std::string>& settings = {},
                   const std::string& level = "cycle") {
  RunArguments arguments;
  arguments.scene = scene;
  arguments.machine = "pixel-planes";
  arguments.level = level;
  arguments.settings = settings;
  return prepare_run(all, arguments);
}

const char* const kScenes[] = {"icosahedron", "pine-hull", "aspen-hull", "bishop-hull", "crown", "figure5", "grove"};

TEST(PixelPlanesScenes, DrawWhatTheReferenceDraws) {
  const Catalogue all = catalogue();
  for (const char* scene : kScenes) {
    SCOPED_TRACE(scene);
    const RunOutput cycle = execute(request(all, scene), "", nullptr);
    const RunOutput function = execute(request(all, scene, {}, "function"), "", nullptr);
    EXPECT_EQ(cycle.rgb, function.rgb);
    EXPECT_EQ(cycle.object.instructions, function.object.instructions);
    EXPECT_GT(cycle.object.error.covered_pixels, 5000);
    EXPECT_LE(cycle.object.error.wrong_pixels * 2000, cycle.object.error.covered_pixels);
    EXPECT_LT(cycle.object.error.max_depth_error, 1.0);
    for (const auto& unit : cycle.object.units)
      for (const auto& [name, value] : unit.values)
        if (name == "bitwise_commands") {
          EXPECT_EQ(value, 0u);
        }
  }
}

TEST(PixelPlanesScenes, VariantsAndColouringsDrawTheSamePicture) {
  const Catalogue all = catalogue();
  for (const char* scene : {"figure5", "crown"}) {
    SCOPED_TRACE(scene);
    const std::string bits = "half_space.depth_bits=12";
    const std::vector<std::uint8_t> picture = execute(request(all, scene, {bits}), "", nullptr).rgb;
    EXPECT_EQ(picture, execute(request(all, scene, {bits, "half_space.colouring=index"}), "", nullptr).rgb);
    EXPECT_EQ(picture, execute(request(all, scene, {bits, "parameters.array.ports=2"}), "", nullptr).rgb);
    EXPECT_EQ(picture, execute(request(all, scene, {bits, "parameters.array.ports=2", "half_space.variant=scratch"}), "",
                               nullptr).rgb);
    EXPECT_EQ(picture, execute(request(all, scene, {bits, "half_space.guard_bits=12"}), "", nullptr).rgb);
  }
}

/// Both engines on a scene; all bits must be equal. The share of pixel operations that the lazy one carried out.
double lazy_share(const Catalogue& all, const char* scene, const std::vector<std::string>& settings) {
  const RunRequest r = request(all, scene, settings);
  Tape tape;
  r.algorithm->make(r.file.scene, *r.type, r.preset.parameters)->run(tape);
  const pixel_planes::Spec spec = pixel_planes::resolve(r.preset.parameters);
  pixel_planes::Device lazy(spec, true), full(spec, false);
  for (const auto& [address, value] : tape.words) lazy.write(address, value), full.write(address, value);
  const auto& wanted = full.engine().bits().memory;
  lazy.picture();
  const double evaluated = static_cast<double>(lazy.engine().counters().evaluated);
  const auto& found = lazy.engine().bits().memory;
  for (std::size_t bit = 0; bit < wanted.size(); ++bit)
    if (wanted[bit] != found[bit]) ADD_FAILURE() << "bit " << bit;
  EXPECT_LE(lazy.engine().counters().evaluated, full.engine().counters().evaluated);
  return evaluated / static_cast<double>(lazy.engine().counters().pixel_operations);
}

TEST(PixelPlanesScenes, LazyEqualsFullInEveryBit) {
  const Catalogue all = catalogue();
  for (const char* scene : kScenes) {
    SCOPED_TRACE(scene);
    lazy_share(all, scene, {});
  }
}

TEST(PixelPlanesScenes, LazyEqualsFullInEveryBitWithColoursByIndex) {
  const Catalogue all = catalogue();
  for (const char* scene : kScenes) {
    SCOPED_TRACE(scene);
    const double share = lazy_share(all, scene, {"half_space.colouring=index"});
    if (scene == std::string("grove")) {
      EXPECT_LT(share, 0.05);
    }
  }
}

/// Hulls cut by depth 0 are seen where no front plane was written: no number of an earlier hull may show there. Where a
/// front plane passes from 0 to 1 it is not written but equals front, so only `recolour` shows it.
TEST(PixelPlanesScenes, AHullBeforeTheScreenHasNoColourOfAnotherHull) {
  const Catalogue all = catalogue();
  const std::vector<std::string> cut{"half_space.depth_range=[6, 14]", "half_space.depth_bits=12"};
  std::vector<std::string> index = cut;
  index.push_back("half_space.colouring=index");
  const RunOutput again = execute(request(all, "figure5", cut), "", nullptr);
  const RunOutput numbers = execute(request(all, "figure5", index), "", nullptr);
  ASSERT_EQ(again.rgb.size(), numbers.rgb.size());
  std::int64_t differ = 0;
  for (std::size_t at = 0; at < again.rgb.size(); at += 3)
    differ += !std::equal(&again.rgb[at], &again.rgb[at] + 3, &numbers.rgb[at]);
  EXPECT_GT(again.object.error.covered_pixels, 5000);
  EXPECT_LT(differ * 100, again.object.error.covered_pixels);
}

TEST(PixelPlanesScenes, TheGrovesNearestDepthsAreThoseOfExactIntegers) {
  const Catalogue all = catalogue();
  const RunRequest r = request(all, "grove");
  const half_space::PreparedPlanes prepared = half_space::prepare_planes(r.file.scene, {});
  const auto job = r.algorithm->make(r.file.scene, *r.type, r.preset.parameters);
  Tape tape;
  job->run(tape);
  pixel_planes::Device device(pixel_planes::resolve(r.preset.parameters), true);
  for (const auto& [address, value] : tape.words) device.write(address, value);
  struct Streams {
    std::int64_t a, b, c;
  };
  std::vector<std::vector<Streams>> streams;
  for (const half_space::StreamHull& hull : prepared.hulls) {
    streams.emplace_back();
    for (const half_space::StreamPlane& p : hull.planes) {
      const auto value = [&](float v) { return igc::translate(v, p.fraction); };
      streams.back().push_back({value(p.expression.a), value(p.expression.b), value(p.expression.c)});
    }
  }
  for (int y = 0; y < 512; y += 7)
    for (int x = 0; x < 512; ++x) {
      std::int64_t nearest = prepared.maxdepth;
      for (std::size_t h = 0; h < prepared.hulls.size(); ++h) {
        const half_space::StreamHull& hull = prepared.hulls[h];
        std::int64_t front = 0, back = prepared.maxdepth;
        for (std::size_t n = 0; n < hull.planes.size(); ++n) {
          const half_space::StreamPlane& p = hull.planes[n];
          const Streams& e = streams[h][n];
          const std::int64_t t = (e.a * x + e.b * y + e.c) >> p.fraction;
          if (p.kind == half_space::PlaneKind::kFront) front = std::max(front, std::min(t, prepared.maxdepth));
          if (p.kind == half_space::PlaneKind::kBack) back = std::min(back, std::max<std::int64_t>(t, 0));
          if (p.kind == half_space::PlaneKind::kEdgeOn && t < 0) back = 0;
        }
        if (!hull.bounded && back == prepared.maxdepth) back = 0;
        if (hull.visible && front < back) nearest = std::min(nearest, front);
      }
      ASSERT_EQ(device.peek(static_cast<std::uint32_t>(y * 512 + x), prepared.layout.nearest) & 0xFFFF,
                static_cast<std::uint32_t>(nearest)) << x << " " << y;
    }
}

TEST(PixelPlanesScenes, TimeDoesNotDependOnTheSizeOfATree) {
  const Catalogue all = catalogue();
  const RunOutput small = execute(request(all, "figure5", {"camera.height=30", "half_space.guard_bits=14"}), "", nullptr);
  const RunOutput large = execute(request(all, "figure5", {"half_space.guard_bits=14"}), "", nullptr);
  EXPECT_EQ(small.object.instructions, large.object.instructions);
  EXPECT_LT(small.object.error.covered_pixels * 20, large.object.error.covered_pixels);
}

}  // namespace
}  // namespace dendro::study
