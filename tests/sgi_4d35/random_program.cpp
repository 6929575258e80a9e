#include "tests/sgi_4d35/random_program.h"

#include <algorithm>
#include <random>

#include "models/parts/r3000/r3000_decode.h"

namespace dendro::sgi_4d35 {
namespace {

using r3000::cop_word;
using r3000::i_word;
using r3000::r_word;

/// Registers of three values of Status, which nothing else writes: a word that changes the mode behind one
/// that faults would change the fetch of the next in a way that is not defined.
constexpr unsigned kStatuses = 28;
constexpr unsigned kPasses = 23, kFirstPointer = 16, kPointers = 6;
constexpr std::uint32_t kBody = 0x80010800;

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  Words code(unsigned words, unsigned passes) {
    setup(passes);
    const std::size_t loop = code_.size();
    end_ = loop + words;
    while (code_.size() < end_) {
      push(word());
      // A branch in a slot is not defined, and the core without time takes it for granted where its loads
      // land.
      if (is_branch(r3000::decode(code_.back()).op)) push(below(2) ? alu() : access());
    }
    push(kNop), push(kNop);
    push(add_immediate(kPasses, kPasses, -1));
    push(i_word(r3000::kMajorBne, 0, kPasses, static_cast<int>(loop) - static_cast<int>(code_.size()) - 1));
    push(kNop);
    push(high(kService, 0xBF00));
    push(store(0, kService));
    for (int i = 0; i < 3; ++i) push(kNop);
    return code_;
  }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  void push(std::uint32_t word) { code_.push_back(word); }
  unsigned reg() { return below(8) == 0 ? 0 : 1 + below(15); }
  unsigned pointer() { return kFirstPointer + below(kPointers); }
  unsigned fpr() { return below(12); }
  /// The branch's distance to a word further down, mostly near.
  int forward() {
    const auto left = static_cast<unsigned>(end_ - code_.size());
    return static_cast<int>(1 + below(std::min(left, below(4) ? 6u : 40u)));
  }

  void set(unsigned to, std::uint32_t value) {
    push(high(to, static_cast<int>(value >> 16)));
    push(or_immediate(to, to, static_cast<int>(value & 0xFFFF)));
  }

  void setup(unsigned passes) {
    // Cached, the same index, uncached, mapped twice (the second page past the caches), nothing there.
    constexpr std::uint32_t kTargets[kPointers] = {0x80020000, 0x80030000, 0xA0020000,
                                                   0x00100000, 0x00112000, 0xBE000000};
    for (unsigned i = 0; i < kPointers; ++i) set(kFirstPointer + i, kTargets[i]);
    set(8, 0x2000FF01u ^ (below(2) ? 0 : 1));  // interrupts allowed or not
    push(to_cp0(8, r3000::kStatus));
    set(kStatuses, 0x2000FF01), set(kStatuses + 1, 0x2000FF00), set(kStatuses + 2, 0xFF01);
    for (unsigned r = 1; r < 16; ++r) set(r, below(3) ? static_cast<std::uint32_t>(random_()) : below(20));
    for (unsigned f = 0; f < 12; ++f) push(cop_word(1, r3000::kMtc, 1 + below(15), f));
    for (unsigned f = 0; f < 12; f += 2 + below(2))  // some that are ordinary numbers
      push(high(1, 0x3F00 + static_cast<int>(below(0x200)))), push(cop_word(1, r3000::kMtc, 1, f));
    push(add_immediate(kPasses, 0, static_cast<int>(passes)));
  }

  std::uint32_t word() {
    const unsigned kind = below(100);
    if (kind < 25) return alu();
    if (kind < 45) return access();
    if (kind < 52) return multiplier();
    if (kind < 72) return floating();
    if (kind < 82) return fp_move();
    if (kind < 93) return branch();
    return kind < 98 ? cp0() : exception();
  }

  std::uint32_t alu() {
    static constexpr std::uint32_t kFunctions[] = {
        r3000::kFnSll, r3000::kFnSrl,  r3000::kFnSra, r3000::kFnSllv, r3000::kFnSrlv, r3000::kFnSrav,
        r3000::kFnAdd, r3000::kFnAddu, r3000::kFnSub, r3000::kFnSubu, r3000::kFnAnd,  r3000::kFnOr,
        r3000::kFnXor, r3000::kFnNor,  r3000::kFnSlt, r3000::kFnSltu};
    if (below(2)) return r_word(kFunctions[below(16)], reg(), reg(), reg(), below(32));
    return i_word(r3000::kMajorAddi + below(8), reg(), reg(), static_cast<int>(below(65536)) - 32768);
  }

