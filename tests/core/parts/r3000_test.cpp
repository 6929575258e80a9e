#include <random>

#include "tests/core/parts/r3000_rig.h"

namespace dendro::r3000 {
namespace {

constexpr std::uint32_t kNopWord = 0;

std::uint32_t addiu(unsigned rt, unsigned rs, int value) { return i_word(kMajorAddiu, rt, rs, value); }
std::uint32_t lw(unsigned rt, unsigned rs, int at) { return i_word(kMajorLw, rt, rs, at); }

/// One three-register word with two operands; its result.
std::uint32_t alu(std::uint32_t fn, std::uint32_t a, std::uint32_t b, unsigned sa = 0) {
  Rig rig({r_word(fn, kT2, kT0, kT1, sa)});
  rig.r(kT0) = a;
  rig.r(kT1) = b;
  rig.run(1);
  EXPECT_EQ(kCode + 4, rig.state().pc);
  return rig.r(kT2);
}

std::uint32_t immediate(std::uint32_t major, std::uint32_t a, int value) {
  Rig rig({i_word(major, kT2, kT0, value)});
  rig.r(kT0) = a;
  rig.run(1);
  return rig.r(kT2);
}

TEST(R3000Alu, AddsSubtractsAndComparesModulo32Bits) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t a = random(), b = random();
    EXPECT_EQ(a + b, alu(kFnAddu, a, b));
    EXPECT_EQ(a - b, alu(kFnSubu, a, b));
    EXPECT_EQ(a < b, alu(kFnSltu, a, b));
    EXPECT_EQ(static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b), alu(kFnSlt, a, b));
    EXPECT_EQ(a & b, alu(kFnAnd, a, b));
    EXPECT_EQ(a | b, alu(kFnOr, a, b));
    EXPECT_EQ(a ^ b, alu(kFnXor, a, b));
    EXPECT_EQ(~(a | b), alu(kFnNor, a, b));
  }
}

TEST(R3000Alu, ShiftsTakeFiveBitsOfTheirCount) {
  EXPECT_EQ(0x80000000u, alu(kFnSll, 0, 1, 31));
  EXPECT_EQ(1u, alu(kFnSrl, 0, 0x80000000, 31));
  EXPECT_EQ(0xFFFFFFFFu, alu(kFnSra, 0, 0x80000000, 31));
  EXPECT_EQ(2u, alu(kFnSllv, 33, 1));
  EXPECT_EQ(0x40000000u, alu(kFnSrlv, 0xFFFFFFE1, 0x80000000));
  EXPECT_EQ(0xC0000000u, alu(kFnSrav, 1, 0x80000000));
}

TEST(R3000Alu, ImmediatesAreSignExtendedButForLogic) {
  EXPECT_EQ(4u, immediate(kMajorAddiu, 5, -1));
  EXPECT_EQ(1u, immediate(kMajorSlti, 0xFFFFFFFE, -1));
  EXPECT_EQ(1u, immediate(kMajorSltiu, 5, -1));  // compared with 0xFFFFFFFF
  EXPECT_EQ(0xFFFFu, immediate(kMajorAndi, 0xFFFFFFFF, -1));
  EXPECT_EQ(0xFFFF8001u, immediate(kMajorOri, 0xFFFF0000, 0x8001));
  EXPECT_EQ(0xFFFF7FFEu, immediate(kMajorXori, 0xFFFFFFFF, 0x8001));
  EXPECT_EQ(0x80010000u, immediate(kMajorLui, 7, 0x8001));
}

TEST(R3000Alu, RegisterZeroStaysZero) {
  Rig rig({addiu(0, 0, 7), r_word(kFnAddu, kT0, 0, 0), r_word(kFnMfhi, 0, 0, 0)});
  rig.state().hi = 9;
  rig.run(3);
  EXPECT_EQ(0u, rig.r(0));
  EXPECT_EQ(0u, rig.r(kT0));
}

