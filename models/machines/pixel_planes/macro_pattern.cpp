#include "models/machines/pixel_planes/macro_pattern.h"

namespace dendro::pixel_planes {
namespace {

using igc::DataOp;
using igc::Function;
using igc::LoopCount;
using igc::Operand;
using igc::Source;
using Words = std::vector<igc::MicroWord>;

constexpr Operand k0 = Operand::kZero, k1 = Operand::kOne, kT = Operand::kTree, kK = Operand::kConstant,
                  kA = Operand::kPortA, kB = Operand::kPortB, kD = Operand::kData;

/// A word with chained parts, so that a pattern reads like the micro-program.
struct W : igc::MicroWord {
  explicit W(Function f = Function::kHold, Operand op_x = k0, Operand op_y = k0, DataOp op = DataOp::kHold) {
    function = f, x = op_x, y = op_y, data = op;
    tree = op_x == kT || op_y == kT || op == DataOp::kTree || op == DataOp::kOrTree;
  }
  W& at_a(Role role, bool bitwise = true) {
    register_a = role, indexed_a = bitwise;
    return *this;
  }
  W& at_b(Role role) {
    register_b = role, indexed_b = true;
    return *this;
  }
  W& read(Role role) {
    read_a = true;
    return at_a(role);
  }
  W& read2(Role role) {
    read_b = true;
    return at_b(role);
  }
  W& flag() {  // bit 0 of field 1
    read_a = true;
    return at_a(kField1, false);
  }
  W& write(Role role, Source from, bool bitwise = true) {
    write_a = true, source = from;
    return at_a(role, bitwise);
  }
  W& write2(Role role, Source from) {
    write_b = true, source = from;
    return at_b(role);
  }
  W& offset(unsigned bits) {
    constant_offset = static_cast<std::uint8_t>(bits);
    return *this;
  }
  Words loop(LoopCount count, unsigned number = 0) const { return loop_of({*this}, count, number); }
  Words bits() const { return loop(LoopCount::kRegister, kBits); }

