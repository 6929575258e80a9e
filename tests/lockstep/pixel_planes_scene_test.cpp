#include <gtest/gtest.h>

#include <string>

#include "models/machines/pixel_planes/pixel_planes.h"
#include "sim/study/algorithms.h"
#include "sim/study/run.h"
#include "tests/lockstep/pixel_planes_lockstep.h"
#include "tests/support/in_child.h"

namespace dendro::pixel_planes {
namespace {

using Settings = std::vector<std::string>;

/// All three levels draw the scene; all bits of all pixels, and at the two with time all clocks, must be
/// equal.
void expect_levels_equal(const std::string& scene, const Settings& settings, const std::string& machine_name = "pixel-planes") {
  const study::Catalogue all{{pixel_planes_type()}, study::algorithms(), SHARE};
  study::RunArguments arguments;
  arguments.scene = scene;
  arguments.machine = machine_name;
  arguments.settings = settings;
  in_child(
      [&] {
        const study::RunRequest request = study::prepare_run(all, arguments);
        const auto machine_after_run = [&](Level level) {
          const auto job =
              request.algorithm->make(request.file.scene, *request.type, request.preset.parameters);
          MachineOptions options;
          for (const FirmwareImage& image : job->firmware()) {
            const auto marks = study::marked_words(image.symbols);
            options.marks.insert(marks.begin(), marks.end());
          }
          auto machine = request.type->make(request.preset.parameters, level, options);
          machine->run([&](HostPort& port) { job->run(port); });
          return machine;
        };
        const Spec spec = resolve(request.preset.parameters);
        const auto cycle = machine_after_run(Level::kCycle), clocked = machine_after_run(Level::kClocked),
                   function = machine_after_run(Level::kFunction);
        EXPECT_GT(cycle->instructions(), 0u);
        expect_same(*cycle, *clocked, spec);
        expect_same_pixels(*cycle, *function, spec, "cycle | function");
        EXPECT_EQ(cycle->instructions(), function->instructions());
        EXPECT_TRUE(cycle->picture().rgb == function->picture().rgb);
      },
      scene);
}

class Scene : public testing::TestWithParam<std::string> {};

TEST_P(Scene, IsEqualInEveryBitOfEveryPixelAndEveryClock) { expect_levels_equal(GetParam(), {}); }

INSTANTIATE_TEST_SUITE_P(Shipped, Scene,
                         testing::Values("icosahedron", "aspen-hull", "bishop-hull", "pine-hull", "crown",
                                         "figure5", "grove"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(PixelPlanesScenes, EveryVariantIsEqual) {
  const std::string quick = "parameters.host.program_load_ms=0.1";
  for (const Settings& settings :
       std::vector<Settings>{{quick, "half_space.colouring=\"index\"", "half_space.depth_bits=12"},
                             {quick, "half_space.variant=\"scratch\"", "parameters.array.ports=2"},
                             {quick, "parameters.tree.masked=false", "parameters.tree.gap_clocks=8"},
                             {quick, "parameters.tree.masked=false", "parameters.tree.gap_clocks=18"},
                             {quick, "parameters.array.ports=2", "parameters.array.memory_bits=96"}}) {
    SCOPED_TRACE(settings[1]);
    expect_levels_equal("icosahedron", settings);
  }
}

TEST(PixelPlanesScenes, TiledPicturesAreEqualWhateverTheNumberOfRenderers) {
  for (const char* renderers : {"16", "3", "1"}) {
    SCOPED_TRACE(renderers);
    expect_levels_equal("grove", {"parameters.host.program_load_ms=0.1", std::string("parameters.renderers.count=") + renderers},
                        "pixel-planes:pxpl5");
  }
}

TEST(PixelPlanesScenes, TiledPrimitivesAreEqual) {
  const std::string quick = "parameters.host.program_load_ms=0.1", steps = "raster_primitives.patch_steps=1";
  for (const char* scene : {"teapot", "shadows"})
    expect_levels_equal(scene, {quick, steps, "parameters.renderers.count=5"}, "pixel-planes:pxpl5");
  expect_levels_equal("buckyball", {quick, "parameters.renderers.count=3"}, "pixel-planes:pxpl5");
  expect_levels_equal("radiograph", {quick, "image.width=32", "image.height=32", "adaptive_equalisation.region=16"},
                      "pixel-planes:pxpl5");
}

TEST(PixelPlanesScenes, EqualisationIsEqualWhicheverWayRegionsAreSent) {
  for (const char* method : {"polygon", "rows"}) {
    SCOPED_TRACE(method);
    expect_levels_equal("radiograph",
                        {"parameters.host.program_load_ms=0.1", "parameters.array.width=64", "parameters.array.height=64",
                         "image.width=64", "image.height=48", "adaptive_equalisation.region=16",
                         std::string("adaptive_equalisation.method=") + method});
  }
}

TEST(PixelPlanesScenes, TexturesAreEqual) {
  const Settings settings = {"parameters.host.program_load_ms=0.1", "raster_primitives.patch_steps=1",
                             "raster_primitives.texture_size=16"};
  expect_levels_equal("textured", settings);
  expect_levels_equal("textured", settings, "pixel-planes:pxpl5");
}

/// The picture at level `clocked`, by the route of `dendro run`.
std::vector<std::uint8_t> clocked_picture(const std::string& gap) {
  const study::Catalogue all{{pixel_planes_type()}, study::algorithms(), SHARE};
  study::RunArguments arguments;
  arguments.scene = "icosahedron";
  arguments.machine = "pixel-planes";
  arguments.level = "clocked";
  arguments.settings = {"parameters.host.program_load_ms=0.1", "parameters.tree.masked=false",
                        "parameters.tree.gap_clocks=" + gap};
  return study::execute_in_worker(study::prepare_run(all, arguments), "", nullptr).rgb;
}

TEST(PixelPlanesScenes, AGapOneClockShortRunsAtClockedAndSpoilsThePicture) {
  const std::vector<std::uint8_t> right = clocked_picture("8");
  EXPECT_EQ(clocked_picture("9"), right);
  EXPECT_NE(clocked_picture("7"), right);
}

}  // namespace
}  // namespace dendro::pixel_planes
