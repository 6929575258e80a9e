#include <algorithm>

#include "models/machines/sgi_4d35/board.h"
#include "models/parts/r3000/r3000.h"
#include "tests/sgi_4d35/random_program.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint32_t kStart = 0x80010800;

/// What the core without time makes of the program.
r3000::State untimed(const Spec& spec, const Memory& memory, std::uint64_t limit, std::uint64_t& digest) {
  StopService services;
  const ProgramImage image = image_of(memory, kStart);
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board> core(spec.processor, board);
  start(core.state(), image);
  core.run(limit);
  r3000::State s = core.state();
  r3000::finish_load(s);
  digest = digest_of(board.memory);
  return s;
}

void expect_sane(const Ran& ran) {
  std::uint64_t sum = 0;
  for (const auto& [name, value] : ran.counters) {
    const bool stall = name.rfind("processor.stall_", 0) == 0;
    if (stall || name == "processor.busy") sum += value;
  }
  EXPECT_EQ(ran.cycles, sum);
  EXPECT_EQ(ran.instructions, ran.counters.at("processor.busy"));
  EXPECT_LE(ran.counters.at("memory.busy"), ran.cycles);
  EXPECT_LE(ran.counters.at("data_cache.misses"), ran.counters.at("data_cache.busy"));
  EXPECT_EQ(ran.retired.empty() ? 0 : ran.retired.back().clock + 1, ran.cycles);
  EXPECT_TRUE(std::is_sorted(ran.retired.begin(), ran.retired.end(),
                             [](const Retired& a, const Retired& b) { return a.clock < b.clock; }));
}

class Sgi4d35Random : public ::testing::TestWithParam<Level> {
 protected:
  void compare(std::uint32_t first, std::uint32_t seeds, unsigned words, unsigned passes) {
    for (std::uint32_t seed = first; seed < first + seeds && !HasFailure(); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const Memory program = random_program(seed, words, passes);
      const Spec spec = seed % 4 == 0 ? small() : random_spec(seed);
      // Every third run is cut off somewhere.
      const std::uint64_t limit = seed % 3 == 0 ? 1 + seed * 7919 % (words * passes) : 20000;
      std::uint64_t digest = 0;
      const r3000::State expected = untimed(spec, program, limit, digest);
      const Ran ran = run_words(GetParam(), spec, program, kStart, limit);
      EXPECT_EQ("", state_difference(expected, ran.state));
      expect_sane(ran);
      if (ran.stopped) {
        EXPECT_EQ(digest, ran.memory_digest);
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Levels, Sgi4d35Random, ::testing::Values(Level::kCycle, Level::kClocked),
                         [](const auto& level) { return level_name(level.param); });

TEST_P(Sgi4d35Random, ProgramsLeaveWhatTheCoreWithoutTimeLeaves) { compare(1, 100, 300, 3); }

TEST_P(Sgi4d35Random, LongProgramsLeaveWhatTheCoreWithoutTimeLeaves) { compare(1000, 800, 600, 4); }

TEST_P(Sgi4d35Random, AStoreIntoTheNextWordsIsSeen) {
  for (const unsigned distance : {1u, 2u, 3u, 4u, 12u}) {
    Words code = {high(kT0, static_cast<int>(kStart >> 16)), or_immediate(kT0, kT0, kStart & 0xFFFF),
                  high(kT1, static_cast<int>(add_immediate(kT2, kT2, 77) >> 16)),
                  or_immediate(kT1, kT1, static_cast<int>(add_immediate(kT2, kT2, 77) & 0xFFFF)),
                  add_immediate(kT2, 0, 1)};
    code.push_back(store(kT1, kT0, static_cast<int>(4 * (code.size() + distance))));
    code.insert(code.end(), 16, add_immediate(kT2, kT2, 1));
    const Ran ran = run_words(GetParam(), small(), {{kStart, code}}, kStart, code.size());
    EXPECT_EQ(1u + 15 + 77, ran.state.r[kT2]) << distance;
  }
}

}  // namespace
}  // namespace dendro::sgi_4d35