TEST(R3000Alu, SignedOverflowTrapsAndLeavesTheDestination) {
  struct Case {
    std::uint32_t word, a, b;
    bool traps;
  };
  const Case cases[] = {{r_word(kFnAdd, kT2, kT0, kT1), 0x7FFFFFFF, 1, true},
                        {r_word(kFnAdd, kT2, kT0, kT1), 0x7FFFFFFF, 0, false},
                        {r_word(kFnAdd, kT2, kT0, kT1), 0x80000000, 0xFFFFFFFF, true},
                        {r_word(kFnSub, kT2, kT0, kT1), 0x80000000, 1, true},
                        {r_word(kFnSub, kT2, kT0, kT1), 0, 0x80000000, true},
                        {r_word(kFnSub, kT2, kT0, kT1), 0xFFFFFFFF, 0x80000000, false},
                        {r_word(kFnAdd, 0, kT0, kT1), 0x7FFFFFFF, 1, true},
                        {i_word(kMajorAddi, kT2, kT0, -1), 0x80000000, 0, true},
                        {i_word(kMajorAddi, kT2, kT0, -1), 0x80000001, 0, false}};
  for (const Case& c : cases) {
    Rig rig({c.word});
    rig.r(kT0) = c.a;
    rig.r(kT1) = c.b;
    rig.r(kT2) = 0x1234;
    rig.run(1);
    EXPECT_EQ(c.traps ? kHandler : kCode + 4, rig.state().pc) << std::hex << c.word;
    EXPECT_EQ(c.traps, rig.r(kT2) == 0x1234);
    if (c.traps) {
      EXPECT_EQ(unsigned{kOv}, rig.code());
    }
  }
}

TEST(R3000MultiplyDivide, GiveTheWholeProductAndQuotientWithRemainder) {
  struct Case {
    std::uint32_t fn, a, b, hi, lo;
  };
  const Case cases[] = {
      {kFnMult, 0xFFFFFFFF, 2, 0xFFFFFFFF, 0xFFFFFFFE},
      {kFnMultu, 0xFFFFFFFF, 2, 1, 0xFFFFFFFE},
      {kFnMult, 0x80000000, 0x80000000, 0x40000000, 0},
      {kFnDiv, static_cast<std::uint32_t>(-7), 2, 0xFFFFFFFF, static_cast<std::uint32_t>(-3)},
      {kFnDivu, 0xFFFFFFF9, 2, 1, 0x7FFFFFFC},
      {kFnDiv, 0x80000000, 0xFFFFFFFF, 0, 0x80000000},
      {kFnDiv, 5, 0, 5, 0xFFFFFFFF},
      {kFnDiv, 0xFFFFFFFB, 0, 0xFFFFFFFB, 1},
      {kFnDivu, 5, 0, 5, 0xFFFFFFFF}};
  for (const Case& c : cases) {
    Rig rig({r_word(c.fn, 0, kT0, kT1), r_word(kFnMfhi, kT2, 0, 0), r_word(kFnMflo, kT3, 0, 0)});
    rig.r(kT0) = c.a;
    rig.r(kT1) = c.b;
    rig.run(3);
    EXPECT_EQ(c.hi, rig.r(kT2)) << c.fn << " " << c.a;
    EXPECT_EQ(c.lo, rig.r(kT3)) << c.fn << " " << c.a;
  }
}

TEST(R3000MultiplyDivide, HiAndLoAreWrittenByMove) {
  Rig rig({r_word(kFnMthi, 0, kT0, 0), r_word(kFnMtlo, 0, kT1, 0)});
  rig.r(kT0) = 3;
  rig.r(kT1) = 4;
  rig.run(2);
  EXPECT_EQ(3u, rig.state().hi);
  EXPECT_EQ(4u, rig.state().lo);
}

