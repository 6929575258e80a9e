#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/lockstep/random_mips_program.h"
#include "tests/lockstep/sgi_4d35_lockstep.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint64_t kLimit = 20000;

std::uint32_t programs() {
  const char* text = std::getenv("DENDRO_PROGRAMS");
  return text ? static_cast<std::uint32_t>(std::atoi(text)) : 400;
}

Outcome run_seed(Level level, std::uint32_t seed, bool log) {
  ExitService services;
  return run(level, random_spec(seed), random_program(seed), services, kLimit, log);
}

TEST(Sgi4d35Random, LookingAtEveryWordChangesNothing) {
  for (std::uint32_t seed = 1; seed <= programs(); ++seed) {
    const Outcome fast = run_seed(Level::kCycle, seed, false), careful = run_seed(Level::kCycle, seed, true);
    ASSERT_EQ("", difference(fast, careful)) << "seed " << seed;
  }
}

TEST(Sgi4d35Random, CausesAddUpToTheCycles) {
  for (std::uint32_t seed = 1; seed <= programs(); ++seed)
    for (const UnitStats& unit : run_seed(Level::kCycle, seed, false).result.units) {
      if (unit.values.front().first != "cycles") continue;
      std::uint64_t sum = 0;
      for (const auto& [name, value] : unit.values)
        if (name == "busy" || name == "idle" || name.rfind("stall_", 0) == 0) sum += value;
      ASSERT_EQ(unit.values.front().second, sum) << unit.unit << ", seed " << seed;
    }
}

TEST(Sgi4d35Random, MostProgramsEndAndSomeFault) {
  unsigned stopped = 0, faulted = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    const Outcome outcome = run_seed(Level::kCycle, seed, false);
    stopped += outcome.result.stopped;
    faulted += outcome.state.exceptions > 3;
  }
  EXPECT_GT(stopped, 90u);
  EXPECT_GT(faulted, 20u);
}

}  // namespace
}  // namespace dendro::sgi_4d35
