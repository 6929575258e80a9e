#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/lockstep/random_microprogram.h"

namespace dendro::test {
namespace {

/// DENDRO_SEED repeats one program; DENDRO_PROGRAMS sets how many are tried (the long proof of `./dev test --all`).
std::uint64_t setting(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : fallback;
}

void compare_levels(const Flavour& flavour, std::uint64_t salt) {
  const bool one = std::getenv("DENDRO_SEED") != nullptr;
  const std::uint64_t first = setting("DENDRO_SEED", salt);
  const std::uint64_t count = one ? 1 : setting("DENDRO_PROGRAMS", 150);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE("repeat with DENDRO_SEED=" + std::to_string(seed));
    const RandomRun run = random_run(seed, flavour);
    MachineOptions options;
    options.tick_limit = 1 << 17;  // a branch into a loop may never end: then both must say so
    const Outcome cycle = run_rds3000(Level::kCycle, run.spec, options, run.host);
    const Outcome clocked = run_rds3000(Level::kClocked, run.spec, options, run.host);
    ASSERT_EQ(first_difference(cycle.timing, clocked.timing), "") << "timing, cycle | clocked";
    ASSERT_EQ(first_difference(cycle.state, clocked.state), "") << "state, cycle | clocked";
    if (!flavour.host_meddles && !cycle.time_dependent && !cycle.timing.empty()) {
      const Outcome function = run_rds3000(Level::kFunction, run.spec, options, run.host);
      ASSERT_EQ(first_difference(cycle.state, function.state), "") << "state, cycle | function";
    }
  }
}

TEST(RandomLockstep, ProgramsThatDoNotReadTimeAreEqualAtAllThreeLevels) { compare_levels({false, false}, 1000); }

TEST(RandomLockstep, ProgramsThatReadTimeAreEqualAtCycleAndClocked) { compare_levels({true, false}, 2000000); }

TEST(RandomLockstep, AHostThatAccessesTheRunningMachineSeesAndDoesTheSame) {
  compare_levels({true, true}, 3000000);
}

}  // namespace
}  // namespace dendro::test
