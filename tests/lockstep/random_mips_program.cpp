#include "tests/lockstep/random_mips_program.h"

#include <random>

#include "models/parts/r3000/r3000_isa.h"
#include "models/parts/r3010/r3010.h"

namespace dendro::sgi_4d35 {
namespace {

using namespace r3000;

constexpr unsigned kAt = 1;
/// Bases of data, never written by random words: cached, the same uncached, mapped, the service block, nowhere.
constexpr unsigned kCachedBase = 16, kConflictBase = 17, kUncachedBase = 18, kMappedBase = 19, kDeviceBase = 20,
                   kNothingBase = 21, kLoop = 22;
constexpr std::uint32_t kDataArea = 0x80020000, kMappedData = 0x00010000, kMappedCode = 0x00020000,
                        kCodeFrame = 0x00120000;  ///< physical; what kMappedCode is mapped to

std::uint32_t mtc0(unsigned rt, unsigned reg) { return cop_word(0, kMtc, rt, reg); }
std::uint32_t mfc0(unsigned rt, unsigned reg) { return cop_word(0, kMfc, rt, reg); }

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}
  CornerProgram make();

 private:
  unsigned draw(unsigned below) { return static_cast<unsigned>(random_() % below); }
  bool chance(unsigned percent) { return draw(100) < percent; }
  unsigned reg() { return chance(5) ? 0 : 2 + draw(6); }  // few, so that words depend on each other
  unsigned fp() { return chance(70) ? 2 * draw(4) : draw(32); }
  void word(std::uint32_t w) { words_.push_back(w); }
  void nops(unsigned n) { words_.insert(words_.end(), n, 0); }
  void constant(unsigned r, std::uint32_t value) {
    word(i_word(kMajorLui, r, 0, static_cast<std::int32_t>(value >> 16)));
    word(i_word(kMajorOri, r, r, static_cast<std::int32_t>(value & 0xFFFF)));
  }
  std::uint32_t alu();
  std::uint32_t access();
  std::uint32_t floating();
  std::uint32_t multiplier();
  std::uint32_t any();
  void branch();
  void loop();
  void system();
  void isolated();
  void body(unsigned pieces);
  void prologue();

  std::mt19937 random_;
  std::vector<std::uint32_t> words_;
  std::uint32_t base_ = 0;
  std::uint32_t status_ = 0;
  bool system_words_ = false;
};

std::uint32_t Generator::alu() {
  static constexpr std::uint32_t kThree[] = {kFnAdd, kFnAddu, kFnSub, kFnSubu, kFnAnd, kFnOr,
                                             kFnXor, kFnNor,  kFnSlt, kFnSltu, kFnSllv, kFnSrlv, kFnSrav};
  static constexpr std::uint32_t kImmediate[] = {kMajorAddi, kMajorAddiu, kMajorSlti, kMajorSltiu,
                                                 kMajorAndi, kMajorOri,   kMajorXori, kMajorLui};
  static constexpr std::uint32_t kShifts[] = {kFnSll, kFnSrl, kFnSra};
  switch (draw(4)) {
    case 0:
      return 0;
    case 1:
      return r_word(kShifts[draw(3)], reg(), 0, reg(), draw(32));
    case 2: {
      const std::uint32_t major = kImmediate[draw(8)];
      return i_word(major, reg(), major == kMajorLui ? 0 : reg(), static_cast<std::int32_t>(draw(65536)) - 32768);
    }
    default:
      return r_word(kThree[draw(13)], reg(), reg(), reg());
  }
}

std::uint32_t Generator::access() {
  struct Kind {
    std::uint32_t major;
    unsigned size;
  };
  static constexpr Kind kKinds[] = {{kMajorLw, 4},  {kMajorSw, 4},  {kMajorLb, 1},   {kMajorLbu, 1},
                                    {kMajorLh, 2},  {kMajorLhu, 2}, {kMajorLwl, 1},  {kMajorLwr, 1},
                                    {kMajorSb, 1},  {kMajorSh, 2},  {kMajorSwl, 1},  {kMajorSwr, 1},
                                    {kMajorSw, 4},  {kMajorLw, 4},  {kMajorLwc1, 4}, {kMajorSwc1, 4}};
  const Kind kind = kKinds[draw(16)];
  const bool fpu = kind.major == kMajorLwc1 || kind.major == kMajorSwc1;
  const unsigned place = draw(100);
  unsigned base = place < 50 ? kCachedBase : place < 75 ? kConflictBase : place < 82 ? kUncachedBase : kMappedBase;
  std::int32_t offset = static_cast<std::int32_t>(draw(chance(60) ? 64 : 4096));
  if (chance(8) && base == kMappedBase) offset += 4096 * static_cast<std::int32_t>(draw(7));
  if (chance(2)) base = chance(50) ? kDeviceBase : kNothingBase;
  if (base == kDeviceBase) offset = DENDRO_SERVICE_RESULT + 4 * static_cast<std::int32_t>(draw(7));
  if (!chance(2)) offset &= -static_cast<std::int32_t>(kind.size);
  return i_word(kind.major, fpu ? fp() : reg(), base, offset);
}

