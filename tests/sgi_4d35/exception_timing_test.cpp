#include "tests/sgi_4d35/timing_rig.h"

/// Exceptions, interrupts, the TLB and isolated caches, in clocks worked out by hand from
/// models/parts/r3000/README.md.
namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint32_t kJumpBack = r3000::r_word(r3000::kFnJr, 0, kK0, 0),
                        kRfe = r3000::cp0_word(r3000::kFnRfe);

/// To the word behind the one that faulted.
const Words kSkip = {from_cp0(kK0, r3000::kEpc), kNop, add_immediate(kK0, kK0, 4), kJumpBack, kRfe};

TEST_P(Sgi4d35Timing, AnExceptionCostsItsPositions) {
  for (const unsigned positions : {2u, 3u, 4u, 7u}) {
    timed_ = {};
    timed_.spec.pipeline.exception_cycles = positions;
    timed_.handler = kSkip;
    const std::int64_t first = 2 + positions;
    EXPECT_EQ((Clocks{0, 1, first + 5, first + 6}), clocks({kNop, syscall(), kNop, kNop})) << positions;
    EXPECT_EQ(first, handler());
    EXPECT_EQ(2u, counter("processor.exceptions"));
    // The first three clocks, two killed words and the positions behind them.
    EXPECT_EQ(3u + 2 * (1 + positions), counter("processor.stall_exception"));
  }
}

TEST_P(Sgi4d35Timing, TheTwoWordsBehindAFaultAreFetched) {
  // The syscall is fetched in clock 18, the next block asked for in 19 and there in 30; the syscall is killed
  // in 32; the handler is asked for in 33, read from 37 on, there in 48.
  Words code(7, kNop);
  code.push_back(syscall());
  const Ran ran = run_words(GetParam(), small(), {{kCode, code}, {r3000::kGeneralVector, {kNop}}}, kCode, 9);
  EXPECT_EQ(52u, ran.cycles);
  EXPECT_EQ(37u, ran.counters.at("processor.stall_instruction_miss"));
  EXPECT_EQ(7u, ran.counters.at("processor.stall_exception"));
  EXPECT_EQ(8u, ran.counters.at("processor.busy"));
  EXPECT_EQ(13u, ran.counters.at("instruction_cache.busy"));
  EXPECT_EQ(3u, ran.counters.at("instruction_cache.misses"));
  EXPECT_EQ(32u, ran.retired[7].clock);
  EXPECT_TRUE(ran.retired[7].killed);
}

TEST_P(Sgi4d35Timing, TheTwoWordsBehindAFaultAreReadWhereTheyAreNotCached) {
  const Ran ran = run_words(GetParam(), small(), {{kCode, {syscall()}}}, 0xA0010000, 1);
  EXPECT_EQ(37u, ran.cycles);
  EXPECT_EQ(3u, ran.counters.at("memory.reads"));
  EXPECT_EQ(r3000::kGeneralVector, ran.state.pc);
}

TEST_P(Sgi4d35Timing, AFetchThatCannotBeTranslatedLooksUpNothing) {
  // lui, jr and its slot in clocks 11 to 13, the target in 14; it is in MEM in 17.
  const Words code = {high(kT0, 0x0020), r3000::r_word(r3000::kFnJr, 0, kT0, 0), kNop};
  const Ran ran = run_words(GetParam(), small(), {{kCode, code}}, kCode, 4);
  EXPECT_EQ(18u, ran.cycles);
  EXPECT_EQ(3u, ran.counters.at("instruction_cache.busy"));
  EXPECT_EQ(11u, ran.counters.at("processor.stall_instruction_miss"));
  EXPECT_EQ(1u, ran.counters.at("processor.tlb_refills"));
  EXPECT_EQ(0x00200000u, ran.state.epc);
  EXPECT_EQ(r3000::kUtlbVector, ran.state.pc);
}

TEST_P(Sgi4d35Timing, ABusErrorOfALoadTakesItsRead) {
  timed_.handler = kSkip;
  EXPECT_EQ((Clocks{0, 12, 21}), clocks({kNop, load(kT2, kNothing), kNop}));
  EXPECT_EQ(16, handler());
  EXPECT_EQ(unsigned{r3000::kDbe}, code());
}

TEST_P(Sgi4d35Timing, ABusErrorOfAStoreComesAtOnce) {
  timed_.handler = kSkip;
  EXPECT_EQ((Clocks{0, 1, 10}), clocks({kNop, store(kT2, kNothing), kNop}));
  EXPECT_EQ(unsigned{r3000::kDbe}, code());
  EXPECT_EQ(0u, counter("memory.writes"));
}

TEST_P(Sgi4d35Timing, AFaultingAccessTouchesNoCache) {
  timed_.handler = kSkip;
  EXPECT_EQ((Clocks{0, 1, 10}), clocks({kNop, load(kT2, kCold, 1), kNop}));
  EXPECT_EQ(0u, counter("data_cache.busy"));
}

TEST_P(Sgi4d35Timing, AFaultingLoadWaitsForItsRegister) {
  timed_.handler = kSkip;
  const auto product = r3010::fp_word(r3010::kDouble, r3010::kMul, 2, 4, 6);
  EXPECT_EQ((Clocks{0, 5, 6}), clocks({kNop, product, r3000::i_word(r3000::kMajorLwc1, 3, kData, 1)}));
  EXPECT_EQ(10, handler());
}