  static Words loop_of(Words words, LoopCount count, unsigned number = 0) {
    for (igc::MicroWord& w : words) w.loop = count, w.loop_number = static_cast<std::uint8_t>(number);
    words.back().loop_end = true;
    return words;
  }
};

Words join(std::initializer_list<Words> parts) {
  Words all;
  for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Words one(const W& word) { return {word}; }
Words start() { return one(W(Function::kSetEnable)); }
Words gate() { return one(W(Function::kAndCarry)); }
Words clear_carry(DataOp data = DataOp::kHold) { return one(W(Function::kLoad, k0, k0, data)); }

W pass() {
  W w;
  w.tree = true;
  return w;
}

Words skip() {
  Words words = pass().loop(LoopCount::kGap);
  for (const igc::MicroWord& w : pass().loop(LoopCount::kFraction)) words.push_back(w);
  return words;
}

/// Carry := field 0 < T, data := T beyond the range.
Words compare_raise(const W& word) {
  return join({start(), clear_carry(DataOp::kClear), skip(), word.bits(),
               W(Function::kBorrow, k0, kT, DataOp::kOrTree).loop(LoopCount::kGuardLessOne),
               one(W(Function::kBorrow, kT, k0)), gate()});
}

/// Carry := T < field 0, data := T negative.
Words compare_lower(const W& word) {
  return join({start(), clear_carry(), skip(), word.bits(),
               W(Function::kBorrow, kT, k0).loop(LoopCount::kGuardLessOne),
               one(W(Function::kBorrow, k0, kT, DataOp::kTree)), gate()});
}

W raising() { return W(Function::kBorrow, kA, kT).read(kField0); }
W lowering() { return W(Function::kBorrow, kT, kA).read(kField0); }

/// The second stream: field 0 := T with the data register, where enabled.
Words store(Source source) {
  W w(Function::kHold, kT);
  w.write(kField0, source);
  return join({skip(), w.bits(), pass().loop(LoopCount::kGuard)});
}

/// Field 0 := field 1 with the data register, where enabled.
Words store_scratch(Source source) {
  W w(Function::kHold, kB);
  w.write(kField0, source).read2(kField1);
  return w.bits();
}

Words two_streams(const Words& compare, Source source) {
  return join({compare, store(source)});
}

Words finish(const W& less_back, const W& less_nearest, const Words& copy) {
  const auto compare = [](const W& word) {
    if (word.read_b) return word.bits();
    W load(Function::kHold, k0, k0, DataOp::kPortA);
    load.read(kField0);
    return W::loop_of({load, word}, LoopCount::kRegister, kBits);
  };
  W flag;
  flag.write(kField1, Source::kSum, false);
  return join({start(), clear_carry(), compare(less_back), one(flag), gate(), clear_carry(), compare(less_nearest),
               one(flag), gate(), copy});
}

Words finish_one_port() {
  W load(Function::kHold, k0, k0, DataOp::kPortA), save(Function::kHold, kD);
  load.read(kField0);
  save.write(kField2, Source::kX);
  return finish(W(Function::kBorrow, kD, kA).read(kField1), W(Function::kBorrow, kD, kA).read(kField2),
                W::loop_of({load, save}, LoopCount::kRegister, kBits));
}

Words finish_two_ports() {
  W copy(Function::kHold, kB);
  copy.write(kField2, Source::kX).read2(kField0);
  return finish(W(Function::kBorrow, kA, kB).read(kField0).read2(kField1),
                W(Function::kBorrow, kA, kB).read(kField0).read2(kField2), copy.bits());
}

Words constant_to(Role role, unsigned bits, unsigned offset = 0) {
  W w(Function::kHold, kK);
  w.write(role, Source::kX).offset(offset);
  return w.loop(LoopCount::kNumber, bits);
}

Words flagged() { return join({start(), one(W(Function::kLoad, kA).flag())}); }

Words kill() {
  W zero;
  zero.write(kField0, Source::kX);
  return join({start(), skip(), W(Function::kLoad, kT).loop(LoopCount::kGuard), gate(), zero.bits()});
}

Words close_open() {
  W zero;
  zero.write(kField0, Source::kX);
  return join({start(), one(W(Function::kLoad, k1)), W(Function::kCarry, kA, k0).read(kField0).bits(), gate(), zero.bits()});
}

Words match_paint() {
  return join({flagged(), skip(), W(Function::kEqual, kT, kA).read(kField0).bits(),
               W(Function::kEqual, kT, k0).loop(LoopCount::kGuard), gate(), constant_to(kField2, 24)});
}

Words paint_index() {
  return join({flagged(), W(Function::kEqual, kK, kA).read(kField0).loop(LoopCount::kNumber, 12), gate(),
               constant_to(kField2, 24, 12)});
}

Words sign_first() {
  W flag(Function::kHold, k1);
  flag.write(kField1, Source::kSum, false);
  return join({start(), skip(), W(Function::kLoad, kT).loop(LoopCount::kGuard), one(flag)});
}

Words sign() {
  W flag(Function::kHold, kA);
  flag.flag().write(kField1, Source::kXAndNotData, false);
  return join({start(), skip(), W(Function::kHold, k0, k0, DataOp::kTree).loop(LoopCount::kGuard), one(flag)});
}

std::vector<Pattern> make_patterns() {
  const Words raise = two_streams(compare_raise(raising()), Source::kXOrData);
  const Words lower = two_streams(compare_lower(lowering()), Source::kXAndNotData);
  W raise_copy = raising(), lower_copy = lowering();
  raise_copy.write2(kField1, Source::kTree), lower_copy.write2(kField1, Source::kX);
  std::vector<Pattern> list = {
      {MacroKind::kRaise, {0}, true, raise},
      {MacroKind::kLower, {0}, true, lower},
      {MacroKind::kRaiseScratch, {0, 0}, true,
       join({compare_raise(raise_copy), store_scratch(Source::kXOrData)})},
      {MacroKind::kLowerScratch, {0, 0}, true,
       join({compare_lower(lower_copy), store_scratch(Source::kXAndNotData)})},
      {MacroKind::kKill, {0}, true, kill()},
      {MacroKind::kCloseOpen, {0}, false, close_open()},
      {MacroKind::kFinish, {0, 0, 0}, false, finish_one_port()},
      {MacroKind::kFinish, {0, 0, 0}, false, finish_two_ports()},
      {MacroKind::kMatchPaint, {0, kFlag, 24}, true, match_paint()},
      {MacroKind::kPaint, {kNone, kFlag, 24}, false, join({flagged(), gate(), constant_to(kField2, 24)})},
      {MacroKind::kRaiseIndex, {0, 12}, true, join({raise, constant_to(kField1, 12)})},
      {MacroKind::kSignFirst, {kNone, kFlag}, true, sign_first()},
      {MacroKind::kSign, {kNone, kFlag}, true, sign()},
      {MacroKind::kPaintIndex, {12, kFlag, 24}, false, paint_index()},
  };
  for (Pattern& pattern : list) pattern.words.back().end = true;
  return list;
}

}  // namespace

const std::vector<Pattern>& patterns() {
  static const std::vector<Pattern> list = make_patterns();
  return list;
}

}  // namespace dendro::pixel_planes