TEST(R3000Branch, ATakenBranchExecutesItsDelaySlot) {
  Rig rig({i_word(kMajorBeq, 0, 0, 3), addiu(kT0, 0, 1), addiu(kT1, 0, 1), kNopWord, addiu(kT2, 0, 1)});
  rig.run(3);
  EXPECT_EQ(1u, rig.r(kT0));
  EXPECT_EQ(0u, rig.r(kT1));
  EXPECT_EQ(1u, rig.r(kT2));
}

TEST(R3000Branch, ConditionsAreThoseOfTheirNames) {
  const auto taken = [](std::uint32_t word, std::uint32_t a, std::uint32_t b = 0) {
    Rig rig({word});
    rig.r(kT0) = a;
    rig.r(kT1) = b;
    rig.run(2);
    EXPECT_TRUE(rig.state().pc == kCode + 8 || rig.state().pc == kCode + 20);
    return rig.state().pc == kCode + 20;
  };
  const std::uint32_t minus = 0xFFFFFFFF;
  const auto one = [](std::uint32_t major) { return i_word(major, 0, kT0, 4); };
  const auto regimm = [](unsigned code) { return i_word(kRegimm, code, kT0, 4); };
  EXPECT_TRUE(taken(i_word(kMajorBeq, kT1, kT0, 4), 5, 5));
  EXPECT_FALSE(taken(i_word(kMajorBeq, kT1, kT0, 4), 5, 6));
  EXPECT_FALSE(taken(i_word(kMajorBne, kT1, kT0, 4), 5, 5));
  EXPECT_TRUE(taken(i_word(kMajorBne, kT1, kT0, 4), 5, 6));
  for (const std::uint32_t a : {minus, 0u, 1u}) {
    EXPECT_EQ(a != 1, taken(one(kMajorBlez), a));
    EXPECT_EQ(a == 1, taken(one(kMajorBgtz), a));
    EXPECT_EQ(a == minus, taken(regimm(0), a));
    EXPECT_EQ(a != minus, taken(regimm(1), a));
    EXPECT_EQ(a == minus, taken(regimm(16), a));
    EXPECT_EQ(a != minus, taken(regimm(17), a));
  }
}

TEST(R3000Branch, LinksToTheWordBehindItsSlotTakenOrNot) {
  for (const std::uint32_t word : {j_word(kMajorJal, kCode + 64), r_word(kFnJalr, kRa, kT0, 0),
                                   i_word(kRegimm, 16, kT1, 9), i_word(kRegimm, 17, kT1, 9)}) {
    Rig rig({word});
    rig.r(kT0) = kCode + 64;
    rig.run(1);
    EXPECT_EQ(kCode + 8, rig.r(kRa)) << std::hex << word;
  }
}

TEST(R3000Branch, JalrThatLinksToItsOwnRegisterJumpsToTheOldValue) {
  Rig rig({r_word(kFnJalr, kT0, kT0, 0)});
  rig.r(kT0) = kCode + 64;
  rig.run(2);
  EXPECT_EQ(kCode + 64, rig.state().pc);
  EXPECT_EQ(kCode + 8, rig.r(kT0));
}

TEST(R3000Branch, CrossesPagesThroughItsSlot) {
  Rig rig;
  rig.put(kCode + 0xFFC, {i_word(kMajorBeq, 0, 0, 16), addiu(kT0, 0, 1)});
  rig.jump(kCode + 0xFFC);
  rig.run(2);
  EXPECT_EQ(1u, rig.r(kT0));
  EXPECT_EQ(kCode + 0x1000 + 64, rig.state().pc);
}

TEST(R3000Branch, AJumpToAnUnalignedAddressFaultsThereAfterItsSlot) {
  Rig rig({r_word(kFnJr, 0, kT0, 0), addiu(kT1, 0, 1)});
  rig.r(kT0) = kCode + 66;
  rig.run(3);
  EXPECT_EQ(1u, rig.r(kT1));
  EXPECT_EQ(unsigned{kAdel}, rig.code());
  EXPECT_EQ(kCode + 66, rig.state().epc);
  EXPECT_EQ(kCode + 66, rig.state().bad_vaddr);
}

