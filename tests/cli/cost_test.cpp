#include <numeric>

#include "sim/scene/image_io.h"
#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;

class Cost : public CommandTest {
 protected:
  Cost() { write("s.toml", scene_with("solid = \"icosahedron\"\n")); }

  /// The sum of one channel of a measuring picture.
  double sum(const std::string& file, const std::string& channel) const {
    int width = 0, height = 0;
    for (const auto& [name, values] : scene::read_exr((folder_ / file).string(), width, height))
      if (name == channel) return std::accumulate(values.begin(), values.end(), 0.0);
    ADD_FAILURE() << channel;
    return 0;
  }
};

TEST_F(Cost, EveryTickOfTheMachineBelongsToAPixelOrIsToldToBeElsewhere) {
  for (const std::string mode : {"0", "\"blanked\""}) {
    ASSERT_EQ(0, dendro("run s.toml --cost --quiet --out r --set parameters.video.display_mode=" + mode).status);
    const json o = json::parse(read("r/stats.json"));
    double machine = 0;
    for (const json& phase : o["phases"])
      if (phase["where"] == "machine") machine += phase["cycles"].get<double>();
    const double elsewhere = o["facts"]["cost.elsewhere_ticks"];
    EXPECT_EQ(machine, sum("r/image.exr", "cost.ticks") + elsewhere);
    EXPECT_LT(elsewhere, machine / 10);
  }
}

TEST_F(Cost, VisitsAreTheAccessesOfTheBus) {
  ASSERT_EQ(0, dendro("run s.toml --cost --quiet --out r").status);
  const json bus = json::parse(read("r/stats.json"))["units"]["rds3000.bus"];
  const double accesses = bus["processor_reads"].get<double>() + bus["processor_writes"].get<double>();
  const double visits = sum("r/image.exr", "cost.visits");
  EXPECT_LE(visits, accesses) << "registers are on the bus, too";
  EXPECT_GT(visits, accesses * 0.99);
}

TEST_F(Cost, TheAccountChangesNothingElse) {
  ASSERT_EQ(0, dendro("run s.toml --cost --quiet --out with").status);
  ASSERT_EQ(0, dendro("run s.toml --quiet --out without").status);
  const json a = json::parse(read("with/stats.json")), b = json::parse(read("without/stats.json"));
  for (const char* key : {"cycles", "phases", "units", "marks", "error"}) EXPECT_EQ(a[key], b[key]) << key;
  EXPECT_EQ(read("with/image.png"), read("without/image.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "with/cost_ticks.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "with/cost_visits.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "without/cost_ticks.png"));
}

TEST_F(Cost, OtherLevelsKeepNoAccount) {
  expect_user_error("run s.toml --cost --level function", "--cost: ticks are counted by pixel at --level cycle only");
  expect_user_error("run s.toml --cost --level clocked", "--cost");
}

}  // namespace
}  // namespace dendro::cli