  std::uint32_t access() {
    static constexpr std::uint32_t kMajors[] = {
        r3000::kMajorLb,  r3000::kMajorLbu, r3000::kMajorLh,  r3000::kMajorLhu,
        r3000::kMajorLw,  r3000::kMajorLw,  r3000::kMajorLw,  r3000::kMajorLwl,
        r3000::kMajorLwr, r3000::kMajorSb,  r3000::kMajorSh,  r3000::kMajorSw,
        r3000::kMajorSw,  r3000::kMajorSw,  r3000::kMajorSwl, r3000::kMajorSwr};
    static constexpr unsigned kSizes[] = {1, 1, 2, 2, 4, 4, 4, 1, 1, 1, 2, 4, 4, 4, 1, 1};
    const unsigned which = below(16);
    unsigned base = pointer();
    if (base == kFirstPointer + kPointers - 1 && below(4)) base = kFirstPointer;
    const unsigned at = below(below(4) ? 64 : 16384), size = below(40) ? kSizes[which] : 1;
    return i_word(kMajors[which], reg(), base, static_cast<int>(at / size * size));
  }

  std::uint32_t multiplier() {
    static constexpr std::uint32_t kFunctions[] = {r3000::kFnMult, r3000::kFnMultu, r3000::kFnDiv,
                                                   r3000::kFnDivu, r3000::kFnMthi,  r3000::kFnMtlo};
    const unsigned which = below(14);
    if (which >= 6) return r_word(which & 1 ? r3000::kFnMfhi : r3000::kFnMflo, reg(), 0, 0);
    return r_word(kFunctions[which], 0, reg(), which < 4 ? reg() : 0);
  }

  std::uint32_t floating() {
    static constexpr unsigned kOperations[] = {
        r3010::kAdd, r3010::kAdd, r3010::kSub,  r3010::kMul,  r3010::kMul,  r3010::kDiv,     r3010::kAbs,
        r3010::kMov, r3010::kNeg, r3010::kCvtS, r3010::kCvtD, r3010::kCvtW, r3010::kCompare, 4};
    static constexpr r3010::Format kFormats[] = {r3010::kSingle, r3010::kSingle, r3010::kDouble,
                                                 r3010::kWord};
    unsigned operation = kOperations[below(below(20) ? 13 : 14)];
    auto format = kFormats[below(operation == r3010::kCvtS || operation == r3010::kCvtD ? 4 : 3)];
    if (operation == r3010::kCompare) operation += below(16);
    return r3010::fp_word(format, operation, fpr(), fpr(), fpr());
  }

  std::uint32_t fp_move() {
    switch (below(10)) {
      case 0:
        return cop_word(1, r3000::kCfc, reg(), 31);
      case 1:  // rounding, enables; sometimes an exception at once
        push(i_word(r3000::kMajorOri, 15, 0, static_cast<int>(below(8) ? below(4) : below(0x10000))));
        return cop_word(1, r3000::kCtc, 15, 31);
      case 2:
      case 3:
        return cop_word(1, r3000::kMfc, reg(), fpr());
      case 4:
      case 5:
        return cop_word(1, r3000::kMtc, reg(), fpr());
      default:
        return i_word(below(2) ? r3000::kMajorLwc1 : r3000::kMajorSwc1, fpr(),
                      kFirstPointer + below(kPointers - 1), static_cast<int>(4 * below(16)));
    }
  }

  std::uint32_t branch() {
    switch (below(9)) {
      case 0:
        return r3000::j_word(r3000::kMajorJ, here() + 4 + 4 * static_cast<std::uint32_t>(forward()));
      case 1:
        return r3000::j_word(r3000::kMajorJal, here() + 4 + 4 * static_cast<std::uint32_t>(forward()));
      case 2: {
        const std::uint32_t target = here() + 12 + 4 * static_cast<std::uint32_t>(forward());
        set(24, target);
        return below(2) ? r_word(r3000::kFnJr, 0, 24, 0) : r_word(r3000::kFnJalr, reg(), 24, 0);
      }
      case 3:
        return i_word(r3000::kRegimm, below(2) + 16 * below(2), reg(), forward());
      case 4:
        return i_word(r3000::kCop1, below(2), r3000::kBc, forward());
      case 5:
        return i_word(r3000::kMajorBlez + below(2), 0, reg(), forward());
      default:
        return i_word(r3000::kMajorBeq + below(2), below(2) ? 0 : reg(), reg(), forward());
    }
  }