TEST(R3000Load, TheSlotReadsTheOldValueAndTheNextWordTheNewOne) {
  Rig rig({lw(kT0, kT4, 0), r_word(kFnAddu, kT1, kT0, 0), r_word(kFnAddu, kT2, kT0, 0)});
  rig.r(kT4) = kData;
  rig.r(kT0) = 5;
  rig.poke(kData, 77);
  rig.run(3);
  EXPECT_EQ(5u, rig.r(kT1));
  EXPECT_EQ(77u, rig.r(kT2));
}

TEST(R3000Load, AWriteInTheSlotWins) {
  Rig rig({lw(kT0, kT4, 0), addiu(kT0, kT0, 1), kNopWord});
  rig.r(kT4) = kData;
  rig.r(kT0) = 5;
  rig.poke(kData, 77);
  rig.run(3);
  EXPECT_EQ(6u, rig.r(kT0));
}

TEST(R3000Load, TheSlotMayStoreTheOldValueOrAddressWithIt) {
  Rig rig({lw(kT0, kT4, 0), i_word(kMajorSw, kT0, kT0, 8)});
  rig.r(kT4) = kData;
  rig.r(kT0) = kData;
  rig.poke(kData, 77);
  rig.run(2);
  EXPECT_EQ(kData, rig.peek(kData + 8));
}

TEST(R3000Load, ALoadInABranchSlotIsSeenFromTheSecondWordOfTheTarget) {
  Rig rig({i_word(kMajorBeq, 0, 0, 3), lw(kT0, kT4, 0), kNopWord, kNopWord, r_word(kFnAddu, kT1, kT0, 0),
           r_word(kFnAddu, kT2, kT0, 0)});
  rig.r(kT4) = kData;
  rig.r(kT0) = 5;
  rig.poke(kData, 77);
  rig.run(4);
  EXPECT_EQ(5u, rig.r(kT1));
  EXPECT_EQ(77u, rig.r(kT2));
}

TEST(R3000Load, OfTwoLoadsToOneRegisterTheSecondWins) {
  Rig rig({lw(kT0, kT4, 0), lw(kT0, kT4, 4), r_word(kFnAddu, kT1, kT0, 0), r_word(kFnAddu, kT2, kT0, 0)});
  rig.r(kT4) = kData;
  rig.poke(kData, 77);
  rig.poke(kData + 4, 88);
  rig.run(4);
  EXPECT_EQ(88u, rig.r(kT2));
}

TEST(R3000Load, AnExceptionInTheSlotFindsTheLoadDone) {
  Rig rig({lw(kT0, kT4, 0), r_word(kFnAdd, kT0, kT0, kT1)});
  rig.r(kT4) = kData;
  rig.r(kT0) = rig.r(kT1) = 0x7FFFFFFF;  // the old value overflows
  rig.poke(kData, 77);
  rig.run(2);
  EXPECT_EQ(unsigned{kOv}, rig.code());
  EXPECT_EQ(kCode + 4, rig.state().epc);
  EXPECT_EQ(77u, rig.r(kT0));
}

TEST(R3000Load, TheConditionOfABranchInTheSlotIsOld) {
  Rig rig({lw(kT0, kT4, 0), i_word(kMajorBeq, 0, kT0, 4), kNopWord});
  rig.r(kT4) = kData;
  rig.poke(kData, 77);
  rig.run(3);
  EXPECT_EQ(kCode + 4 + 20, rig.state().pc);
}

TEST(R3000Load, BytesAndHalvesAreBigEndianAndExtended) {
  struct Case {
    std::uint32_t major;
    int at;
    std::uint32_t value;
  };
  const Case cases[] = {{kMajorLb, 0, 0xFFFFFF81}, {kMajorLbu, 0, 0x81},   {kMajorLb, 3, 0x44},
                        {kMajorLh, 0, 0xFFFF8122}, {kMajorLhu, 0, 0x8122}, {kMajorLhu, 2, 0x3344},
                        {kMajorLw, 0, 0x81223344}};
  for (const Case& c : cases) {
    Rig rig({i_word(c.major, kT0, kT4, c.at), kNopWord});
    rig.r(kT4) = kData;
    rig.poke(kData, 0x81223344);
    rig.run(2);
    EXPECT_EQ(c.value, rig.r(kT0)) << c.major << " " << c.at;
  }
}

