#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>

#include "models/machines/rds3000/rds3000.h"
#include "sim/study/run.h"

namespace dendro::study {
namespace {

Catalogue catalogue() { return {{rds3000::rds3000_type()}, algorithms(), SHARE}; }

RunOutput run(const Catalogue& all, const std::string& scene, const std::string& level,
              const std::vector<std::string>& settings, const MachineOptions& options = {}) {
  RunArguments arguments;
  arguments.scene = scene;
  arguments.level = level;
  arguments.settings = settings;
  arguments.options = options;
  return execute_in_worker(prepare_run(all, arguments), "", nullptr);
}

void expect_same_time(const stats::RunObject& a, const stats::RunObject& b) {
  EXPECT_GT(a.cycles, 0);
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.instructions, b.instructions);
  ASSERT_EQ(a.phases.size(), b.phases.size());
  for (std::size_t i = 0; i < a.phases.size(); ++i) {
    EXPECT_EQ(a.phases[i].name, b.phases[i].name);
    EXPECT_EQ(a.phases[i].cycles, b.phases[i].cycles) << a.phases[i].name;
  }
  ASSERT_EQ(a.units.size(), b.units.size());
  for (std::size_t u = 0; u < a.units.size(); ++u)
    for (std::size_t i = 0; i < a.units[u].values.size(); ++i)
      EXPECT_EQ(a.units[u].values[i], b.units[u].values[i]) << a.units[u].unit << " " << a.units[u].values[i].first;
  EXPECT_EQ(a.marks, b.marks);
}

class Scene : public testing::TestWithParam<std::tuple<std::string, const char*>> {};

/// Those named in DENDRO_SCENES, else all that are quick enough for every run of the tests.
std::vector<std::string> shipped_scenes() {
  const char* named = std::getenv("DENDRO_SCENES");
  if (named == nullptr) return {"icosahedron", "aspen-hull", "bishop-hull", "pine-hull", "crown", "figure5",
                                 "figure6", "figure6-wide", "mesh-tree"};
  std::vector<std::string> scenes;
  std::istringstream in(named);
  for (std::string scene; in >> scene;) scenes.push_back(scene);
  return scenes;
}

TEST_P(Scene, HasTheSameTicksCountersAndPictureAtCycleAndClockedAndThePictureAtFunction) {
  const auto& [scene, pack] = GetParam();
  const Catalogue all = catalogue();
  const std::vector<std::string> settings{std::string("parameters.microcode.pack=") + pack};
  const RunOutput cycle = run(all, scene, "cycle", settings), clocked = run(all, scene, "clocked", settings),
                  function = run(all, scene, "function", settings);
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
                         testing::Combine(testing::ValuesIn(shipped_scenes()), testing::Values("none", "full")),
                         [](const auto& instance) {
                           std::string name = std::get<0>(instance.param) + "_" + std::get<1>(instance.param);
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(Parameters, EveryEndOfTheirRangesGivesTheSameTicksByBothRoutesAndTheSamePicture) {
  const Catalogue all = catalogue();
  const std::vector<std::string> small{"image.width=96", "image.height=64", "half_space.starting_box=\"full\""};
  const RunOutput nominal = run(all, "icosahedron", "cycle", small);
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
    const RunOutput cycle = run(all, "icosahedron", "cycle", settings),
                    clocked = run(all, "icosahedron", "clocked", settings);
    expect_same_time(cycle.object, clocked.object);
    EXPECT_EQ(cycle.rgb, nominal.rgb);
    EXPECT_EQ(clocked.rgb, nominal.rgb);
  }
}

TEST(Parameters, TheDisplaySPhaseAtTheStartMovesTheRun) {
  const Catalogue all = catalogue();
  const std::int64_t nominal = run(all, "icosahedron", "cycle", {}).object.cycles;
  EXPECT_NE(run(all, "icosahedron", "cycle", {"parameters.video.phase_ns=20000000.0"}).object.cycles, nominal);
}

TEST(Units, AMachineWithAllUnitsTakesTheSameTicksAsOneWithTheSceneS) {
  const Catalogue all = catalogue();
  const std::vector<std::string> settings{"image.width=96", "image.height=64",
                                          "parameters.video.display_mode=\"blanked\"",
                                          "parameters.host.program_load_s=0.01"};
  MachineOptions everything;
  everything.all_units = true;
  for (const char* level : {"cycle", "clocked"}) {
    const RunOutput some = run(all, "icosahedron", level, settings),
                    every = run(all, "icosahedron", level, settings, everything);
    EXPECT_LT(some.object.elaborated.size(), every.object.elaborated.size());
    expect_same_time(some.object, every.object);
    EXPECT_EQ(some.rgb, every.rgb);
  }
}

}  // namespace
}  // namespace dendro::study
