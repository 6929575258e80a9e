#include "firmware/tools/gia_word.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/tools/source_error.h"
#include "sim/base/check.h"

namespace dendro::tools {

using namespace bps32;

struct WordBuilder::Choice {
  unsigned func;
  const Operand* r;
  const Operand* s;
};

namespace {

constexpr std::int64_t kImmMin = -2048, kImmMax = 2047;

bool fits_imm(std::int32_t v) { return v >= kImmMin && v <= kImmMax; }

bool same_source(const Operand& a, const Operand& b) {
  return a.dsrc == b.dsrc && a.lane == b.lane && a.uses_imm == b.uses_imm && a.value == b.value &&
         a.fixup == b.fixup;
}

}  // namespace

void WordBuilder::fail(const Token& at, const std::string& message) const {
  throw SourceError(file_, at.line, at.column, message);
}

void WordBuilder::set(const Field& field, unsigned value, const Token& at) {
  const std::uint64_t mask = put(0, field, ~0u);
  if (set_ & mask) fail(at, fmt::format("two writers of the field '{}' in one word", field.name));
  set_ |= mask;
  micro_.word = put(micro_.word, field, value);
}

void WordBuilder::set_imm(std::int64_t value, const Fixup& fixup, const Token& at, const std::string& use) {
  const auto bits = static_cast<unsigned>(value) & 0xFFFu;
  if (imm_used_ && !(micro_.imm == fixup && get(micro_.word, kImm) == bits)) {
    fail(at, fmt::format("two different uses of the imm field in one word: {} and {}", imm_use_, use));
  }
  imm_used_ = true;
  imm_use_ = use;
  micro_.imm = fixup;
  micro_.word = put(micro_.word, kImm, bits);
}

void WordBuilder::set_sequencer(unsigned op, unsigned cond, bool inverted, const Token& at) {
  set(kSeq, op, at);
  set(kCond, cond, at);
  set(kPol, inverted ? 1 : 0, at);
}

void WordBuilder::set_alu(const Expression& expression, const Destinations& destinations, const Token& at) {
  if (has_alu_) {
    fail(at,
         "two writers of the field 'func': one word has one ALU operation (a = b = x writes several places)");
  }
  has_alu_ = true;
  e_ = expression;
  d_ = destinations;
  micro_.old_product = expression.old_product;
}

void WordBuilder::set_q_shift(bool left, unsigned fill, const Token& at) {
  if (q_shift_) fail(at, "two writers of Q in one word");
  q_shift_ = true;
  q_left_ = left;
  q_fill_ = fill;
  q_at_ = at;
}

Micro WordBuilder::finish() {
  if (has_alu_ || q_shift_) encode_alu();
  return micro_;
}

void WordBuilder::encode_alu() {
  if (d_.pair && e_.op != Expression::kSpecialFunction && e_.shift != Expression::kRight &&
      e_.shift != Expression::kLeft) {
    fail(d_.at, "'register:q' takes a shifted result or a special function");
  }
  encode_destination();
  if (has_alu_) encode_operands();
  if (d_.ydst >= 0) {
    set(kYdst, static_cast<unsigned>(d_.ydst), d_.y_at);
    if (d_.ydst == kYSpad) set_imm(d_.scratch, {}, d_.y_at, "the scratch address of the result");
  }
}

void WordBuilder::encode_destination() {
  if (q_shift_ && has_alu_ && (d_.reg >= 0 || d_.q)) {
    fail(q_at_, "beside the shift of q the ALU's result cannot go to a register or q");
  }
  unsigned dest = kYOnly;
  if (e_.op == Expression::kSpecialFunction && has_alu_) {
    dest = e_.special;
    const bool writes_q = dest != 4 && dest != 5;
    if (d_.reg < 0 || d_.q || d_.pair != writes_q) {
      fail(e_.at, writes_q ? "this special function writes 'register:q'"
                           : "this special function writes a register");
    }
    if (q_shift_) fail(q_at_, "a special function leaves no shift of q");
  } else if (e_.shift != Expression::kNoShift && has_alu_) {
    if (d_.reg < 0) fail(e_.at, "a shifted result is always written to a register");
    if (d_.q) fail(e_.at, "q cannot take the shifted result: write register:q to shift both");
    const unsigned left = e_.shift == Expression::kLeft ? 8 : 0;
    const unsigned logic = e_.keep_sign ? 0 : 1;
    dest = e_.shift == Expression::kSpread ? unsigned{kSignExtend} : left + (d_.pair ? 2 : 0) + logic;
  } else {
    if (d_.reg >= 0) dest = d_.q ? kRamQ : kRam;
    if (d_.reg < 0 && d_.q) dest = kQ;
    if (q_shift_) dest = q_left_ ? kQLeft : kQRight;
  }
  const Token& at = has_alu_ ? e_.at : q_at_;
  set(kDest, dest, at);
  set(kFill, q_shift_ ? q_fill_ : e_.fill, at);
  if (d_.reg >= 0) set(kB, static_cast<unsigned>(d_.reg), at);
}

/// A constant goes over the D bus: as imm, as turned imm, or from the constant pool.
void WordBuilder::to_bus(Operand& o) {
  if (o.kind != Operand::kConstant) return;
  const auto value = static_cast<std::uint32_t>(o.value);
  o.kind = Operand::kD;
  if (value == 0) {
    o.dsrc = kDNone;
    return;
  }
  o.uses_imm = true;
  for (unsigned lane = 0; lane < 4; ++lane) {
    const auto turned = static_cast<std::int32_t>(base::rotate_right(value, (32 - 8 * lane) % 32));
    if (!fits_imm(turned)) continue;
    o.dsrc = kDImm;
    o.lane = lane;
    o.value = turned;
    return;
  }
  o.dsrc = kDSpad;
  o.value = 0;
  auto& pool = program_.pool;
  const auto it = std::find(pool.begin(), pool.end(), value);
  o.fixup.kind = Fixup::kPool;
  o.fixup.index = static_cast<int>(it - pool.begin());
  if (it == pool.end()) pool.push_back(value);
}

void WordBuilder::use_bus(const Operand& o) {
  micro_.word = put(micro_.word, kDsrc, o.dsrc);
  micro_.word = put(micro_.word, kLane, o.lane);
  if (o.uses_imm) {
    set_imm(o.value, o.fixup, o.at,
            o.dsrc == kDSpad ? "a scratch address of an operand" : "an immediate operand");
  }
}

bool WordBuilder::try_pair(const Operand* r, const Operand* s, unsigned func) {
  if (r && r->kind == Operand::kQ) return false;
  const bool s_ram = s && s->kind == Operand::kRegister;
  if (s_ram && d_.reg >= 0 && static_cast<int>(s->reg) != d_.reg) return false;
  const bool r_bus = r && r->kind == Operand::kD;
  const bool s_bus = s && s->kind == Operand::kD;
  if (r_bus && s_bus && !same_source(*r, *s)) return false;
  std::uint64_t& w = micro_.word;
  w = put(w, kFunc, func);
  if (r && !r_bus) w = put(w, kA, r->reg);
  if (s_ram) w = put(w, kB, s->reg);
  w = put(w, kEa, r_bus ? 1 : 0);
  w = put(w, kOeb, s_bus ? 1 : 0);
  w = put(w, kI0, s && s->kind == Operand::kQ ? 1 : 0);
  if (r_bus) use_bus(*r);
  if (s_bus && !r_bus) use_bus(*s);
  return true;
}

bool WordBuilder::try_choices(const Choice* choices, int count) {
  for (int i = 0; i < count; ++i) {
    if (try_pair(choices[i].r, choices[i].s, choices[i].func)) return true;
  }
  return false;
}

void WordBuilder::explain(const Choice* choices, int count) const {
  const Operand& x = *choices[0].r;
  const Operand& y = *choices[0].s;
  if (x.kind == Operand::kD && y.kind == Operand::kD) {
    fail(x.at, "both operands come over the D bus: a word has one D source (put one into a register first)");
  }
  if (x.kind == Operand::kQ && y.kind == Operand::kQ) fail(x.at, "q cannot be both operands");
  if (x.kind == Operand::kQ || y.kind == Operand::kQ) {
    fail(x.at, "q is the S operand only, and here the operation needs it as R");
  }
  if (count == 1) {
    fail(y.at,
         "the operand S (second of ~r & s, first of a special function) must be the register that is "
         "written: both are field B");
  }
  fail(x.at,
       "of two register operands one must be the register that is written: field B is both S and destination "
       "(copy one first, or write x = x op y)");
}

void WordBuilder::encode_operands() {
  set(kFunc, kFZero, e_.at);
  set(kCarry, e_.carry, e_.at);
  if (e_.op != Expression::kFixedZero && e_.op != Expression::kFixedOnes) to_bus(e_.x);
  const Operand* x = &e_.x;
  to_bus(e_.y);
  const Operand* y = &e_.y;
  const bool binary = e_.op >= Expression::kAdd;
  if (binary) micro_.old_product = e_.old_product;
  switch (e_.op) {
    case Expression::kFixedZero:
      return;
    case Expression::kFixedOnes:
      micro_.word = put(put(micro_.word, kFunc, kSpecial), kI0, 1);
      return;
    case Expression::kPassOne:
    case Expression::kInvert: {
      const bool pass = e_.op == Expression::kPassOne;
      const unsigned on_s = pass ? kPassS : kNotS;
      const unsigned on_r = pass ? kPassR : kNotR;
      const Choice bus_first[] = {{on_r, x, nullptr}, {on_s, nullptr, x}};
      const Choice ram_first[] = {{on_s, nullptr, x}, {on_r, x, nullptr}};
      DENDRO_CHECK(try_choices(x->kind == Operand::kD ? bus_first : ram_first, 2),
                   "a single operand always fits");
      return;
    }
    case Expression::kAdd:
    case Expression::kLogic: {
      const unsigned func = e_.op == Expression::kAdd ? unsigned{kRPlusS} : e_.func;
      const Choice choices[] = {{func, y, x}, {func, x, y}};
      if (!try_choices(choices, 2)) explain(choices, 2);
      return;
    }
    case Expression::kSubtract: {
      const Choice choices[] = {{kSMinusR, y, x}, {kRMinusS, x, y}};
      if (!try_choices(choices, 2)) explain(choices, 2);
      return;
    }
    case Expression::kAndNot: {
      const Choice choices[] = {{kNotRAndS, x, y}};
      if (!try_choices(choices, 1)) explain(choices, 1);
      return;
    }
    case Expression::kSpecialFunction: {
      if (x->kind == Operand::kQ || y->kind == Operand::kQ) {
        fail(x->at, "q is no operand of a special function: its S and R are registers or the D bus");
      }
      // One-operand functions leave R unused: field A stays 0.
      const bool one = e_.special == 4 || e_.special == 5 || e_.special == 8;
      const Choice choices[] = {{kSpecial, one ? nullptr : y, x}};
      if (!try_choices(choices, 1)) {
        const Choice both[] = {{kSpecial, y, x}};
        explain(both, 1);
      }
      return;
    }
  }
}

}  // namespace dendro::tools
