#include <algorithm>

#include "models/machines/sgi_4d35/board.h"
#include "models/parts/r3000/r3000.h"
#include "tests/sgi_4d35/random_program.h"

namespace dendro::sgi_4d35 {
namespace {

class Stop : public service_block::Services {
  service_block::CallResult call(std::uint32_t, const std::array<std::uint32_t, 4>&,
                                 std::vector<std::uint8_t>&) override {
    return {0, false, true};
  }
};

constexpr std::uint32_t kStart = 0x80010800;

/// What the core without time makes of the program.
r3000::State untimed(const Spec& spec, const Memory& memory, std::uint64_t limit, std::uint64_t& digest) {
  Stop services;
  const ProgramImage image = image_of(memory, kStart);
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board> core(spec.processor, board);
  core.state().pc = kStart;
  core.state().next_pc = kStart + 4;
  core.state().status = 0;
  core.run(limit);
  r3000::State s = core.state();
  if (s.pending_reg != 0) s.r[s.pending_reg] = s.pending_value;
  digest = digest_of(board.memory);
  return s;
}

void expect_same(const r3000::State& a, const r3000::State& b) {
  for (unsigned r = 0; r < 32; ++r) EXPECT_EQ(a.r[r], b.r[r]) << "r" << r;
  for (unsigned r = 0; r < 32; ++r) EXPECT_EQ(a.fpu.r[r], b.fpu.r[r]) << "f" << r;
  for (unsigned i = 0; i < a.tlb.size(); ++i) {
    EXPECT_EQ(a.tlb[i].hi, b.tlb[i].hi) << i;
    EXPECT_EQ(a.tlb[i].lo, b.tlb[i].lo) << i;
  }
  EXPECT_EQ(a.fpu.control, b.fpu.control);
  EXPECT_EQ(a.hi, b.hi);
  EXPECT_EQ(a.lo, b.lo);
  EXPECT_EQ(a.pc, b.pc);
  EXPECT_EQ(a.next_pc, b.next_pc);
  EXPECT_EQ(a.in_slot, b.in_slot);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.cause, b.cause);
  EXPECT_EQ(a.epc, b.epc);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.context, b.context);
  EXPECT_EQ(a.bad_vaddr, b.bad_vaddr);
  EXPECT_EQ(a.entry_hi, b.entry_hi);
  EXPECT_EQ(a.entry_lo, b.entry_lo);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.instructions, b.instructions);
  EXPECT_EQ(a.exceptions, b.exceptions);
  EXPECT_EQ(a.tlb_refills, b.tlb_refills);
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
      expect_same(expected, ran.state);
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
