#include <algorithm>
#include <random>

#include "tests/core/parts/r3000_rig.h"

namespace dendro::r3000 {
namespace {

constexpr std::uint32_t kInexactFlag = r3010::kInexact << r3010::kFlagShift;

/// Two pages of words that depend on each other: loops, branches over a few words, calls into the other page,
/// loads and stores, floating point, now and then a store into code, a fault, a word that blocks do not have.
class Program {
 public:
  explicit Program(std::uint32_t seed) : random_(seed) {}

  static constexpr std::uint32_t kStart = kCode + 4096 - 256, kSub = kCode + 4096 + 1024;

  void load(Rig& rig) {
    while (words_.size() < 120) piece();
    words_.push_back(i_word(kMajorBeq, 0, 0, -static_cast<std::int32_t>(words_.size()) - 1));
    words_.push_back(alu());
    std::vector<std::uint32_t> sub;
    std::swap(sub, words_);
    rig.put(kStart, sub);
    while (words_.size() < 20) plain();
    words_.insert(words_.end(), {r_word(kFnJr, 0, kRa, 0), alu()});
    rig.put(kSub, words_);
    // Goes on behind the word that faulted.
    rig.put(kHandler, {cop_word(0, kMfc, 26, kEpc), 0, i_word(kMajorAddiu, 26, 26, 4),
                       r_word(kFnJr, 0, 26, 0), cp0_word(kFnRfe)});
    rig.jump(kStart);
    State& s = rig.state();
    for (unsigned r = 2; r < 8; ++r) s.r[r] = static_cast<std::uint32_t>(random_());
    s.r[16] = kData;
    s.r[17] = kStart + 64;
    s.r[18] = i_word(kMajorAddiu, 3, 3, 5);
    for (std::uint32_t& word : s.fpu.r) word = 0x3F800000 + static_cast<std::uint32_t>(random_() % (1 << 25));
    for (unsigned i = 0; i < 1024; i += 4)
      rig.poke(kData + i,
               draw(9) == 0 ? draw(3) : 0x3F800000 + static_cast<std::uint32_t>(random_() % (1 << 26)));
    s.fpu.control = draw(4) == 0 ? 0 : kInexactFlag | (draw(6) == 0 ? draw(4) : 0);
    if (draw(8) == 0) s.status &= ~kStatusCu1;
  }

 private:
  unsigned draw(unsigned below) { return static_cast<unsigned>(random_() % below); }
  unsigned reg() { return draw(12) == 0 ? 0 : 2 + draw(6); }
  unsigned fp(bool wide) { return wide ? 2 * draw(6) : draw(12); }