std::uint32_t Generator::floating() {
  static constexpr unsigned kOperations[] = {r3010::kAdd, r3010::kAdd,  r3010::kSub,  r3010::kMul,  r3010::kMul,
                                             r3010::kDiv, r3010::kAbs,  r3010::kMov,  r3010::kNeg,  r3010::kCvtS,
                                             r3010::kCvtD, r3010::kCvtW, r3010::kCompare};
  switch (draw(12)) {
    case 0:
      return cop_word(1, kMtc, reg(), fp());
    case 1:
      return cop_word(1, kMfc, reg(), fp());
    case 2:
      return chance(40) ? cop_word(1, kCtc, reg(), chance(80) ? 31 : draw(32)) : cop_word(1, kCfc, reg(), 31);
    default: {
      const unsigned format = chance(45) ? r3010::kDouble : chance(80) ? r3010::kSingle : chance(80) ? r3010::kWord : 16 + draw(16);
      unsigned operation = chance(3) ? draw(64) : kOperations[draw(13)];
      if (operation == r3010::kCompare) operation += draw(16);
      return r3010::fp_word(static_cast<r3010::Format>(format), operation, fp(), fp(), fp());
    }
  }
}

std::uint32_t Generator::multiplier() {
  static constexpr std::uint32_t kFunctions[] = {kFnMult, kFnMultu, kFnDiv,  kFnDivu,
                                                 kFnMfhi, kFnMflo,  kFnMthi, kFnMtlo};
  const std::uint32_t fn = kFunctions[draw(8)];
  return r_word(fn, fn == kFnMfhi || fn == kFnMflo ? reg() : 0, reg(), fn < kFnMfhi || fn >= kFnMult ? reg() : 0);
}

std::uint32_t Generator::any() {
  const unsigned kind = draw(100);
  if (kind < 35) return alu();
  if (kind < 65) return access();
  if (kind < 90) return floating();
  if (kind < 97) return multiplier();
  switch (draw(6)) {
    case 0:
      return r_word(kFnSyscall, 0, 0, 0);
    case 1:
      return r_word(kFnBreak, 0, 0, 0);
    case 2:
      return (kCop2 + draw(2)) << 26 | draw(1 << 26);
    case 3:
      return 31u << 26 | draw(1 << 26);
    default:
      return alu();
  }
}

/// Forward over at most six words, or over none.
void Generator::branch() {
  static constexpr std::uint32_t kMajors[] = {kMajorBeq, kMajorBne, kMajorBlez, kMajorBgtz};
  const unsigned over = draw(7);
  const auto here = base_ + static_cast<std::uint32_t>(4 * words_.size());
  const std::uint32_t target = here + 8 + 4 * over;
  const auto distance = static_cast<std::int32_t>(over) + 1;
  switch (draw(6)) {
    case 0:
      word(j_word(chance(50) ? kMajorJ : kMajorJal, target));
      break;
    case 1:
      word(i_word(kRegimm, (chance(30) ? 16 : 0) + draw(2), reg(), distance));
      break;
    case 2:
      word(cop_word(chance(20) ? 0 : 1, kBc, draw(2), 0) | static_cast<std::uint32_t>(distance));
      break;
    case 3:
      constant(kAt, target + 8);
      word(r_word(chance(50) ? kFnJr : kFnJalr, chance(80) ? 31 : 0, kAt, 0) & ~(chance(0) ? 1u : 0u));
      if ((words_.back() & 63) == kFnJr) words_.back() = r_word(kFnJr, 0, kAt, 0);
      break;
    default: {
      const std::uint32_t major = kMajors[draw(4)];
      word(i_word(major, major <= kMajorBne ? reg() : 0, reg(), distance));
    }
  }
  word(any());
  for (unsigned i = 0; i < over; ++i) word(any());
}

