#include <gtest/gtest.h>

#include <map>

#include "sim/stats/run_object.h"

namespace dendro::stats {
namespace {

std::map<std::string, double> map_of(const RunObject& run) {
  std::map<std::string, double> map;
  for (const auto& [name, value] : figures(run)) EXPECT_TRUE(map.emplace(name, value).second) << name;
  return map;
}

TEST(Figures, PhasesOfOneNameAddUp) {
  RunObject run;
  run.phases = {{"load", 10, 0.5, true}, {"scan", 7, 0.25, false}, {"load", 5, 0.125, true}};
  const auto map = map_of(run);
  EXPECT_EQ(15, map.at("phase.load.cycles"));
  EXPECT_EQ(0.625, map.at("phase.load.seconds"));
  EXPECT_EQ(7, map.at("phase.scan.cycles"));
}

TEST(Figures, MachineTimeIsMachineTicksByTheClock) {
  RunObject run;
  run.clock_hz = 4;
  run.machine_cycles = 6;
  EXPECT_EQ(1.5, map_of(run).at("machine_seconds"));
}

TEST(Figures, CountersFactsAndErrorsGoByTheirNames) {
  RunObject run;
  run.units = {{"m.cpu", {{"cycles", 9}, {"busy", 4}}}};
  run.facts = {{"planes", 16}};
  run.error.wrong_pixels = 3;
  const auto map = map_of(run);
  EXPECT_EQ(4, map.at("m.cpu.busy"));
  EXPECT_EQ(16, map.at("fact.planes"));
  EXPECT_EQ(3, map.at("error.wrong_pixels"));
  EXPECT_EQ(0u, map.count("error.psnr_db")) << "identical pictures have no ratio";
}

}  // namespace
}  // namespace dendro::stats
