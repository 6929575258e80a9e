#include <gtest/gtest.h>

#include <cmath>

#include "models/machines/sgi_4d35/cycle.h"
#include "models/machines/sgi_4d35/estimate.h"
#include "models/machines/sgi_4d35/function.h"
#include "tests/lockstep/random_mips_program.h"
#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {
namespace {

/// Passes over 512 KB by a stride that misses often and now and then hits, products and sums that overlap, a store
/// behind a branch that the data decides.
ProgramImage stream(int passes) {
  using namespace r3000;
  Words code = {high(kT0, 0x2000),  // the R3010 is usable
                to_cp0(kT0, kStatus), high(kS4, 0x8002), add_immediate(kS5, 0, passes)};
  const std::size_t pass = code.size();
  code.insert(code.end(), {or_immediate(kT1, 0, 0x4000), high(kS4, 0x8002)});
  const std::size_t loop = code.size();
  code.insert(code.end(), {load(kT2, kS4), r_word(kFnMultu, 0, kT1, kT1), i_word(kMajorLwc1, 2, kS4, 32),
                           r_word(kFnMflo, kT3, 0, 0), r3010::fp_word(r3010::kSingle, r3010::kMul, 4, 2, 2),
                           i_word(kMajorAndi, kT0, kT3, 0x28), i_word(kMajorBne, kT0, 0, 3),
                           r3010::fp_word(r3010::kSingle, r3010::kAdd, 6, 6, 4),
                           r_word(kFnXor, kT2, kT2, kT3), store(kT2, kS4), add_immediate(kT1, kT1, -1)});
  code.push_back(i_word(kMajorBgtz, 0, kT1, static_cast<int>(loop) - static_cast<int>(code.size()) - 1));
  code.push_back(add_immediate(kS4, kS4, 20));
  code.push_back(add_immediate(kS5, kS5, -1));
  code.push_back(i_word(kMajorBgtz, 0, kS5, static_cast<int>(pass) - static_cast<int>(code.size()) - 1));
  code.insert(code.end(), {kNop, high(kT0, 0xBF00), store(kT0, kT0), kNop, kNop, kNop});
  return image_of({{kCode, code}}, kCode);
}

std::uint64_t value(const ProgramResult& result, const std::string& name) {
  for (const auto& [key, number] : result.units.front().values)
    if (key == name) return number;
  ADD_FAILURE() << name;
  return 0;
}

TEST(Sgi4d35Estimate, TheTrueCountLiesInTheIntervalAndNear) {
  const ProgramImage image = stream(40);
  StopService services;
  const ProgramResult exact = run_cycle(small(), image, services, UINT64_MAX, {});
  ASSERT_TRUE(exact.stopped);
  ASSERT_GT(exact.instructions, 5000000u);
  unsigned inside = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Sampling sampling;
    sampling.seed = seed;
    const ProgramResult estimate = run_estimate(small(), image, services, UINT64_MAX, {}, sampling);
    EXPECT_EQ(exact.instructions, estimate.instructions);
    const auto truth = static_cast<double>(exact.cycles), guess = static_cast<double>(estimate.cycles);
    EXPECT_LT(std::abs(guess / truth - 1), 0.008) << "seed " << seed;
    inside += value(estimate, "low") <= static_cast<std::uint64_t>(exact.cycles) &&
              static_cast<std::uint64_t>(exact.cycles) <= value(estimate, "high");
    EXPECT_GT(value(estimate, "windows"), 250u);
  }
  EXPECT_GE(inside, 9u);
}

TEST(Sgi4d35Estimate, AShortProgramIsExact) {
  const ProgramImage image = stream(1);
  StopService services;
  const ProgramResult exact = run_cycle(small(), image, services, 5000, {});
  const ProgramResult estimate = run_estimate(small(), image, services, 5000);
  EXPECT_EQ(exact.cycles, estimate.cycles);
  EXPECT_EQ(value(estimate, "low"), value(estimate, "high"));
}

/// Exceptions, refills of the TLB, interrupts, isolated caches, code that is written to, in and between the windows.
TEST(Sgi4d35Estimate, RandomProgramsEndAsAtFunction) {
  Sampling sampling;
  sampling.period = 64, sampling.lead_in = 7, sampling.window = 11, sampling.exact = 128;
  unsigned stopped = 0, sampled = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const CornerProgram program = corner_program(seed);
    const ProgramImage image = image_of(program.memory, program.start);
    const Spec spec = corner_spec(seed);
    StopService services;
    for (const std::uint64_t limit : {std::uint64_t{20000}, std::uint64_t{1 + seed * 7919 % 900}}) {
      const ProgramResult expected = run_function(spec, image, services, limit);
      const ProgramResult result = run_estimate(spec, image, services, limit, {}, sampling);
      ASSERT_EQ(expected.instructions, result.instructions) << "seed " << seed;
      ASSERT_EQ(expected.pc, result.pc) << "seed " << seed;
      ASSERT_EQ(expected.return_address, result.return_address) << "seed " << seed;
      ASSERT_EQ(expected.stopped, result.stopped) << "seed " << seed;
      stopped += result.stopped;
      sampled += value(result, "windows") > 1;
    }
  }
  EXPECT_GT(stopped, 100u);
  EXPECT_GT(sampled, 100u);
}

TEST(Sgi4d35Estimate, TheSameSeedGivesTheSameCount) {
  const ProgramImage image = stream(2);
  StopService services;
  EXPECT_EQ(run_estimate(small(), image, services, UINT64_MAX).cycles,
            run_estimate(small(), image, services, UINT64_MAX).cycles);
}

}  // namespace
}  // namespace dendro::sgi_4d35