void Generator::loop() {
  const unsigned body = 1 + draw(30);
  word(i_word(kMajorAddiu, kLoop, 0, static_cast<std::int32_t>(1 + draw(12))));
  for (unsigned i = 0; i < body; ++i) word(any());
  word(i_word(kMajorAddiu, kLoop, kLoop, -1));
  word(i_word(kMajorBgtz, 0, kLoop, -static_cast<std::int32_t>(body) - 2));
  word(alu() & (chance(50) ? ~0u : 0u));
}

/// Coprocessor 0 where no word before may fault.
void Generator::system() {
  nops(3);
  switch (draw(4)) {
    case 0:
      word(mtc0(kMappedBase, kEntryHi));
      word(cp0_word(kFnTlbp));
      word(mfc0(reg(), kIndex));
      word(cp0_word(kFnTlbr));
      word(mfc0(reg(), kEntryLo));
      break;
    case 1:
      word(mfc0(reg(), draw(16)));
      word(mfc0(reg(), kRandom));
      break;
    case 2:
      constant(kAt, status_ ^ (chance(50) ? kStatusIec : kStatusCu1));
      word(mtc0(kAt, kStatus));
      for (unsigned i = 0; i < 5; ++i) word(chance(50) ? floating() : alu());
      constant(kAt, status_);
      nops(3);
      word(mtc0(kAt, kStatus));
      break;
    default:
      isolated();
  }
  nops(3);
}

void Generator::isolated() {
  constant(kAt, status_ | kStatusIsc | (chance(40) ? kStatusSwc : 0));
  word(mtc0(kAt, kStatus));
  constant(kAt, status_);
  for (unsigned i = 0; i < 4; ++i) {
    const std::uint32_t at = draw(1024);
    switch (draw(4)) {
      case 0:
        word(i_word(kMajorSw, reg(), chance(80) ? kCachedBase : kUncachedBase, static_cast<std::int32_t>(at & ~3u)));
        break;
      case 1:
        word(i_word(kMajorSb, reg(), kCachedBase, static_cast<std::int32_t>(at)));
        break;
      case 2:
        word(i_word(kMajorSwl, reg(), kCachedBase, static_cast<std::int32_t>(at)));
        break;
      default:
        word(i_word(kMajorLw, reg(), kCachedBase, static_cast<std::int32_t>(at & ~3u)));
    }
  }
  word(mtc0(kAt, kStatus));
}

void Generator::body(unsigned pieces) {
  for (unsigned i = 0; i < pieces; ++i) {
    const unsigned kind = draw(20);
    if (kind < 6)
      branch();
    else if (kind < 8)
      loop();
    else if (kind == 8 && system_words_)
      system();
    else
      for (unsigned n = draw(12); n != 0; --n) word(any());
  }
}

void Generator::prologue() {
  constant(kCachedBase, kDataArea);
  constant(kConflictBase, kDataArea + (1u << (10 + draw(4))) + 4 * draw(8));
  constant(kUncachedBase, kDataArea + 0x20000000);
  constant(kMappedBase, kMappedData);
  constant(kDeviceBase, 0xA0000000 + DENDRO_SERVICE_BASE);
  constant(kNothingBase, chance(50) ? 0x9C000000 : 0xBC000000);
  for (unsigned r = 2; r < 8; ++r) constant(r, chance(30) ? draw(64) : static_cast<std::uint32_t>(random_()));
  nops(2);
  word(mtc0(kAt, kStatus));
}

