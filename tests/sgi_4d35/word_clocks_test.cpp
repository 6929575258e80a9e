#include <gtest/gtest.h>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/clocked.h"
#include "models/machines/sgi_4d35/cycle.h"
#include "models/parts/r3000/r3000.h"
#include "tests/sgi_4d35/random_program.h"
#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {
namespace {

/// Goes on at marks, stops at anything else.
struct Marks : service_block::Services {
  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>&,
                                 base::ZeroedBytes&) override {
    return {0, false, number < DENDRO_MARK_START || number > DENDRO_MARK_LABEL};
  }
};

TEST(Sgi4d35WordClocks, AddUpToTheRunAndCountEveryCompletedWord) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Spec spec = random_spec(seed);
    const ProgramImage image = image_of(random_program(seed, 200, 3), kCode + 0x800);
    Marks services;
    std::map<std::uint32_t, WordClocks> words;
    RunOptions options;
    options.machine.word_clocks = &words;
    const ProgramResult result = run_cycle(spec, image, services, 20000, options);
    std::uint64_t clocks = 0, times = 0;
    for (const auto& [address, word] : words) clocks += word.clocks, times += word.times;
    EXPECT_EQ(static_cast<std::uint64_t>(result.cycles), clocks) << "seed " << seed;
    EXPECT_EQ(result.instructions, times) << "seed " << seed;
  }
}

TEST(Sgi4d35Marks, HaveTheClocksBeforeTheirStoreByBothRoutes) {
  const auto call = [](std::uint32_t number) { return or_immediate(kT1, 0, static_cast<int>(number)); };
  const ProgramImage image =
      image_of({{kCode,
                 {high(kT0, 0xBF00), or_immediate(kT2, 0, 7), store(kT2, kT0, DENDRO_SERVICE_ARGUMENT),
                  call(DENDRO_MARK_START), store(kT1, kT0), kNop, kNop, call(DENDRO_MARK_STOP), store(kT1, kT0),
                  store(kNop, kT0), kNop, kNop, kNop}}},
               kCode);
  for (const auto run : {run_cycle, run_clocked}) {
    Marks services;
    std::vector<Retired> retired;
    RunOptions options;
    options.retired = &retired;
    const ProgramResult result = run(small(), image, services, 1000, options);
    ASSERT_TRUE(result.stopped);
    ASSERT_EQ(2u, result.marks.size());
    EXPECT_EQ(unsigned{DENDRO_MARK_START}, result.marks[0].number);
    EXPECT_EQ(7u, result.marks[0].label);
    EXPECT_EQ(4u, result.marks[0].instructions);
    EXPECT_EQ(unsigned{DENDRO_MARK_STOP}, result.marks[1].number);
    EXPECT_EQ(8u, result.marks[1].instructions);
    for (const ProgramMark& mark : result.marks)
      EXPECT_EQ(static_cast<std::int64_t>(retired[mark.instructions].clock), mark.cycles);
  }
}

/// A call of 4003 puts a word over one that has run; any other call stops.
struct Overwrites : service_block::Services {
  static constexpr std::uint32_t kPlace = (kCode & 0x1FFFFFFF) + 0x1004;
  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>&, base::ZeroedBytes& memory) override {
    if (number != 4003) return {0, false, true};
    const std::uint32_t word = __builtin_bswap32(add_immediate(kT3, kT3, 16));
    std::memcpy(memory.data() + kPlace, &word, 4);
    service_block::CallResult result;
    result.changed = kPlace, result.changed_bytes = 4;
    return result;
  }
};

TEST(Sgi4d35Services, WordsThatACallWritesAreExecutedAtEveryLevel) {
  const std::uint32_t jump = r3000::r_word(r3000::kFnJalr, 31, kT2, 0);
  Words program{high(kT0, 0xBF00), add_immediate(kT3, 0, 0), high(kT2, 0x8001), or_immediate(kT2, kT2, 0x1000)};
  for (int pass = 0; pass < 3; ++pass) program.insert(program.end(), {jump, kNop});
  program.insert(program.end(), {or_immediate(kT1, 0, 4003), store(kT1, kT0), kNop, kNop, jump, kNop, store(0, kT0), kNop, kNop});
  const ProgramImage image =
      image_of({{kCode, program}, {kCode + 0x1000, {r3000::r_word(r3000::kFnJr, 0, 31, 0), add_immediate(kT3, kT3, 1)}}}, kCode);
  Overwrites services;
  RunOptions options;
  r3000::State state;
  options.final_state = &state;
  for (const auto run : {run_cycle, run_clocked}) {
    EXPECT_TRUE(run(small(), image, services, 1000, options).stopped);
    EXPECT_EQ(3u + 16u, state.r[kT3]);
  }
  Board board(small().main_bytes, image, services);
  r3000::Core<Board> core(small().processor, board);
  start(core.state(), image);
  core.run(1000);
  EXPECT_EQ(3u + 16u, core.state().r[kT3]);
}

TEST(Sgi4d35Clocked, OneProcessRunsOneProgramAfterTheOther) {
  const Spec spec = random_spec(1);
  const ProgramImage image = image_of(random_program(1, 200, 3), kCode + 0x800);
  Marks services;
  const ProgramResult first = run_clocked(spec, image, services, 20000, {}),
                      second = run_clocked(spec, image, services, 20000, {});
  EXPECT_GT(first.cycles, 0);
  EXPECT_EQ(first.cycles, second.cycles);
  EXPECT_EQ(first.instructions, second.instructions);
}

}  // namespace
}  // namespace dendro::sgi_4d35
