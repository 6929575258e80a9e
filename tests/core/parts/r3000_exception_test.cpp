#include "tests/core/parts/r3000_rig.h"

namespace dendro::r3000 {
namespace {

constexpr std::uint32_t kNopWord = 0;

std::uint32_t mfc0(unsigned rt, unsigned reg) { return cop_word(0, kMfc, rt, reg); }
std::uint32_t mtc0(unsigned rt, unsigned reg) { return cop_word(0, kMtc, rt, reg); }

TEST(R3000Exception, EpcIsTheWordAndBdTellsTheBranchBeforeIt) {
  for (const bool in_slot : {false, true}) {
    Rig rig({in_slot ? i_word(kMajorBne, 0, 0, 5) : kNopWord,
             r_word(kFnSyscall, 0, 0, 0)});  // also a branch not taken
    rig.run(2);
    EXPECT_EQ(unsigned{kSys}, rig.code());
    EXPECT_EQ(in_slot ? kCode : kCode + 4, rig.state().epc);
    EXPECT_EQ(in_slot, (rig.state().cause & kCauseBd) != 0);
    EXPECT_EQ(kHandler, rig.state().pc);
  }
}

TEST(R3000Exception, TheSlotIsRememberedWhenARunPausesBeforeIt) {
  Rig rig({i_word(kMajorBeq, 0, 0, 5), r_word(kFnBreak, 0, 0, 0)});
  rig.run(1).run(1);
  EXPECT_EQ(unsigned{kBp}, rig.code());
  EXPECT_EQ(kCode, rig.state().epc);
}

TEST(R3000Exception, ABranchToItsOwnSlotLeavesTheSecondVisitOutsideASlot) {
  Rig rig({i_word(kMajorBeq, 0, 0, 0), kNopWord});
  rig.run(2);
  EXPECT_EQ(kCode + 4, rig.state().pc);
  EXPECT_FALSE(rig.state().in_slot);
}

TEST(R3000Exception, PushesTheModeStackAndRfePopsIt) {
  Rig rig({r_word(kFnSyscall, 0, 0, 0)});
  rig.put(kHandler, {cp0_word(kFnRfe)});
  rig.state().status = kStatusCu1 | 0x15 | kStatusIm;
  rig.run(1);
  EXPECT_EQ(0x14u, rig.state().status & 0x3F);
  rig.run(1);
  EXPECT_EQ(0x15u, rig.state().status & 0x3F);
}

TEST(R3000Exception, TheBootBitMovesTheVector) {
  Rig rig({r_word(kFnSyscall, 0, 0, 0)});
  rig.state().status |= kStatusBev;
  rig.run(1);
  EXPECT_EQ(kBootGeneralVector, rig.state().pc);
}

TEST(R3000Exception, ReservedAndUnusableWordsSayWhich) {
  struct Case {
    std::uint32_t word, status;
    unsigned code, coprocessor;
  };
  const Case cases[] = {{0x7000003F, 0, kRi, 0},
                        {20u << 26, 0, kRi, 0},  // beql of MIPS II
                        {r_word(52, 0, 0, 0), 0, kRi, 0},
                        {cop_word(2, kMfc, 8, 0), kStatusCu1, kCpu, 2},
                        {cop_word(3, kMfc, 8, 0), kStatusCu1, kCpu, 3},
                        {cop_word(1, kMfc, 8, 0), 0, kCpu, 1},
                        {i_word(kMajorLwc1, 8, 0, 0), 0, kCpu, 1},
                        {i_word(kMajorSwc1 + 1, 8, 0, 0), 0, kCpu, 2}};
  for (const Case& c : cases) {
    Rig rig({c.word});
    rig.state().status = c.status;
    rig.run(1);
    EXPECT_EQ(c.code, rig.code()) << std::hex << c.word;
    EXPECT_EQ(c.coprocessor, rig.state().cause >> 28 & 3) << std::hex << c.word;
  }
}

TEST(R3000Exception, UnalignedAccessesNameTheirAddress) {
  struct Case {
    std::uint32_t major;
    int at;
    unsigned code;
  };
  for (const Case& c : {Case{kMajorLw, 2, kAdel},
                        {kMajorLh, 1, kAdel},
                        {kMajorLhu, 3, kAdel},
                        {kMajorSw, 1, kAdes},
                        {kMajorSh, 1, kAdes},
                        {kMajorLwc1, 2, kAdel},
                        {kMajorSwc1, 2, kAdes}}) {
    Rig rig({i_word(c.major, kT0, kT4, c.at)});
    rig.r(kT4) = kData;
    rig.run(1);
    EXPECT_EQ(c.code, rig.code()) << c.major;
    EXPECT_EQ(kData + static_cast<unsigned>(c.at), rig.state().bad_vaddr);
  }
}

TEST(R3000Exception, NothingThereIsABusError) {
  Rig data({i_word(kMajorLw, kT0, kT4, 0)});
  data.r(kT4) = 0xA0000000 + (1 << 20);
  data.run(1);
  EXPECT_EQ(unsigned{kDbe}, data.code());
  Rig code;
  code.jump(0x80000000 + (1 << 20));
  code.run(1);
  EXPECT_EQ(unsigned{kIbe}, code.code());
  EXPECT_EQ(0x80000000u + (1 << 20), code.state().epc);
}

TEST(R3000Exception, DevicesAreReadAndWrittenThroughThePort) {
  Rig rig({i_word(kMajorSw, kT0, kT4, 0), i_word(kMajorLw, kT1, kT4, 0), kNopWord});
  rig.r(kT4) = 0xB0000000;
  rig.r(kT0) = 42;
  rig.run(3);
  EXPECT_EQ(42u, rig.port.device);
  EXPECT_EQ(42u, rig.r(kT1));
}

TEST(R3000User, HasNoKernelAddressesAndNoCoprocessorZero) {
  for (const std::uint32_t word :
       {i_word(kMajorLw, kT0, kT4, 0), mfc0(kT0, kStatus), mtc0(kT0, kStatus), cp0_word(kFnRfe)}) {
    Rig rig;
    rig.put(0x80030000, {word});
    rig.state().tlb[5] = {0x00400000, 0x30000 | kLoValid};
    rig.state().status = kStatusKuc;
    rig.r(kT4) = kData;
    rig.jump(0x00400000);
    rig.run(1);
    EXPECT_EQ(word == i_word(kMajorLw, kT0, kT4, 0) ? unsigned{kAdel} : unsigned{kCpu}, rig.code())
        << std::hex << word;
    EXPECT_EQ(0x00400000u, rig.state().epc);
  }
}

TEST(R3000User, WhatTheKernelTouchedStaysClosed) {
  Rig rig({i_word(kMajorLw, kT0, kT4, 0), mtc0(kT3, kStatus)});
  rig.put(0x80030000, {i_word(kMajorLw, kT0, kT4, 0)});
  rig.state().tlb[5] = {0x00400000, 0x30000 | kLoValid};
  rig.r(kT4) = kData;
  rig.run(1);
  EXPECT_EQ(0u, rig.state().exceptions);
  rig.state().status = kStatusKuc;
  rig.jump(0x00400000);
  rig.run(1);
  EXPECT_EQ(unsigned{kAdel}, rig.code());
}

TEST(R3000Tlb, AMissRefillsThroughItsOwnVectorWithContextAndEntryHiReady) {
  Rig rig({i_word(kMajorLw, kT0, kT4, 4)});
  rig.r(kT4) = 0x12345678;
  rig.state().context = 0xABE00000;
  rig.state().entry_hi = 0x7C0;
  rig.run(1);
  EXPECT_EQ(kUtlbVector, rig.state().pc);
  EXPECT_EQ(unsigned{kTlbl}, rig.code());
  EXPECT_EQ(0x1234567Cu, rig.state().bad_vaddr);
  EXPECT_EQ(0xABE00000u | 0x12345u << 2, rig.state().context);
  EXPECT_EQ(0x12345000u | 0x7C0, rig.state().entry_hi);
  EXPECT_EQ(1u, rig.state().tlb_refills);
}

TEST(R3000Tlb, KernelSegmentMissesInvalidAndCleanPagesUseTheGeneralVector) {
  struct Case {
    std::uint32_t address, lo, word;
    unsigned code;
  };
  const std::uint32_t load = i_word(kMajorLw, kT0, kT4, 0), store = i_word(kMajorSw, kT0, kT4, 0);
  const Case cases[] = {{0xC0001000, 0, load, kTlbl},
                        {0x1000, kLoGlobal, load, kTlbl},
                        {0x1000, kLoGlobal, store, kTlbs},
                        {0x1000, kLoGlobal | kLoValid, store, kMod}};
  for (const Case& c : cases) {
    Rig rig({c.word});
    rig.state().tlb[9] = {0x1000, 0x20000 | c.lo};
    rig.r(kT4) = c.address;
    rig.run(1);
    EXPECT_EQ(kHandler, rig.state().pc);
    EXPECT_EQ(c.code, rig.code());
  }
}

TEST(R3000Tlb, AddressSpacesDifferUnlessThePageIsGlobal) {
  for (const bool global : {false, true}) {
    Rig rig({i_word(kMajorLw, kT0, kT4, 0), kNopWord});
    rig.state().tlb[9] = {0x1040, 0x20000 | kLoValid | (global ? kLoGlobal : 0)};
    rig.poke(kData, 77);
    rig.r(kT4) = 0x1000;
    rig.run(1);
    EXPECT_EQ(global ? 0u : 1u, rig.state().exceptions);
    rig.jump(kCode);
    rig.state().entry_hi = 0x40;
    rig.core.forget();
    rig.run(2);
    EXPECT_EQ(77u, rig.r(kT0));
  }
}

TEST(R3000Tlb, WritesReadsAndProbesGoThroughIndexAndRandom) {
  Rig rig({mtc0(kT0, kEntryHi), mtc0(kT1, kEntryLo), mtc0(kT2, kIndex), cp0_word(kFnTlbwi),
           cp0_word(kFnTlbwr), cp0_word(kFnTlbp), mfc0(kT3, kIndex), kNopWord});
  rig.r(kT0) = 0x5000;
  rig.r(kT1) = 0x20000 | kLoValid | kLoDirty;
  rig.r(kT2) = 3 << 8;
  rig.run(4);
  EXPECT_EQ(0x5000u, rig.state().tlb[3].hi);
  EXPECT_EQ(0x20000u | kLoValid | kLoDirty, rig.state().tlb[3].lo);
  rig.state().entry_hi = 0x6000;
  rig.run(1);
  const unsigned random = 63 - 4 % 56;
  EXPECT_EQ(0x6000u, rig.state().tlb[random].hi);
  rig.run(3);
  EXPECT_EQ(random << 8, rig.r(kT3));
  rig.state().entry_hi = 0x7000;
  rig.jump(kCode + 20);
  rig.run(3);
  EXPECT_EQ(0x80000000u, rig.r(kT3));
}

TEST(R3000Tlb, AReplacedEntryIsNotUsedAnyMore) {
  Rig rig({i_word(kMajorLw, kT0, kT4, 0), cp0_word(kFnTlbwi), i_word(kMajorLw, kT0, kT4, 0), kNopWord});
  rig.state().tlb[0] = {0x1000, 0x20000 | kLoValid | kLoGlobal};
  rig.state().entry_hi = 0x9000;
  rig.r(kT4) = 0x1000;
  rig.run(3);
  EXPECT_EQ(1u, rig.state().tlb_refills);
  EXPECT_EQ(kCode + 8, rig.state().epc);
}

TEST(R3000Tlb, RandomNeverNamesAWiredEntry) {
  Rig rig;
  std::vector<std::uint32_t> words;
  for (int i = 0; i < 120; ++i) words.push_back(mfc0(kT0, kRandom));
  rig.put(kCode, words);
  for (int i = 0; i < 120; ++i) {
    rig.run(1);
    if (i > 1) {
      EXPECT_GE(rig.r(kT0) >> 8, 8u);
      EXPECT_LE(rig.r(kT0) >> 8, 63u);
    }
  }
}

TEST(R3000Interrupt, IsTakenWhenEnabledUnmaskedAndAskedFor) {
  for (const unsigned off : {0u, 1u, 2u, 3u}) {
    Rig rig({kNopWord, kNopWord});
    rig.state().status |= (off == 1 ? 0 : kStatusIec) | (off == 2 ? 0 : 1u << 12);
    rig.state().lines = off == 3 ? 0 : 4;
    rig.run(1);
    EXPECT_EQ(off == 0 ? 1u : 0u, rig.state().exceptions) << off;
    if (off == 0) {
      EXPECT_EQ(kCode, rig.state().epc);
    }
  }
}

TEST(R3000Interrupt, ASoftwareInterruptIsTakenBehindTheWordThatAsks) {
  Rig rig({mtc0(kT0, kCause), kNopWord, kNopWord});
  rig.state().status |= kStatusIec | 0x100;
  rig.r(kT0) = 0x100;
  rig.run(2);
  EXPECT_EQ(1u, rig.state().exceptions);
  EXPECT_EQ(kCode + 4, rig.state().epc);
  EXPECT_EQ(unsigned{kInt}, rig.code());
}

TEST(R3000Interrupt, InASlotPointsAtTheBranch) {
  Rig rig({i_word(kMajorBeq, 0, 0, 5), kNopWord});
  rig.run(1);
  rig.state().status |= kStatusIec | 0x400;
  rig.state().lines = 1;
  rig.run(1);
  EXPECT_EQ(kCode, rig.state().epc);
  EXPECT_TRUE(rig.state().cause & kCauseBd);
}

TEST(R3000Fpu, AnEnabledExceptionInterruptsTheWordItself) {
  Rig rig({kNopWord, r3010::fp_word(r3010::kDouble, r3010::kDiv, 4, 2, 0)});
  rig.state().status |= kStatusIec | kStatusIm;
  rig.state().fpu.control = r3010::kDivideByZero << r3010::kEnableShift;
  rig.state().fpu.r[3] = 0x3FF00000;
  rig.state().fpu.r[4] = rig.state().fpu.r[5] = 0x55555555;
  rig.run(2);
  EXPECT_EQ(unsigned{kInt}, rig.code());
  EXPECT_EQ(kCode + 4, rig.state().epc);
  EXPECT_EQ(0x55555555u, rig.state().fpu.r[5]);
  EXPECT_EQ(1u << 13, cause_of(rig.state()) & kStatusIm);
}

TEST(R3000Cp0, TheProcessorIdentificationIsTheSpecs) {
  Spec spec;
  spec.processor_id = 0x0220;
  Rig rig({mfc0(kT0, kPrId), kNopWord}, spec);
  rig.run(2);
  EXPECT_EQ(0x0220u, rig.r(kT0));
}

TEST(R3000Fpu, BranchesOnTheConditionAndMovesWords) {
  Rig rig({cop_word(1, kMtc, kT0, 2), cop_word(1, kMtc, kT0, 4), kNopWord,
           r3010::fp_word(r3010::kSingle, r3010::kCompare + 2, 0, 2, 4), kNopWord,
           17u << 26 | 8u << 21 | 1u << 16 | 4, cop_word(1, kMfc, kT1, 2), kNopWord});
  rig.r(kT0) = 0x3F800000;
  rig.run(8);
  EXPECT_EQ(kCode + 24 + 16 + 4, rig.state().pc);
  EXPECT_EQ(0x3F800000u, rig.r(kT1));
}

}  // namespace
}  // namespace dendro::r3000