CornerProgram Generator::make() {
  // The page's frame is 0x100000 + the page; N for every other 32 KB. Global, valid, dirty.
  const std::vector<std::uint32_t> refill = {
      mfc0(kK1, kEntryHi),
      i_word(kMajorLui, kK0, 0, 0x0010),
      r_word(kFnOr, kK0, kK0, kK1),
      r_word(kFnSrl, kK0, 0, kK0, 12),
      r_word(kFnSll, kK0, 0, kK0, 12),
      i_word(kMajorAndi, kK1, kK1, static_cast<std::int32_t>(0x4000)),
      r_word(kFnSrl, kK1, 0, kK1, 3),
      r_word(kFnOr, kK0, kK0, kK1),
      i_word(kMajorOri, kK0, kK0, 0x700),
      mtc0(kK0, kEntryLo),
      mfc0(kK1, kEpc),
      cp0_word(kFnTlbwr),
      r_word(kFnJr, 0, kK1, 0),
      cp0_word(kFnRfe)};
  // Lets go of the R3010's line and goes on behind the word, or behind the branch's slot.
  const std::vector<std::uint32_t> general = {mfc0(kK0, kCause),
                                              mfc0(kK1, kEpc),
                                              cop_word(1, kCfc, kAt, 31),
                                              i_word(kMajorAndi, kAt, kAt, 3),
                                              cop_word(1, kCtc, kAt, 31),
                                              i_word(kRegimm, 1, kK0, 2),  // bgez
                                              i_word(kMajorAddiu, kK1, kK1, 4),
                                              i_word(kMajorAddiu, kK1, kK1, 4),
                                              r_word(kFnJr, 0, kK1, 0),
                                              cp0_word(kFnRfe)};
  system_words_ = chance(40);
  const unsigned where = draw(4);
  base_ = where == 0 ? kCodeFrame + 0xA0000000 : where == 1 ? kMappedCode : kCodeFrame + 0x80000000;
  base_ += 4 * draw(64) + (chance(20) ? 4096 - 256 : 0);
  status_ = kStatusCu1 | kStatusCu0 | (chance(60) ? kStatusIec | kStatusIm : 0);
  constant(kAt, status_);
  prologue();
  body(8 + draw(40));
  nops(4);
  word(i_word(kMajorSw, kCachedBase, kDeviceBase, DENDRO_SERVICE_CALL));
  nops(20);
  std::vector<std::uint32_t> data(8192);
  for (std::uint32_t& w : data) w = chance(30) ? 0x3F800000 + draw(1 << 24) : static_cast<std::uint32_t>(random_());
  return {{{0, refill}, {0x80, general}, {(base_ & 0x3FFFF) | 0x100000, words_}, {kDataArea & 0x1FFFFFFF, data}}, base_};
}

}  // namespace

Spec corner_spec(std::uint32_t seed) {
  std::mt19937 random(seed ^ 0x5EEDu);
  const auto draw = [&random](unsigned low, unsigned high) {
    return low + static_cast<unsigned>(random() % (high - low + 1));
  };
  Spec s;
  s.main_bytes = 4 << 20;
  s.clock_hz = 36e6;
  s.pipeline.multiply_cycles = draw(1, 14);
  s.pipeline.divide_cycles = draw(10, 40);
  s.pipeline.exception_cycles = draw(2, 5);
  s.fpu.add = draw(1, 4);
  s.fpu.compare = draw(1, 4);
  s.fpu.multiply_single = draw(1, 6);
  s.fpu.multiply_double = draw(2, 8);
  s.fpu.divide_single = draw(6, 14);
  s.fpu.divide_double = draw(10, 24);
  s.fpu.move = draw(1, 2);
  s.fpu.single_to_double = draw(1, 2);
  s.fpu.double_to_single = draw(1, 3);
  s.fpu.word_to_float = draw(2, 4);
  s.fpu.float_to_word = draw(2, 3);
  s.fpu.rounding = draw(0, 1);
  s.instruction_cache.size_bytes = 1024u << draw(0, 3);
  s.instruction_cache.refill_words = 4u << draw(0, 3);
  s.instruction_cache.streaming = draw(0, 2) != 0;
  s.data_cache.size_bytes = 1024u << draw(0, 3);
  s.data_cache.refill_words = 4u << draw(0, 3);
  s.data_cache.store_partial = draw(0, 2) != 0;
  s.data_cache.partial_store_cycles = draw(0, 3);
  s.bus.entries = draw(1, 6);
  s.bus.read_bypass = draw(0, 3) != 0;
  s.bus.first_word_cycles = draw(1, 21);
  s.bus.word_cycles = draw(1, 2);
  s.bus.write_cycles = draw(1, 9);
  s.bus.page_write_cycles = draw(1, 4);
  s.bus.page_bytes = 64u << draw(0, 6);
  return s;
}

CornerProgram corner_program(std::uint32_t seed) { return Generator(seed).make(); }

}  // namespace dendro::sgi_4d35