TEST_P(Sgi4d35Timing, ACoprocessorWordWithoutPermissionWaitsForNothing) {
  timed_.handler = kSkip;
  timed_.handler.insert(timed_.handler.begin(), to_cp0(kT0, r3000::kStatus));
  const auto product = r3010::fp_word(r3010::kDouble, r3010::kMul, 2, 4, 6);
  EXPECT_EQ((Clocks{0, 1, 2}),
            clocks({product, to_cp0(0, r3000::kStatus), r3000::cop_word(1, r3000::kMfc, kT2, 3)}));
  EXPECT_EQ(6, handler());
  EXPECT_EQ(unsigned{r3000::kCpu}, code());
}

TEST_P(Sgi4d35Timing, AnArithmeticWordThatInterruptsTakesNoUnit) {
  // Division by zero enabled; the handler's first word would wait for the divider until clock 13.
  timed_.setup = {high(kT0, 0x2000), or_immediate(kT0, kT0, 0x2001), to_cp0(kT0, r3000::kStatus),
                  r3000::cop_word(1, r3000::kMtc, kT0, 4), or_immediate(kS4, 0, 8u << r3010::kEnableShift)};
  timed_.handler = {r3000::cop_word(1, r3000::kCfc, kK1, 31),
                    from_cp0(kK0, r3000::kEpc),
                    r3000::cop_word(1, r3000::kCtc, 0, 31),
                    add_immediate(kK0, kK0, 4),
                    kJumpBack,
                    kRfe};
  const auto quotient = r3010::fp_word(r3010::kSingle, r3010::kDiv, 2, 4, 6);
  EXPECT_EQ((Clocks{0, 1, 2, 12}), clocks({r3000::cop_word(1, r3000::kCtc, kS4, 31), kNop, quotient, kNop}));
  EXPECT_EQ(6, handler());
  EXPECT_EQ(2u, counter("processor.exceptions"));
}

TEST_P(Sgi4d35Timing, AnArithmeticWordWhoseExceptionIsMaskedTakesItsUnit) {
  // The quotient by zero issues in 1; its register and its unit are busy until 13.
  timed_.setup = {high(kT0, 0x2000), to_cp0(kT0, r3000::kStatus), r3000::cop_word(1, r3000::kMtc, kT0, 4),
                  or_immediate(kS4, 0, 8u << r3010::kEnableShift)};
  const auto quotient = r3010::fp_word(r3010::kSingle, r3010::kDiv, 2, 4, 6);
  for (const auto word : {r3000::cop_word(1, r3000::kMfc, kT2, 2), r3000::cop_word(1, r3000::kCfc, kT2, 31)})
    EXPECT_EQ((Clocks{0, 1, 13, 14}),
              clocks({r3000::cop_word(1, r3000::kCtc, kS4, 31), kNop, quotient, word}));
  EXPECT_EQ(0u, counter("processor.exceptions"));
}

TEST_P(Sgi4d35Timing, AnInterruptedWordWaitsForNothingAndComesBack) {
  timed_.setup = {add_immediate(kS4, 0, 0x100), or_immediate(kS5, kT0, 0x101)};
  timed_.handler = {to_cp0(0, r3000::kCause), from_cp0(kK0, r3000::kEpc), kNop, kJumpBack, kRfe};
  // The remainder is there 35 clocks behind clock 0, in which div left ALU; mfhi is killed in 3 and leaves
  // MEM in 36.
  EXPECT_EQ((Clocks{0, 1, 2, 3, 37}),
            clocks({to_cp0(kS4, r3000::kCause), divide(), to_cp0(kS5, r3000::kStatus), from_hi(kT2),
                    to_cp0(kT0, r3000::kStatus)}));
  EXPECT_EQ(7, handler());
  EXPECT_EQ(36, timed_.ran.clock_of(timed_.body + 12, 3) - timed_.ran.clock_of(timed_.body, 1));
}

TEST_P(Sgi4d35Timing, TheRefillsPriceIsCounted) {
  timed_.setup = {high(kS4, 0x0005), or_immediate(kS4, kS4, 0x700)};
  timed_.refill = {to_cp0(kS4, r3000::kEntryLo),
                   r3000::cp0_word(r3000::kFnTlbwr),
                   from_cp0(kK0, r3000::kEpc),
                   kNop,
                   kJumpBack,
                   kRfe};
  EXPECT_EQ((Clocks{0, 1, 12}), clocks({kNop, load(kT2, kMapped), kNop}));
  EXPECT_EQ(5, timed_.clock_at(r3000::kUtlbVector));
  const Ran& ran = timed_.ran;
  const std::uint32_t rfe = r3000::kUtlbVector + 20, word = timed_.body + 4;
  EXPECT_EQ(10, ran.clock_of(rfe, 1) - ran.clock_of(word, 2) + 1);
  const std::int64_t cold = ran.clock_of(rfe, 0) - ran.clock_of(word, 0) + 1;
  EXPECT_EQ(static_cast<std::uint64_t>(cold) + 10, counter("processor.tlb_refill_cycles"));
  EXPECT_EQ(2u, counter("processor.tlb_refills"));
}

TEST_P(Sgi4d35Timing, AnIsolatedCacheChangesItsTagsAlone) {
  timed_.setup = {high(kS4, 0x2001)};
  // A stored word is valid, a stored byte is not; the last load reads its block in clocks 7 to 20.
  EXPECT_EQ(
      (Clocks{0, 1, 2, 3, 4, 5, 6, 21}),
      clocks({to_cp0(kS4, r3000::kStatus), store(kT0, kCold), store(kT0, kCold, 4), store_byte(kT0, kCold, 4),
              load(kT2, kCold, 8), to_cp0(kT0, r3000::kStatus), load(kT2, kCold), load(kT2, kCold, 4)}));
  EXPECT_EQ(12u, counter("data_cache.busy"));
  EXPECT_EQ(2u, counter("data_cache.misses"));
  EXPECT_EQ(0u, counter("memory.writes"));
}

}  // namespace
}  // namespace dendro::sgi_4d35
