#include <gtest/gtest.h>

#include <string>

#include "models/machines/rds3000/rds3000.h"
#include "tests/lockstep/scene_run.h"

namespace dendro::study {
namespace {

class Scene : public testing::TestWithParam<std::tuple<std::string, const char*>> {};

const std::vector<std::string> kShipped{"icosahedron", "aspen-hull", "bishop-hull", "pine-hull", "crown", "figure5",
                                        "figure6", "figure6-wide", "mesh-tree"};

TEST_P(Scene, HasTheSameTicksCountersAndPictureAtCycleAndClockedAndThePictureAtFunction) {
  const auto& [scene, pack] = GetParam();
  const Catalogue all{{rds3000::rds3000_type()}, algorithms(), SHARE};
  const std::vector<std::string> settings{std::string("parameters.microcode.pack=") + pack};
  const RunOutput cycle = run_scene(all, scene, "cycle", settings), clocked = run_scene(all, scene, "clocked", settings),
                  function = run_scene(all, scene, "function", settings);
  expect_same_time(cycle.object, clocked.object);
  EXPECT_EQ(cycle.rgb, clocked.rgb);
  EXPECT_EQ(cycle.rgb, function.rgb);
  EXPECT_FALSE(cycle.object.time_dependent);
  EXPECT_EQ(cycle.object.instructions, function.object.instructions);
  for (const auto& [name, value] : cycle.object.error.extra)
    EXPECT_TRUE((name != "wrong_pixels_far" && name != "outside_enclosure" && name != "bark_outside") || value == 0) << name << " " << value;
  EXPECT_LE(cycle.object.error.max_depth_error, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Scene,
                         testing::Combine(testing::ValuesIn(scenes_or(kShipped)), testing::Values("none", "full")),
                         [](const auto& instance) {
                           std::string name = std::get<0>(instance.param) + "_" + std::get<1>(instance.param);
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(Parameters, EveryEndOfTheirRangesGivesTheSameTicksByBothRoutesAndTheSamePicture) {
  const Catalogue all{{rds3000::rds3000_type()}, algorithms(), SHARE};
  const std::vector<std::string> small{"image.width=96", "image.height=64", "half_space.starting_box=\"full\""};
  const RunOutput nominal = run_scene(all, "icosahedron", "cycle", small);
  for (const char* setting :
       {"processor.accesses_in_flight=0", "processor.taken_branch_ticks=1", "processor.scratch_ticks=2",
        "bus.arbitration_ticks=1", "bus.write_ticks=2", "frame_memory.card_busy_ticks=3", "frame_memory.read_ticks=3",
        "frame_memory.read_ticks=6", "frame_memory.fetch_ticks=0", "frame_memory.refresh_interval_ns=15625",
        "video.display_mode=\"blanked\"", "video.display_mode=1", "video.phase_ns=20000000.0",
        "frame_memory.bits_per_pixel=32", "frame_memory.bits_per_pixel=48", "processor.tick_ns=150"}) {
    SCOPED_TRACE(setting);
    std::vector<std::string> settings = small;
    settings.push_back(std::string("parameters.") + setting);
    settings.push_back("parameters.host.program_load_s=0.01");
    const RunOutput cycle = run_scene(all, "icosahedron", "cycle", settings),
                    clocked = run_scene(all, "icosahedron", "clocked", settings);
    expect_same_time(cycle.object, clocked.object);
    EXPECT_EQ(cycle.rgb, nominal.rgb);
    EXPECT_EQ(clocked.rgb, nominal.rgb);
  }
}

TEST(Parameters, TheDisplaySPhaseAtTheStartMovesTheRun) {
  const Catalogue all{{rds3000::rds3000_type()}, algorithms(), SHARE};
  const std::int64_t nominal = run_scene(all, "icosahedron", "cycle", {}).object.cycles;
  EXPECT_NE(run_scene(all, "icosahedron", "cycle", {"parameters.video.phase_ns=20000000.0"}).object.cycles, nominal);
}

TEST(Units, AMachineWithAllUnitsTakesTheSameTicksAsOneWithTheSceneS) {
  const Catalogue all{{rds3000::rds3000_type()}, algorithms(), SHARE};
  const std::vector<std::string> settings{"image.width=96", "image.height=64",
                                          "parameters.video.display_mode=\"blanked\"",
                                          "parameters.host.program_load_s=0.01"};
  MachineOptions everything;
  everything.all_units = true;
  for (const char* level : {"cycle", "clocked"}) {
    const RunOutput some = run_scene(all, "icosahedron", level, settings),
                    every = run_scene(all, "icosahedron", level, settings, everything);
    EXPECT_LT(some.object.elaborated.size(), every.object.elaborated.size());
    expect_same_time(some.object, every.object);
    EXPECT_EQ(some.rgb, every.rgb);
  }
}

}  // namespace
}  // namespace dendro::study