  std::uint32_t alu() {
    static constexpr std::uint32_t kThree[] = {kFnAddu, kFnSubu, kFnAnd,  kFnOr,   kFnXor,  kFnNor,
                                               kFnSlt,  kFnSltu, kFnSllv, kFnSrlv, kFnSrav, kFnAdd};
    static constexpr std::uint32_t kImmediate[] = {kMajorAddiu, kMajorSlti, kMajorSltiu, kMajorAndi,
                                                   kMajorOri,   kMajorXori, kMajorLui};
    static constexpr std::uint32_t kShifts[] = {kFnSll, kFnSrl, kFnSra};
    switch (draw(4)) {
      case 0:
        return draw(2) == 0 ? 0 : r_word(kShifts[draw(3)], reg(), 0, reg(), draw(32));
      case 1: {
        const std::uint32_t major = kImmediate[draw(7)];
        return i_word(major, reg(), major == kMajorLui ? 0 : reg(),
                      static_cast<std::int32_t>(draw(65536)) - 32768);
      }
      default:
        return r_word(kThree[draw(50) == 0 ? 11 : draw(11)], reg(), reg(), reg());
    }
  }
  std::uint32_t floating() {
    static constexpr unsigned kOperations[] = {r3010::kAdd,  r3010::kSub,  r3010::kMul,    r3010::kDiv,
                                               r3010::kAbs,  r3010::kNeg,  r3010::kMov,    r3010::kCvtS,
                                               r3010::kCvtD, r3010::kCvtW, r3010::kCompare};
    const unsigned kind = draw(20);
    if (kind == 0) return cop_word(1, kMtc, reg(), fp(false));
    if (kind == 1) return cop_word(1, kMfc, reg(), fp(false));
    if (kind == 2) return cop_word(1, kCfc, reg(), 31);
    const r3010::Format format = kind < 11 ? r3010::kSingle : kind < 19 ? r3010::kDouble : r3010::kWord;
    unsigned operation = kOperations[draw(11)];
    if (operation == r3010::kCompare) operation += draw(16);
    const bool wide = format == r3010::kDouble;
    return r3010::fp_word(format, operation, fp(wide || operation == r3010::kCvtD), fp(wide), fp(wide));
  }
  std::uint32_t access() {
    static constexpr std::uint32_t kMajors[] = {kMajorLw,   kMajorLw,   kMajorSw,  kMajorSw, kMajorLb,
                                                kMajorLbu,  kMajorLh,   kMajorLhu, kMajorSb, kMajorSh,
                                                kMajorLwc1, kMajorSwc1, kMajorLwl, kMajorSwr};
    const std::uint32_t major = kMajors[draw(14)];
    const std::int32_t offset = static_cast<std::int32_t>(draw(200)) & (draw(60) == 0 ? ~0 : ~3);
    if (draw(60) == 0) return i_word(kMajorSw, 18, 17, offset & ~3);  // into code
    return i_word(major, major == kMajorLwc1 || major == kMajorSwc1 ? fp(false) : reg(),
                  draw(80) == 0 ? reg() : 16, offset);
  }
  std::uint32_t any() {
    const unsigned kind = draw(100);
    if (kind < 45) return alu();
    if (kind < 70) return access();
    if (kind < 92) return floating();
    static constexpr std::uint32_t kMultiplier[] = {kFnMult, kFnMultu, kFnDiv, kFnDivu, kFnMthi};
    if (kind < 95) return r_word(kMultiplier[draw(5)], 0, reg(), reg());
    if (kind < 99) return r_word(draw(2) == 0 ? kFnMfhi : kFnMflo, reg(), 0, 0);
    return draw(2) == 0 ? r_word(kFnSyscall, 0, 0, 0) : kCop2 << 26;
  }
  void plain() { words_.push_back(any()); }
  void piece() {
    const unsigned over = 1 + draw(5);
    switch (draw(8)) {
      case 0: {  // forward
        static constexpr std::uint32_t kMajors[] = {kMajorBeq, kMajorBne, kMajorBlez, kMajorBgtz};
        const std::uint32_t major = kMajors[draw(4)];
        words_.push_back(
            i_word(major, major <= kMajorBne ? reg() : 0, reg(), static_cast<std::int32_t>(over)));
        break;
      }
      case 1:
        words_.push_back(cop_word(1, kBc, draw(2), 0) | over);
        break;
      case 2:
        words_.push_back(
            i_word(kRegimm, (draw(5) == 0 ? 16 : 0) + draw(2), reg(), static_cast<std::int32_t>(over)));
        break;
      case 3:
        words_.push_back(j_word(
            draw(2) == 0 ? kMajorJal : kMajorJ,
            draw(2) == 0 ? kSub : kStart + static_cast<std::uint32_t>(4 * (words_.size() + 1 + over))));
        break;
      case 4: {  // a loop
        words_.push_back(i_word(kMajorAddiu, 20, 0, static_cast<std::int32_t>(2 + draw(9))));
        for (unsigned i = 0; i < over; ++i) plain();
        words_.push_back(i_word(kMajorAddiu, 20, 20, -1));
        words_.push_back(i_word(kMajorBgtz, 0, 20, -static_cast<std::int32_t>(over) - 2));
        break;
      }
      default:
        break;
    }
    for (unsigned i = 0; i < over + 1; ++i) plain();
  }

