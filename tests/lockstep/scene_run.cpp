#include "tests/lockstep/scene_run.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace dendro::study {

RunOutput run_scene(const Catalogue& all, const std::string& scene, const std::string& level,
                    const std::vector<std::string>& settings, const MachineOptions& options) {
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
  for (std::size_t u = 0; u < a.units.size(); ++u) {
    ASSERT_EQ(a.units[u].values.size(), b.units[u].values.size()) << a.units[u].unit;
    for (std::size_t i = 0; i < a.units[u].values.size(); ++i)
      EXPECT_EQ(a.units[u].values[i], b.units[u].values[i]) << a.units[u].unit << " " << a.units[u].values[i].first;
  }
  EXPECT_EQ(a.marks, b.marks);
}

std::vector<std::string> scenes_or(const std::vector<std::string>& quick) {
  const char* named = std::getenv("DENDRO_SCENES");
  if (named == nullptr) return quick;
  std::vector<std::string> scenes;
  std::istringstream in(named);
  for (std::string scene; in >> scene;) scenes.push_back(scene);
  return scenes;
}

}  // namespace dendro::study
