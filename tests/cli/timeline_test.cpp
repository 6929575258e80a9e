#include <cmath>
#include <map>

#include "tests/cli/cli.h"

namespace dendro::cli {
namespace {

using nlohmann::json;

/// Ticks of one unit by cause, window after window.
using Ticks = std::map<std::string, std::vector<double>>;

class Timeline : public CommandTest {
 protected:
  Timeline() {
    write("s.toml", scene_with("solid = \"icosahedron\"\n[[object]]\nsolid = \"icosahedron\"\nat = [0.4, 0, 0]\n"));
  }

  /// One run of the scene with a short program load, so that the host's and the machine's time are alike.
  void run(const std::string& name, const std::string& more = "") const {
    const Result result = dendro("run s.toml --quiet --set parameters.host.program_load_s=0.05 --out " + name +
                                 " --timeline " + name + ".json " + more);
    ASSERT_EQ(0, result.status) << result.err;
  }
  json stats(const std::string& name) const { return json::parse(read(name + "/stats.json")); }
  std::vector<json> events(const std::string& name, const std::string& kind) const {
    std::vector<json> found;
    const json trace = json::parse(read(name + ".json"));
    for (const json& event : trace["traceEvents"])
      if (event["ph"] == kind && event["name"] != "whole run") found.push_back(event);
    return found;
  }

  /// A unit's counters turned back from percent to ticks; a window ends where the next begins.
  Ticks ticks(const std::string& name, const std::string& unit) const {
    const json object = stats(name);
    const double us = 1e6 / object["clock_hz"].get<double>(), end = object["cycles"].get<double>() * us;
    const double width = object["units"][unit]["cycles"].get<double>() / object["cycles"].get<double>();
    std::vector<json> windows;
    for (const json& event : events(name, "C"))
      if (event["name"] == unit) windows.push_back(event);
    Ticks found;
    for (std::size_t i = 0; i < windows.size(); ++i) {
      const double from = windows[i]["ts"], to = i + 1 < windows.size() ? windows[i + 1]["ts"].get<double>() : end;
      for (const auto& [cause, share] : windows[i]["args"].items())
        found[cause].push_back(share.get<double>() / 100 * std::round((to - from) / us) * width);
    }
    return found;
  }
  static double sum(const std::vector<double>& values) {
    double total = 0;
    for (const double v : values) total += v;
    return total;
  }
};

constexpr const char* kUnits[] = {"rds3000.processor", "rds3000.bus", "rds3000.frame_memory", "rds3000.host"};

TEST_F(Timeline, ThePhasesStandOneAfterAnotherAsOftenAsTheyCome) {
  run("r");
  std::map<std::string, double> in_timeline, in_stats;
  double at = 0;
  for (const json& span : events("r", "X")) {
    EXPECT_NEAR(at, span["ts"].get<double>(), 1e-3);
    at += span["dur"].get<double>();
    in_timeline[span["name"]] += span["args"]["ticks"].get<double>();
  }
  const json object = stats("r");
  for (const json& phase : object["phases"]) in_stats[phase["name"]] += phase["cycles"].get<double>();
  EXPECT_EQ(in_stats, in_timeline);
  EXPECT_LT(object["phases"].size(), events("r", "X").size()) << "two objects: the machine starts more than once";
}

TEST_F(Timeline, TheWindowsOfEveryUnitAddUpToItsCounters) {
  run("r");
  const json units = stats("r")["units"];
  for (const char* unit : kUnits) {
    int causes = 0;
    for (const auto& [cause, values] : ticks("r", unit)) {
      EXPECT_LT(400u, values.size()) << unit;
      for (const double v : values) {
        ASSERT_GE(v, 0) << unit << " " << cause;
        ASSERT_NEAR(std::round(v), v, 1e-4) << unit << " " << cause << ": whole ticks";
      }
      EXPECT_NEAR(units[unit][cause].get<double>(), sum(values), 1e-2) << unit << " " << cause;
      ++causes;
    }
    EXPECT_LE(1, causes) << unit;
  }
}

// `clocked` counts every tick as it comes. An access may fall into another window there: `cycle` books it when it asks.
TEST_F(Timeline, EveryWindowIsThatOfTheClockedLevel) {
  run("cycle");
  run("clocked", "--level clocked");
  for (const char* unit : kUnits) {
    const Ticks cycle = ticks("cycle", unit), clocked = ticks("clocked", unit);
    ASSERT_EQ(cycle.size(), clocked.size());
    const bool books = unit == std::string("rds3000.bus") || unit == std::string("rds3000.frame_memory");
    for (const auto& [cause, values] : cycle) {
      ASSERT_EQ(values.size(), clocked.at(cause).size());
      for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_NEAR(clocked.at(cause)[i], values[i], books ? 60 : 1e-4) << unit << " " << cause << ", window " << i;
    }
  }
}

TEST_F(Timeline, TheProcessorRestsWhileTheHostHasItsPhases) {
  run("r");
  const json first = events("r", "X").front();
  std::size_t windows = 0;
  double ran = 0;
  for (const json& event : events("r", "C")) {
    if (event["name"] != "rds3000.processor") continue;
    if (event["ts"].get<double>() + 3000 < first["dur"].get<double>()) {
      ++windows;
      for (const auto& [cause, share] : event["args"].items()) EXPECT_EQ(0.0, share.get<double>()) << cause;
    }
    ran += event["args"]["busy"].get<double>();
  }
  EXPECT_LT(5u, windows);
  EXPECT_LT(0.0, ran);
}

TEST_F(Timeline, LookingChangesNothing) {
  run("with");
  ASSERT_EQ(0, dendro("run s.toml --quiet --set parameters.host.program_load_s=0.05 --out without").status);
  const json with = stats("with"), without = stats("without");
  for (const char* key : {"cycles", "phases", "units", "marks"}) EXPECT_EQ(without[key], with[key]) << key;
  EXPECT_EQ(without["image"]["sha256"], with["image"]["sha256"]);
  EXPECT_EQ(0u, read("with/timeline.png").find("\x89PNG"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "without/timeline.png"));
}

TEST_F(Timeline, ThereIsNoneWithoutTime) {
  expect_user_error("run s.toml --level function --timeline f.json", "--timeline: there is no time");
}

}  // namespace
}  // namespace dendro::cli
