#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/lockstep/random_mips_program.h"
#include "tests/lockstep/sgi_4d35_lockstep.h"
#include "tests/sgi_4d35/random_program.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint64_t kLimit = 20000;

std::uint32_t programs() {
  const char* text = std::getenv("DENDRO_PROGRAMS");
  return text ? static_cast<std::uint32_t>(std::atoi(text)) : 200;
}

/// Every third run is cut off somewhere.
std::uint64_t limit_of(std::uint32_t seed) { return seed % 3 == 0 ? 1 + seed * 7919 % 900 : kLimit; }

/// The limit ended the run before a word of a handler, rfe perhaps: how a fetch behind it would be translated is not
/// defined.
bool undefined_end(const Ran& ran) { return !ran.stopped && ran.state.pc < kCode - 0x1000 && ran.state.pc >= 0x80000000; }

Ran unlogged(std::uint32_t seed) {
  const CornerProgram program = corner_program(seed);
  return run_unlogged(corner_spec(seed), image_of(program.memory, program.start), limit_of(seed));
}

void compare(const Spec& spec, const Memory& memory, std::uint32_t start, std::uint32_t seed) {
  const std::uint64_t limit = limit_of(seed);
  const Ran clocked = run_words(Level::kClocked, spec, memory, start, limit);
  if (undefined_end(clocked)) return;
  ASSERT_EQ("", difference(clocked, run_words(Level::kCycle, spec, memory, start, limit))) << "seed " << seed;
  ASSERT_EQ("", difference(clocked, run_unlogged(spec, image_of(memory, start), limit)))
      << "without a log, seed " << seed;
}

TEST(Sgi4d35Lockstep, CornerProgramsTakeTheSameClocksAtCycleAndClocked) {
  for (std::uint32_t seed = 1; seed <= programs() && !HasFatalFailure(); ++seed) {
    const CornerProgram program = corner_program(seed);
    compare(corner_spec(seed), program.memory, program.start, seed);
  }
}

TEST(Sgi4d35Lockstep, RandomProgramsTakeTheSameClocksAtCycleAndClocked) {
  for (std::uint32_t seed = 1; seed <= programs() && !HasFatalFailure(); ++seed)
    compare(seed % 4 == 0 ? small() : random_spec(seed), random_program(seed, 300, 3), kCode + 0x800, seed);
}

TEST(Sgi4d35Lockstep, CausesAddUpToTheCycles) {
  for (std::uint32_t seed = 1; seed <= programs(); ++seed)
    for (const char* unit : {"processor.", "memory."}) {
      const Ran ran = unlogged(seed);
      std::uint64_t sum = 0;
      for (const auto& [name, value] : ran.counters)
        if (name == std::string(unit) + "busy" || name == std::string(unit) + "idle" ||
            name.rfind(std::string(unit) + "stall_", 0) == 0)
          sum += value;
      ASSERT_EQ(ran.cycles, sum) << unit << " seed " << seed;
    }
}

TEST(Sgi4d35Lockstep, MostCornerProgramsEndAndSomeFault) {
  unsigned stopped = 0, faulted = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    const Ran ran = unlogged(seed);
    stopped += ran.stopped;
    faulted += ran.state.exceptions > 3;
  }
  EXPECT_GT(stopped, 90u);
  EXPECT_GT(faulted, 20u);
}

}  // namespace
}  // namespace dendro::sgi_4d35