TEST(R3000Store, WritesTheBytesThatItNamesAndNoOthers) {
  struct Case {
    std::uint32_t major;
    int at;
    std::uint32_t value;
  };
  const Case cases[] = {{kMajorSb, 0, 0x44000000},  {kMajorSb, 3, 0x44},       {kMajorSh, 0, 0x33440000},
                        {kMajorSh, 2, 0x3344},      {kMajorSw, 0, 0x11223344}, {kMajorSwl, 0, 0x11223344},
                        {kMajorSwl, 1, 0x00112233}, {kMajorSwl, 3, 0x11},      {kMajorSwr, 3, 0x11223344},
                        {kMajorSwr, 1, 0x33440000}, {kMajorSwr, 0, 0x44000000}};
  for (const Case& c : cases) {
    Rig rig({i_word(c.major, kT0, kT4, c.at)});
    rig.r(kT4) = kData;
    rig.r(kT0) = 0x11223344;
    rig.run(1);
    EXPECT_EQ(c.value, rig.peek(kData)) << c.major << " " << c.at;
    EXPECT_EQ(0u, rig.peek(kData + 4));
  }
}

TEST(R3000Load, APairOfLwlAndLwrReadsAnUnalignedWordWithoutANop) {
  for (int at = 0; at < 4; ++at)
    for (const bool left_first : {true, false}) {
      const std::uint32_t left = i_word(kMajorLwl, kT0, kT4, at), right = i_word(kMajorLwr, kT0, kT4, at + 3);
      Rig rig({left_first ? left : right, left_first ? right : left, kNopWord});
      rig.r(kT4) = kData;
      rig.poke(kData, 0x01020304);
      rig.poke(kData + 4, 0x05060708);
      rig.run(3);
      const auto expected = static_cast<std::uint32_t>(0x0102030405060708ull >> (32 - 8 * at));
      EXPECT_EQ(expected, rig.r(kT0)) << at;
    }
}

TEST(R3000Load, APartMergesIntoALoadInFlight) {
  Rig rig({i_word(kMajorBeq, 0, 0, 2), lw(kT0, kT4, 0), kNopWord, i_word(kMajorLwr, kT0, kT4, 5), kNopWord});
  rig.r(kT4) = kData;
  rig.poke(kData, 0x01020304);
  rig.poke(kData + 4, 0x05060708);
  rig.run(4);
  EXPECT_EQ(0x01020506u, rig.r(kT0));
}

TEST(R3000Code, AStoreIntoCodeIsExecuted) {
  Rig rig({addiu(kT1, kT1, 1), i_word(kMajorSw, kT0, kT4, 12), kNopWord, addiu(kT1, kT1, 1)});
  rig.r(kT4) = kCode;
  rig.r(kT0) = addiu(kT1, kT1, 100);
  rig.run(4);
  EXPECT_EQ(101u, rig.r(kT1));
}

TEST(R3000Code, AStateIsACopyThatCanBeRunAgain) {
  Rig rig({addiu(kT0, kT0, 3), i_word(kMajorBne, kT1, kT0, -2), kNopWord});
  rig.r(kT1) = 300;
  rig.run(20);
  const State copy = rig.state();
  rig.run(50);
  const std::uint32_t after = rig.r(kT0);
  rig.state() = copy;
  rig.core.forget();
  for (int i = 0; i < 50; ++i) rig.run(1);  // one at a time, so that slots survive the pauses
  EXPECT_EQ(after, rig.r(kT0));
}

}  // namespace
}  // namespace dendro::r3000