  std::uint32_t cp0() {
    static constexpr unsigned kReadable[] = {r3000::kRandom,   r3000::kStatus, r3000::kCause,
                                             r3000::kEpc,      r3000::kIndex,  r3000::kEntryHi,
                                             r3000::kBadVAddr, r3000::kContext};
    switch (below(8)) {
      case 0:  // a software interrupt
        push(i_word(r3000::kMajorOri, 15, 0, static_cast<int>(below(4) << 8)));
        return to_cp0(15, r3000::kCause);
      case 1:  // with the floating-point unit or without, interrupts or not
        return to_cp0(kStatuses + below(3), r3000::kStatus);
      case 2:
        return r3000::cp0_word(r3000::kFnTlbp);
      default:
        return from_cp0(reg(), kReadable[below(8)]);
    }
  }

  std::uint32_t exception() {
    switch (below(5)) {
      case 0:
        return syscall();
      case 1:
        return r3000::kFnBreak;
      case 2:
        return 0x7C000000;  // no MIPS I
      case 3:
        return 18u << 26;  // coprocessor 2
      default:
        return load(reg(), kFirstPointer + kPointers - 1);  // nothing there
    }
  }

  std::uint32_t here() const { return kBody + static_cast<std::uint32_t>(4 * code_.size()); }

  std::mt19937 random_;
  Words code_;
  std::size_t end_ = 0;
};

/// Skips the word, or the branch and its slot; silences the interrupts that programs raise, gives the R3010
/// back.
Words skipping_handler() {
  const std::uint32_t enable = r_word(r3000::kFnOr, kK1, kK1, kK0);
  return {from_cp0(kK1, r3000::kStatus),
          high(kK0, 0x2000),
          enable,
          to_cp0(kK1, r3000::kStatus),
          cop_word(1, r3000::kCtc, 0, 31),
          to_cp0(0, r3000::kCause),
          from_cp0(kK0, r3000::kEpc),
          from_cp0(kK1, r3000::kCause),
          add_immediate(kK0, kK0, 4),
          i_word(r3000::kRegimm, 1, kK1, 2),
          kNop,
          add_immediate(kK0, kK0, 4),
          r_word(r3000::kFnJr, 0, kK0, 0),
          r3000::cp0_word(r3000::kFnRfe)};
}

/// Sixteen pages from physical 0x40000 on; of every second 64 KB they are past the caches.
Words refill_handler() {
  return {from_cp0(kK0, r3000::kEntryHi),
          high(kK1, 0x0004),
          i_word(r3000::kMajorAndi, 25, kK0, 0xF000),
          r_word(r3000::kFnOr, kK1, kK1, 25),
          r_word(r3000::kFnSrl, kK0, 0, kK0, 5),
          i_word(r3000::kMajorAndi, kK0, kK0, 0x800),
          r_word(r3000::kFnOr, kK1, kK1, kK0),
          or_immediate(kK1, kK1, 0x700),
          to_cp0(kK1, r3000::kEntryLo),
          from_cp0(kK0, r3000::kEpc),
          r3000::cp0_word(r3000::kFnTlbwr),
          r_word(r3000::kFnJr, 0, kK0, 0),
          r3000::cp0_word(r3000::kFnRfe)};
}

}  // namespace

Memory random_program(std::uint32_t seed, unsigned words, unsigned passes) {
  Memory memory;
  memory[kBody] = Generator(seed).code(words, passes);
  memory[r3000::kGeneralVector] = skipping_handler();
  memory[r3000::kUtlbVector] = refill_handler();
  return memory;
}

Spec random_spec(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto in = [&random](unsigned low, unsigned high) {
    return low + static_cast<unsigned>(random() % (high - low + 1));
  };
  Spec s = small();
  s.pipeline = {in(1, 14), in(1, 36), in(2, 5)};
  s.fpu = {in(1, 3), in(1, 3), in(1, 5), in(1, 6), in(1, 13), in(1, 20),
           in(1, 2), in(1, 2), in(1, 2), in(1, 4), in(1, 3),  in(0, 1)};
  s.instruction_cache.size_bytes = 1024u << in(0, 6);
  s.data_cache.size_bytes = 1024u << in(0, 6);
  s.instruction_cache.refill_words = 1u << in(0, 5);
  s.data_cache.refill_words = 1u << in(0, 5);
  s.instruction_cache.streaming = in(0, 3) != 0;
  s.data_cache.store_partial = in(0, 2) != 0;
  s.data_cache.partial_store_cycles = in(0, 3);
  s.bus = {in(1, 6), in(0, 2) != 0, in(1, 12), in(1, 3), in(1, 8), in(1, 5), 1024u << in(0, 2)};
  return s;
}

}  // namespace dendro::sgi_4d35
