#include "tests/sgi_4d35/timing_rig.h"

/// Every count here is worked out by hand from the chapters Time of models/parts/r3000, r3010, r3000_cache
/// and r3000_bus: 10 clocks to the first word of a read, 1 for each, 6 for a write and 3 in the page of the
/// operation before it.
namespace dendro::sgi_4d35 {
namespace {

TEST_P(Sgi4d35Timing, ARunTakesItsWordsThreeClocksAndItsMisses) {
  // The first word is there in clock 11, the third is fetched in 13 and in MEM in 16.
  const Ran ran = from_reset({kNop, kNop, add_immediate(kT0, 0, 5)}, 3);
  EXPECT_EQ(17u, ran.cycles);
  EXPECT_FALSE(ran.stopped);
  EXPECT_EQ(5u, ran.state.r[kT0]);
  EXPECT_EQ(kCode + 12, ran.state.pc);
  expect_counters(ran, {{"processor.busy", 3},
                        {"processor.nops", 2},
                        {"processor.stall_exception", 3},
                        {"processor.stall_instruction_miss", 11},
                        {"instruction_cache.busy", 5},
                        {"instruction_cache.misses", 1},
                        {"memory.reads", 1},
                        {"memory.read_words", 8},
                        {"memory.busy", 17},
                        {"memory.idle", 0}});
  ASSERT_EQ(3u, ran.retired.size());
  EXPECT_EQ(14u, ran.retired[0].clock);
  EXPECT_EQ(kCode + 8, ran.retired[2].pc);
}

TEST_P(Sgi4d35Timing, ARunOfNoWordsTakesNoClock) { EXPECT_EQ(0u, from_reset({kNop}, 0).cycles); }

TEST_P(Sgi4d35Timing, LoadsAndTakenBranchesCostNothing) {
  EXPECT_EQ((Clocks{0, 1, 2, -1, 3}), clocks({load(kT2, kData), branch_always(2),
                                              r3000::r_word(r3000::kFnAddu, kT3, kT2, kT2), kNop, kNop}));
}

TEST_P(Sgi4d35Timing, ResultsOfTheMultiplierAreWaitedFor) {
  EXPECT_EQ((Clocks{0, 1, 12, 13}), issues({multiply(), kNop, from_lo(kT2), kNop}));
  EXPECT_EQ((Clocks{0, 35}), issues({divide(), from_hi(kT2)}));
  EXPECT_EQ((Clocks{0, 12, 47}), issues({multiply(), divide(), multiply()}));
  EXPECT_EQ((Clocks{0, 12, 13}),
            issues({multiply(), r3000::r_word(r3000::kFnMthi, 0, kT0, 0), from_hi(kT2)}));
  Words eleven = {multiply()};
  eleven.insert(eleven.end(), 11, kNop);
  eleven.push_back(from_lo(kT2));
  EXPECT_EQ(12, issues(eleven).back());
  eleven.erase(eleven.begin() + 1);
  EXPECT_EQ(12, issues(eleven).back());
}

TEST_P(Sgi4d35Timing, AWordThatReadsHiIntoNothingWaitsToo) {
  EXPECT_EQ((Clocks{0, 12}), issues({multiply(), from_hi(0)}));
}

TEST_P(Sgi4d35Timing, TheMultiplierRunsOnInStallClocks) {
  // The load takes clocks 1 to 15, so that the product is there.
  EXPECT_EQ((Clocks{0, 15, 16}), clocks({multiply(), load(kT2, kCold), from_lo(kT2)}));
}

TEST_P(Sgi4d35Timing, AMissCostsTheFirstWordAndTheBlock) {
  EXPECT_EQ((Clocks{0, 15, 16, 17}), clocks({kNop, load(kT2, kCold), load(kT2, kCold, 12), kNop}));
  EXPECT_EQ((Clocks{0, 15, 30}), clocks({kNop, load(kT2, kCold), load(kT2, kCold, 16)}));
  EXPECT_EQ(4u, counter("data_cache.busy"));
  EXPECT_EQ(4u, counter("data_cache.misses"));
  Spec spec = small();
  spec.bus.first_word_cycles = 6;
  spec.bus.word_cycles = 2;
  spec.data_cache.refill_words = 8;
  EXPECT_EQ((Clocks{0, 23, 24}), clocks({kNop, load(kT2, kCold), kNop}, spec));
}

TEST_P(Sgi4d35Timing, WithoutStreamingAFetchWaitsForItsBlock) {
  Spec spec = small();
  spec.instruction_cache.streaming = false;
  // Block 0 is there in clock 18, block 1 (asked for in 26) in 44; the eighth word is in MEM in 46.
  const Ran ran = from_reset(Words(16, kNop), 8, spec);
  EXPECT_EQ(47u, ran.cycles);
  EXPECT_EQ(36u, ran.counters.at("processor.stall_instruction_miss"));
}

TEST_P(Sgi4d35Timing, AStreamedBlockRunsOneWordAClock) {
  // Words 0 to 7 in clocks 11 to 18; the next block is asked for in 19, its first word is there in 30.
  const Ran ran = from_reset(Words(16, kNop), 8);
  EXPECT_EQ(33u, ran.cycles);
  EXPECT_EQ(22u, ran.counters.at("processor.stall_instruction_miss"));
  Spec spec = small();
  spec.bus.word_cycles = 2;  // words in clocks 12, 14, 16, 18, 20; the third is in MEM in 21
  EXPECT_EQ(22u, from_reset(Words(16, kNop), 3, spec).cycles);
}

TEST_P(Sgi4d35Timing, ATakenBranchOutOfTheStreamedWordsWaits) {
  const auto run = [this](int words) {
    Words code(64, kNop);
    code[8] = branch_always(words);
    return from_reset(code, 3, small(), kCode + 32);
  };
  // Forward to word 4, which comes in clock 15; its slot was fetched in 12.
  EXPECT_EQ(19u, run(3).cycles);
  // To word 7: clock 18, where the block ends; the next block is asked for in 19.
  EXPECT_EQ(33u, run(6).cycles);
  // Back to itself: its clock has passed, so it waits for the last word, in 18.
  EXPECT_EQ(22u, run(-1).cycles);
  // To a block that misses: it is asked for in 13, read from 18 on, there in 29.
  const Ran other = run(15);
  EXPECT_EQ(33u, other.cycles);
  expect_counters(other, {{"processor.stall_instruction_miss", 27},
                          {"instruction_cache.misses", 2},
                          {"instruction_cache.busy", 5},
                          {"memory.busy", 33}});
}

TEST_P(Sgi4d35Timing, ATakenBranchToACachedBlockWaitsForTheStream) {
  // Block 1, word 8: a branch back to word 0, in block 0. Block 0: clocks 11 to 18. Block 1 is asked for in
  // 19 and ends in 37; word 8 in 30, its slot in 31, word 0 in 37.
  Words code(16, kNop);
  code[8] = branch_always(-9);
  const Ran ran = from_reset(code, 11);
  EXPECT_EQ(41u, ran.cycles);
  EXPECT_EQ(11u + 11 + 5, ran.counters.at("processor.stall_instruction_miss"));
}

TEST_P(Sgi4d35Timing, AMissWaitsForTheStreamThatIsUnderWay) {
  // lui, lw in words 0 and 1: the load is in MEM in clock 15, memory free in 18, the block there in 32.
  const Ran ran = from_reset({high(kT0, 0x8002), load(kT1, kT0), kNop, kNop, kNop, kNop, kNop, kNop}, 2);
  EXPECT_EQ(33u, ran.cycles);
  EXPECT_EQ(17u, ran.counters.at("processor.stall_data_miss"));
  EXPECT_EQ(32u, ran.counters.at("memory.busy"));
}

TEST_P(Sgi4d35Timing, UncachedWordsAreReadOneByOne) {
  // Each fetch takes 11 clocks: words 0, 1, 2 in clocks 11, 23, 35.
  const Ran ran = from_reset(Words(8, kNop), 1, small(), 0xA0010000);
  EXPECT_EQ(37u, ran.cycles);
  expect_counters(ran, {{"processor.stall_instruction_miss", 33},
                        {"instruction_cache.busy", 0},
                        {"memory.reads", 3},
                        {"memory.read_words", 3}});
  EXPECT_EQ((Clocks{0, 12, 13}), clocks({kNop, load(kT2, kUncached), kNop}));
  EXPECT_EQ(0u, counter("data_cache.busy"));
}

TEST_P(Sgi4d35Timing, AnUncachedReadWaitsUntilTheBufferIsEmpty) {
  // Written from clock 1 to 6, read from 7 to 17.
  EXPECT_EQ((Clocks{0, 18}), clocks({store(kT0, kData), load(kT2, kUncached)}));
  // Two writes, of one page.
  EXPECT_EQ((Clocks{0, 1, 21}), clocks({store(kT0, kData), store(kT0, kData, 4), load(kT2, kUncached)}));
}

TEST_P(Sgi4d35Timing, AByteStoreTakesItsExtraClock) {
  EXPECT_EQ((Clocks{0, 2, 3}), clocks({kNop, store_byte(kT0, kData), kNop}));
  EXPECT_EQ((Clocks{0, 2, 3}), clocks({kNop, store_byte(kT0, kCold), kNop}));
  EXPECT_EQ(2u, counter("processor.stall_partial_store"));
  EXPECT_EQ((Clocks{0, 1, 2}), clocks({kNop, store_byte(kT0, kUncached), kNop}));
  Spec spec = small();
  spec.data_cache.partial_store_cycles = 2;
  EXPECT_EQ((Clocks{0, 3, 4}), clocks({kNop, store_byte(kT0, kData), kNop}, spec));
  const auto half = r3000::i_word(r3000::kMajorSh, kT0, kData, 2),
             left = r3000::i_word(r3000::kMajorSwl, kT0, kData, 0);
  EXPECT_EQ((Clocks{0, 3, 6}), clocks({kNop, half, left}, spec));
}

TEST_P(Sgi4d35Timing, AByteStoreThatDoesNotMergeInvalidatesItsWord) {
  Spec spec = small();
  spec.data_cache.store_partial = false;
  // The load misses; the byte in its block is written first, from clock 2 to 7, then the block read from 8
  // to 21.
  EXPECT_EQ((Clocks{0, 1, 22}), clocks({kNop, store_byte(kT0, kData), load(kT2, kData)}, spec));
  // The next word of the block stays valid.
  EXPECT_EQ((Clocks{0, 1, 2}),
            clocks({load(kT2, kData, 4), store_byte(kT0, kData), load(kT2, kData, 4)}, spec));
}

TEST_P(Sgi4d35Timing, AStoredWordIsCachedAndItsNeighboursAreNot) {
  EXPECT_EQ((Clocks{0, 1, 2}), clocks({kNop, store(kT0, kCold), load(kT2, kCold)}));
  EXPECT_EQ(0u, counter("processor.stall_data_miss"));
  // Its block is written from clock 1 to 6 before it is read.
  EXPECT_EQ((Clocks{0, 21}), clocks({store(kT0, kCold), load(kT2, kCold, 4)}));
}

TEST_P(Sgi4d35Timing, AFullWriteBufferHoldsAStoreUp) {
  // Written in clocks 1 to 6, 7 to 9, 10 to 12: an entry is free in 7, 10, 13.
  Words stores;
  for (int i = 0; i < 7; ++i) stores.push_back(store(kT0, kData, 4 * i));
  EXPECT_EQ((Clocks{0, 1, 2, 3, 7, 10, 13}), clocks(stores));
  EXPECT_EQ(14u, counter("memory.writes"));
  Spec spec = small();
  spec.bus.entries = 2;
  EXPECT_EQ((Clocks{0, 1, 7, 10, 13, 16, 19}), clocks(stores, spec));
}

TEST_P(Sgi4d35Timing, WritesInOnePageGoFaster) {
  Words stores;
  for (int i = 0; i < 7; ++i) stores.push_back(store(kT0, i % 2 ? kElsewhere : kData, 4 * i));
  EXPECT_EQ((Clocks{0, 1, 2, 3, 7, 13, 19}), clocks(stores));
  EXPECT_EQ(0u, counter("memory.page_writes"));
  Spec spec = small();
  spec.bus.write_cycles = 8, spec.bus.page_write_cycles = 2;
  stores.clear();
  for (int i = 0; i < 7; ++i) stores.push_back(store(kT0, kData, 1024 * i));  // two to a page of 2 KB
  EXPECT_EQ((Clocks{0, 1, 2, 3, 9, 11, 19}), clocks(stores, spec));
  // A read opens a page, too: it ends in clock 14, the write takes 17 and 18.
  const Words behind = {kNop, load(kT2, kCold), store(kT0, kCold, 4), load(kT2, kUncached)};
  EXPECT_EQ((Clocks{0, 15, 16, 30}), clocks(behind, spec));
}

TEST_P(Sgi4d35Timing, DevicesHaveNoPages) {
  Words stores;
  for (int i = 0; i < 6; ++i) stores.push_back(store(kT0, kService, 4));
  EXPECT_EQ((Clocks{0, 1, 2, 3, 7, 13}), clocks(stores));
}

TEST_P(Sgi4d35Timing, AReadOvertakesWritesToOtherBlocks) {
  // Found in clock 1, before the write can start.
  EXPECT_EQ((Clocks{0, 15}), clocks({store(kT0, kData), load(kT2, kCold)}));
  // A write is under way: read from 7 on, before the second write.
  EXPECT_EQ((Clocks{0, 1, 21}), clocks({store(kT0, kData), store(kT0, kData, 4), load(kT2, kCold)}));
  Spec spec = small();
  spec.bus.read_bypass = false;  // 6 + 3 clocks of writes
  EXPECT_EQ((Clocks{0, 1, 24}), clocks({store(kT0, kData), store(kT0, kData, 4), load(kT2, kCold)}, spec));
}

TEST_P(Sgi4d35Timing, AnOvertakingReadIsCounted) {
  // The store leaves MEM in clock 16, the load misses in 17, memory is free in 18: read from 18 to 31. In 32,
  // the last clock, the write begins.
  const Words code = {
      high(kT0, 0x8002), high(kT2, 0x8004), store(kT1, kT0), load(kT3, kT2), kNop, kNop, kNop, kNop};
  const Ran ran = from_reset(code, 4);
  EXPECT_EQ(33u, ran.cycles);
  expect_counters(ran,
                  {{"memory.overtaken", 1}, {"memory.writes", 1}, {"memory.busy", 33}, {"memory.reads", 2}});
  Spec spec = small();
  spec.bus.read_bypass = false;  // written from 18 to 23, read from 24 to 37
  const Ran after = from_reset(code, 4, spec);
  EXPECT_EQ(39u, after.cycles);
  expect_counters(after, {{"memory.overtaken", 0}, {"processor.stall_data_miss", 21}});
}

TEST_P(Sgi4d35Timing, AMissWaitsForTheWriteUnderWay) {
  EXPECT_EQ((Clocks{0, 1, 21}), clocks({store(kT0, kData), kNop, load(kT2, kCold)}));
}

TEST_P(Sgi4d35Timing, AReadDoesNotOvertakeAWriteToItsBlock) {
  // Writes in clocks 1 to 6 and 7 to 12, in two pages; then the read.
  EXPECT_EQ((Clocks{0, 1, 27}), clocks({store(kT0, kData), store(kT0, kCold, 8), load(kT2, kCold)}));
}

std::uint32_t fp(r3010::Format format, unsigned operation, unsigned fd, unsigned fs, unsigned ft = 0) {
  return r3010::fp_word(format, operation, fd, fs, ft);
}
constexpr auto kSingle = r3010::kSingle;
constexpr auto kDouble = r3010::kDouble;

TEST_P(Sgi4d35Timing, FloatingPointResultsAreWaitedFor) {
  struct Case {
    std::uint32_t word;
    unsigned result;
    std::int64_t clocks;
  };
  for (const Case& c :
       {Case{fp(kSingle, r3010::kAdd, 2, 4, 6), 2, 2}, Case{fp(kDouble, r3010::kSub, 2, 4, 6), 3, 2},
        Case{fp(kSingle, r3010::kMul, 2, 4, 6), 2, 4}, Case{fp(kDouble, r3010::kMul, 2, 4, 6), 3, 5},
        Case{fp(kSingle, r3010::kDiv, 2, 4, 6), 2, 12}, Case{fp(kDouble, r3010::kDiv, 2, 4, 6), 2, 19},
        Case{fp(kSingle, r3010::kMov, 2, 4), 2, 1}, Case{fp(r3010::kWord, r3010::kCvtD, 2, 4), 3, 3},
        Case{fp(kSingle, r3010::kCvtW, 2, 4), 2, 2}, Case{fp(kDouble, r3010::kCvtS, 2, 4), 2, 2},
        Case{fp(kSingle, r3010::kCvtD, 2, 4), 3, 1}}) {
    EXPECT_EQ((Clocks{0, c.clocks}), issues({c.word, r3000::cop_word(1, r3000::kMfc, kT2, c.result)}))
        << std::hex << c.word;
    const auto other = r3000::cop_word(1, r3000::kMfc, kT2, 8);
    EXPECT_EQ((Clocks{0, 1}), issues({c.word, other})) << std::hex << c.word;
  }
}

TEST_P(Sgi4d35Timing, RegistersUnderWayHoldLoadsStoresAndMovesUp) {
  const std::uint32_t product = fp(kDouble, r3010::kMul, 2, 4, 6);
  for (const std::uint32_t word :
       {r3000::i_word(r3000::kMajorLwc1, 3, kData, 0), r3000::i_word(r3000::kMajorSwc1, 3, kData, 0),
        r3000::cop_word(1, r3000::kMtc, kT0, 2), r3000::cop_word(1, r3000::kCfc, kT2, 31),
        r3000::cop_word(1, r3000::kCtc, 0, 31)})
    EXPECT_EQ((Clocks{0, 5, 6}), issues({product, word, kNop})) << std::hex << word;
  EXPECT_EQ((Clocks{0, 1, 2}), issues({product, r3000::i_word(r3000::kMajorLwc1, 1, kData, 0), kNop}));
}

TEST_P(Sgi4d35Timing, ALoadedOperandIsThereForTheNextWord) {
  EXPECT_EQ((Clocks{0, 1, 2, 4}),
            issues({r3000::i_word(r3000::kMajorLwc1, 4, kData, 0), r3000::cop_word(1, r3000::kMtc, kT0, 6),
                    fp(kSingle, r3010::kAdd, 2, 4, 6), fp(kSingle, r3010::kAdd, 8, 2, 6)}));
}

TEST_P(Sgi4d35Timing, UnitsOverlapAndAreNotPipelined) {
  // Divider, multiplier and adder at once; the second product waits for its unit.
  EXPECT_EQ((Clocks{0, 1, 2, 5, 6}),
            issues({fp(kSingle, r3010::kDiv, 2, 4, 6), fp(kSingle, r3010::kMul, 8, 4, 6),
                    fp(kSingle, r3010::kAdd, 10, 4, 6), fp(kSingle, r3010::kMul, 12, 4, 6), kNop}));
  EXPECT_EQ((Clocks{0, 2, 4}), issues({fp(kSingle, r3010::kAdd, 2, 4, 6), fp(kSingle, r3010::kAdd, 8, 4, 6),
                                       fp(kSingle, r3010::kAdd, 10, 4, 6)}));
  EXPECT_EQ((Clocks{0, 12}), issues({fp(kSingle, r3010::kDiv, 2, 4, 6), fp(kSingle, r3010::kDiv, 8, 4, 6)}));
}

TEST_P(Sgi4d35Timing, TheLastClockOfAMultiplyKeepsTheAdder) {
  const std::uint32_t product = fp(kSingle, r3010::kMul, 2, 4, 6), sum = fp(kSingle, r3010::kAdd, 8, 4, 6),
                      other = fp(kSingle, r3010::kAdd, 10, 4, 6);
  Spec spec = small();
  // The product has the adder in clock 3: a sum fits into 1 and 2, the next must wait for 4.
  EXPECT_EQ((Clocks{0, 1, 4}), issues({product, sum, other}, spec));
  EXPECT_EQ((Clocks{0, 1, 4}), issues({product, kNop, sum}, spec));
  EXPECT_EQ((Clocks{0, 1, 2, 3, 4}), issues({product, kNop, kNop, kNop, sum}, spec));
  EXPECT_EQ((Clocks{0, 1, 2, 3}), issues({product, kNop, fp(kSingle, r3010::kMov, 8, 4), kNop}, spec));
  spec.fpu.rounding = 0;
  EXPECT_EQ((Clocks{0, 1, 3}), issues({product, sum, other}, spec));
  EXPECT_EQ((Clocks{0, 1, 2}), issues({product, kNop, sum}, spec));
}

TEST_P(Sgi4d35Timing, AProductAndAQuotientDoNotRoundInOneClock) {
  // The quotient rounds in clock 11, where a product that issues in 8 would.
  Words words = {fp(kSingle, r3010::kDiv, 2, 4, 6)};
  words.insert(words.end(), 7, kNop);
  words.push_back(fp(kSingle, r3010::kMul, 8, 4, 6));
  EXPECT_EQ(9, issues(words).back());
  words.erase(words.begin() + 1);
  EXPECT_EQ(7, issues(words).back());
}

TEST_P(Sgi4d35Timing, ABranchWaitsForItsComparison) {
  const std::uint32_t less = fp(kSingle, r3010::kCompare + 12, 0, 4, 6),
                      branch = r3000::kCop1 << 26 | r3000::kBc << 21 | 1u << 16 | 1;
  EXPECT_EQ((Clocks{0, 2, 3}), issues({less, branch, kNop}));
  EXPECT_EQ((Clocks{0, 1, 2}), issues({less, kNop, branch}));
  EXPECT_EQ((Clocks{0, 1, 2}), issues({fp(kSingle, r3010::kDiv, 2, 4, 6), branch, kNop}));
}

TEST_P(Sgi4d35Timing, AnAdderSlotCanBeLostDuringAMiss) {
  // Word 5 (the quotient) issues in clock 18, word 6 (a sum) could in 19; but word 8, in a new block, comes
  // in 30 only. In 30 the quotient of 13 clocks has the adder, so the sum waits in 29 and 30, and the fetch
  // misses its clock: it waits for 37.
  Spec spec = small();
  spec.fpu.divide_single = 13;
  Words code = {high(kT0, 0x2000),
                to_cp0(kT0, r3000::kStatus),
                kNop,
                kNop,
                kNop,
                fp(kSingle, r3010::kDiv, 2, 4, 6),
                fp(kSingle, r3010::kAdd, 8, 4, 6),
                kNop};
  const Ran late = from_reset(code, 7, spec);
  EXPECT_EQ(39u, late.cycles);
  expect_counters(late, {{"processor.stall_fp", 2}, {"processor.stall_instruction_miss", 27}});
  // With 12 clocks the adder is free again in 30.
  const Ran early = from_reset(code, 7);
  EXPECT_EQ(32u, early.cycles);
  expect_counters(early, {{"processor.stall_fp", 2}, {"processor.stall_instruction_miss", 20}});
}

TEST_P(Sgi4d35Timing, AFetchIsNotLookedAtWhileAluWaits) {
  // Word 5 (mult) leaves ALU in clock 18, word 6 (mflo) in 30 at the earliest; only then is word 8's block
  // asked for, which is there in 41.
  const Ran product = from_reset({kNop, kNop, kNop, kNop, kNop, multiply(), from_lo(kT2), kNop}, 7);
  EXPECT_EQ(43u, product.cycles);
  expect_counters(product,
                  {{"processor.stall_multiply_divide", 11}, {"processor.stall_instruction_miss", 22}});
  // A quotient in 18, a word that reads it in 30.
  const Ran quotient = from_reset({high(kT0, 0x2000), to_cp0(kT0, r3000::kStatus), kNop, kNop, kNop,
                                   fp(kSingle, r3010::kDiv, 2, 4, 6), fp(kSingle, r3010::kMov, 8, 2), kNop},
                                  7);
  EXPECT_EQ(43u, quotient.cycles);
  expect_counters(quotient, {{"processor.stall_fp", 11}, {"processor.stall_instruction_miss", 22}});
}

TEST_P(Sgi4d35Timing, AnOperationIssuesWhenTheStoreBeforeItLeavesMem) {
  const std::uint32_t sum = fp(kSingle, r3010::kAdd, 8, 4, 6),
                      equal = fp(kSingle, r3010::kCompare + 2, 0, 4, 6);
  // The sum issues in the clock in which the store leaves MEM; it and the comparison take the adder for 2
  // clocks each.
  EXPECT_EQ((Clocks{0, 2, 4, 5}), clocks({store_byte(kT0, kData), sum, equal, sum}));
  Spec spec = small();
  spec.bus.entries = 1;
  EXPECT_EQ((Clocks{0, 7, 9, 11, 12}),
            clocks({store(kT0, kData), store(kT0, kData, 4), sum, equal, sum}, spec));
}

TEST_P(Sgi4d35Timing, ALimitedRunStopsInMem) {
  // The second store finds no entry before clock 16 + 7.
  Spec spec = small();
  spec.bus.entries = 1;
  const Ran ran = from_reset(
      {high(kT0, 0x8002), store(kT1, kT0), store(kT1, kT0, 4), kNop, kNop, kNop, kNop, kNop}, 3, spec);
  // The first store leaves MEM in clock 15; memory is free in 18, the write takes 18 to 23.
  EXPECT_EQ(25u, ran.cycles);
  expect_counters(ran, {{"processor.stall_write_buffer", 8}, {"memory.writes", 1}, {"memory.busy", 24}});
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Levels, Sgi4d35Timing, ::testing::Values(Level::kCycle, Level::kClocked),
                         [](const auto& level) { return level_name(level.param); });

}  // namespace dendro::sgi_4d35