  std::mt19937 random_;
  std::vector<std::uint32_t> words_;
};

void expect_same(const State& a, const State& b, std::uint32_t seed) {
  EXPECT_TRUE(std::equal(a.r, a.r + 32, b.r)) << seed;
  EXPECT_TRUE(std::equal(a.fpu.r, a.fpu.r + 32, b.fpu.r)) << seed;
  EXPECT_EQ(a.fpu.control, b.fpu.control) << seed;
  EXPECT_EQ(a.hi, b.hi) << seed;
  EXPECT_EQ(a.lo, b.lo) << seed;
  EXPECT_EQ(a.pc, b.pc) << seed;
  EXPECT_EQ(a.next_pc, b.next_pc) << seed;
  EXPECT_EQ(a.in_slot, b.in_slot) << seed;
  EXPECT_EQ(a.pending_reg, b.pending_reg) << seed;
  EXPECT_EQ(a.instructions, b.instructions) << seed;
  EXPECT_EQ(a.exceptions, b.exceptions) << seed;
  EXPECT_EQ(a.epc, b.epc) << seed;
  EXPECT_EQ(a.cause, b.cause) << seed;
}

TEST(R3000Block, BlocksLeaveAfterEveryPieceWhatSingleWordsLeave) {
  std::uint64_t completed = 0, faults = 0;
  for (std::uint32_t seed = 1; seed <= 300 && !::testing::Test::HasFailure(); ++seed) {
    Rig blocks, words;
    Program(seed).load(blocks);
    Program(seed).load(words);
    std::mt19937 random(seed);
    for (int i = 0; i < 60 && !::testing::Test::HasFailure(); ++i) {
      const unsigned piece = 1 + static_cast<unsigned>(random() % (i % 2 == 0 ? 9 : 200));
      blocks.run(piece);
      for (unsigned k = 0; k < piece; ++k) words.run(1);
      expect_same(words.state(), blocks.state(), seed);
    }
    EXPECT_EQ(words.port.memory, blocks.port.memory) << seed;
    completed += blocks.state().instructions;
    faults += blocks.state().exceptions;
  }
  EXPECT_GT(completed, 500000u);
  EXPECT_GT(faults, 1000u);
}

/// Values about the edges of both formats, and ordinary ones.
std::vector<std::uint64_t> operands(bool wide, std::mt19937_64& random) {
  std::vector<std::uint64_t> list;
  const unsigned fraction = wide ? 52 : 23, exponents = wide ? 2047 : 255, middle = exponents / 2;
  for (const unsigned e : {0u, 1u, 2u, middle - 1, middle, middle + 3, middle + 31, exponents - 1, exponents})
    for (const std::uint64_t f : {std::uint64_t{0}, std::uint64_t{1}, (std::uint64_t{1} << fraction) - 1,
                                  random() >> (64 - fraction)})
      for (const std::uint64_t sign : {0, 1})
        list.push_back(sign << (wide ? 63 : 31) | std::uint64_t{e} << fraction | f);
  return list;
}

TEST(R3000Block, FloatingPointLeavesWhatTheR3010Leaves) {
  std::mt19937_64 random(7);
  std::vector<std::uint32_t> words;
  for (const r3010::Format format : {r3010::kSingle, r3010::kDouble, r3010::kWord})
    for (const unsigned operation : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 32u, 33u, 36u, 48u, 50u, 52u, 55u, 60u, 63u})
      words.push_back(r3010::fp_word(format, operation, 8, 2, 4));
  constexpr unsigned kApart = 8;
  Rig rig;
  for (std::size_t i = 0; i < words.size(); ++i)
    rig.put(kCode + static_cast<std::uint32_t>(4 * kApart * i),
            {words[i], 0, i_word(kMajorBeq, 0, 0, -1), 0});
  unsigned done = 0;
  for (const std::uint32_t control :
       {kInexactFlag, 0u, kInexactFlag | 1u, kInexactFlag | (63u << r3010::kCauseShift),
        kInexactFlag | r3010::kInexact << r3010::kEnableShift})
    for (std::size_t i = 0; i < words.size(); ++i) {
      const bool wide = (words[i] >> 21 & 31) == r3010::kDouble;
      const std::vector<std::uint64_t> list = operands(wide, random);
      for (const std::uint64_t a : list)
        for (std::size_t k = 0; k < 12; ++k) {
          const std::uint64_t b = list[random() % list.size()];
          r3010::State expected;
          for (std::uint32_t& r : expected.r) r = 0x12345678;
          expected.r[2] = static_cast<std::uint32_t>(a), expected.r[4] = static_cast<std::uint32_t>(b);
          if (wide)
            expected.r[3] = static_cast<std::uint32_t>(a >> 32),
            expected.r[5] = static_cast<std::uint32_t>(b >> 32);
          expected.control = control;
          rig.state().fpu = expected;
          rig.jump(kCode + static_cast<std::uint32_t>(4 * kApart * i));
          rig.state().in_slot = false;
          rig.run(4);
          done += r3010::execute(expected, words[i]) == r3010::Outcome::kDone;
          ASSERT_TRUE(std::equal(expected.r, expected.r + 32, rig.state().fpu.r))
              << std::hex << words[i] << " " << a << " " << b << " " << control;
          ASSERT_EQ(expected.control, rig.state().fpu.control)
              << std::hex << words[i] << " " << a << " " << b << " " << control;
        }
    }
  EXPECT_GT(done, 100000u);
}

TEST(R3000Block, OrdinaryOperandsNeedNoMoreThanTheHost) {
  r3010::State s;
  s.control = kInexactFlag;
  ASSERT_TRUE(r3010::Quick::suits(s));
  s.r[2] = 0x3F800001;
  s.r[4] = 0x40490FDB;
  r3010::Quick quick;
  EXPECT_TRUE(quick.single<r3010::kMul>(s, 8, 2, 4, r3010::fp_word(r3010::kSingle, r3010::kMul, 8, 2, 4)));
  quick.settle(s);
  EXPECT_EQ(kInexactFlag | r3010::kInexact << r3010::kCauseShift, s.control);
  for (const std::uint32_t wrong :
       {0u, kInexactFlag | 1u, kInexactFlag | r3010::kOverflow << r3010::kEnableShift}) {
    s.control = wrong;
    EXPECT_FALSE(r3010::Quick::suits(s)) << wrong;
  }
}

TEST(R3000Block, AnUnalignedAccessInTheFirstPageFaults) {
  for (const std::uint32_t major : {kMajorLw, kMajorLh, kMajorSw, kMajorSh}) {
    Rig rig({i_word(major, kT1, kT0, 1), 0, 0});
    rig.run(1);
    EXPECT_EQ(kHandler, rig.state().pc) << major;
    EXPECT_EQ(1u, rig.state().bad_vaddr) << major;
  }
}

TEST(R3000Block, AStoreIntoABlockThatRunsIsSeenByTheNextWord) {
  for (const unsigned distance : {1u, 2u, 3u, 9u}) {
    Rig rig;
    std::vector<std::uint32_t> code = {i_word(kMajorAddiu, kT2, 0, 0)};
    code.push_back(i_word(kMajorSw, kT1, kT0, static_cast<std::int32_t>(4 * (code.size() + distance))));
    code.insert(code.end(), 12, i_word(kMajorAddiu, kT2, kT2, 1));
    code.push_back(i_word(kMajorBeq, 0, 0, -static_cast<std::int32_t>(code.size()) - 1));
    code.push_back(0);
    rig.put(kCode, code);
    rig.r(kT0) = kCode;
    rig.r(kT1) = i_word(kMajorAddiu, kT2, kT2, 1);
    rig.run(3 * code.size());  // blocks are there
    rig.r(kT1) = i_word(kMajorAddiu, kT2, kT2, 77);
    rig.run(code.size() - 2);
    EXPECT_EQ(11u + 77, rig.r(kT2)) << distance;
  }
}

}  // namespace
}  // namespace dendro::r3000
