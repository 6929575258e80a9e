#include "firmware/tools/gia_statement.h"

#include <fmt/format.h>

#include <optional>

namespace dendro::tools {
namespace {

using namespace bps32;

struct FunctionName {
  std::string_view name;
  BusFunction code;
};
constexpr FunctionName kFunctions[] = {
    {"word", kFnWord},          {"lores", kFnLores},          {"hires", kFnHires},
    {"mask_word", kFnMaskWord}, {"mask_lores", kFnMaskLores}, {"mask_hires", kFnMaskHires}};

constexpr std::string_view kSequencerWords[] = {"goto", "call", "return"};

bool is_sequencer_op(const Token& t) {
  for (const std::string_view w : kSequencerWords) {
    if (t.is(w)) return true;
  }
  for (const char* op : am2910::kOpNames) {
    if (t.is(op)) return true;
  }
  return false;
}

unsigned sequencer_code(const Token& t) {
  if (t.is("goto")) return am2910::kCJP;
  if (t.is("call")) return am2910::kCJS;
  if (t.is("return")) return am2910::kCRTN;
  unsigned op = 0;
  while (!t.is(am2910::kOpNames[op])) ++op;
  return op;
}

class Statement {
 public:
  Statement(TokenCursor& cursor, const Symbols& symbols, Program& program, const LabelLookup& label)
      : cursor_(cursor), symbols_(symbols), label_(label), word_(cursor.file(), program) {
    word_.micro().line = cursor.peek().line;
    word_.micro().column = cursor.peek().column;
  }

  Micro parse() {
    do {
      part();
    } while (cursor_.accept(","));
    if (!cursor_.accept(";")) cursor_.fail("',' or ';' is missing before " + shown(cursor_.peek()));
    return finish();
  }

  Micro parse_count() {
    const Token at = cursor_.peek();
    if (symbols_.constant_ahead(cursor_)) {
      const std::int64_t n = symbols_.expression(cursor_);
      if (n < 1 || n > 4096) cursor_.fail(at, fmt::format("a loop runs 1 to 4096 times, not {}", n));
      word_.set_sequencer(am2910::kLDCT, kAlways, false, at);
      word_.set_imm(n - 1, {}, at, "the loop count");
      return word_.finish();
    }
    const Token name = cursor_.peek();
    Expression e = parse_expression(cursor_, symbols_, label_);
    const bool plain =
        e.op == Expression::kPassOne && e.shift == Expression::kNoShift && e.carry == kCarryZero;
    if (!plain || e.x.kind == Operand::kD) {
      cursor_.fail(name, "a loop count is a constant, a register or q");
    }
    e.op = Expression::kSubtract;
    e.y = Operand{};
    e.y.at = name;
    e.carry = kCarryZero;
    Destinations d;
    d.ydst = kYSeq;
    d.at = d.y_at = name;
    word_.set_alu(e, d, name);
    word_.set_sequencer(am2910::kLDCT, kAlways, false, name);
    return word_.finish();
  }

 private:
  Micro finish() {
    Micro m = word_.finish();
    if (m.verbatim) return m;
    const unsigned cond = get(m.word, kCond);
    if (uses_condition(m.word) && tests_flags(cond) && latches_flags(m.word) && !m.old_condition) {
      cursor_.fail(condition_at_,
                   fmt::format("'{0}' is read before it is latched: this word latches the flags at its end "
                               "and tests those before it (old({0}) if that is meant)",
                               kCondNames[cond]));
    }
    if (y_input_ && get(m.word, kYdst) != kYSeq) {
      cursor_.fail(y_at_, "'seq' is the sequencer's input from the ALU: write seq = ... in the same word");
    }
    if (!y_input_ && get(m.word, kYdst) == kYSeq && imm_target_) {
      cursor_.fail(y_at_, "with seq = ... the sequencer takes the ALU's result: the operand is seq");
    }
    return m;
  }

  void part() {
    const Token t = cursor_.peek();
    if (t.kind == Token::kEnd) cursor_.fail("a statement is missing");
    if (t.is("if")) {
      cursor_.take();
      cursor_.expect("(", "after if");
      const Condition c = parse_condition(cursor_);
      cursor_.expect(")", "after the condition");
      return sequencer(c);
    }
    if (is_sequencer_op(t)) return sequencer({});
    if (t.is("loop")) return sequencer({});
    if (t.is("read") || t.is("write")) return bus_operation();
    if (t.is("mul")) return multiply();
    if (t.is("word")) return verbatim();
    if (t.is("nop") || t.is("halt") || t.is("flags")) {
      cursor_.take();
      if (t.is("halt")) word_.set(kHalt, 1, t);
      if (t.is("flags")) word_.set(kLatch, 1, t);
      return;
    }
    transfer();
  }

  void sequencer(const Condition& c) {
    const Token t = cursor_.take();
    if (!is_sequencer_op(t))
      cursor_.fail(t, "a sequencer operation is missing: " + shown(t) + " stands here");
    const unsigned op = sequencer_code(t);
    condition_at_ = c.at;
    bool inverted = c.inverted;
    const bool ends = cursor_.peek().is(";") || cursor_.peek().is(",") || cursor_.peek().kind == Token::kEnd;
    if (op == am2910::kPUSH && ends) {
      if (c.at.kind != Token::kEnd)
        cursor_.fail("a conditional push loads the counter: its value is missing");
      inverted = true;  // never pass, so that the counter is left alone
    } else if (uses_sequencer_input(put(0, kSeq, op))) {
      target(op);
    }
    word_.set_sequencer(op, c.code, inverted, t);
    word_.micro().old_condition = c.old;
  }

  void target(unsigned op) {
    const Token t = cursor_.peek();
    y_at_ = t;
    const bool number = op == am2910::kLDCT || op == am2910::kPUSH;
    if (t.is("seq")) {
      cursor_.take();
      y_input_ = true;
      return;
    }
    imm_target_ = true;
    if (symbols_.scratch(t.text))
      cursor_.fail(t, shown(t) + " is a scratch area: the branch goes to a label");
    if (symbols_.constant_ahead(cursor_)) {
      const std::int64_t v = symbols_.expression(cursor_);
      if (v < 0 || v > 4095) cursor_.fail(t, fmt::format("{} does not fit the 12 bits of imm: 0 to 4095", v));
      word_.set_imm(v, {}, t, number ? "the counter's value" : "the branch address");
      word_.micro().numeric_target = !number;
      return;
    }
    if (t.kind != Token::kIdentifier) cursor_.fail(t, "a label is missing: " + shown(t) + " stands here");
    Fixup f;
    f.kind = Fixup::kLabel;
    f.index = label_(cursor_.take());
    if (cursor_.peek().is("+") || cursor_.peek().is("-")) {
      const bool minus = cursor_.take().is("-");
      const std::int64_t v = symbols_.constant(cursor_);
      if (v < 0 || v > 4095) cursor_.fail(t, "the offset from a label is 0 to 4095");
      f.offset = static_cast<int>(minus ? -v : v);
      word_.micro().numeric_target = true;
    }
    word_.set_imm(0, f, t, "the branch address");
  }

  void bus_operation() {
    const Token t = cursor_.take();
    unsigned code = 16;
    for (const FunctionName& f : kFunctions) {
      if (cursor_.peek().is(f.name)) code = f.code;
    }
    if (code < 16) {
      cursor_.take();
    } else if (symbols_.constant_ahead(cursor_)) {
      const std::int64_t v = symbols_.constant(cursor_);
      if (v < 0 || v > 15) cursor_.fail(t, fmt::format("bus function {} does not fit 4 bits", v));
      code = static_cast<unsigned>(v);
    } else {
      cursor_.fail(
          "the bus function is word, lores, hires, mask_word, mask_lores, mask_hires or a number, not " +
          shown(cursor_.peek()));
    }
    word_.set(kBusOp, t.is("read") ? kBusRead : kBusWrite, t);
    word_.set(kBusFn, code, t);
  }

  void multiply() {
    const Token t = cursor_.take();
    const Token kind = cursor_.take();
    if (!kind.is("signed") && !kind.is("unsigned")) {
      cursor_.fail(kind, "mul is followed by signed or unsigned, not " + shown(kind));
    }
    word_.set(kMul, kind.is("signed") ? kMulSigned : kMulUnsigned, t);
  }

  void verbatim() {
    const Token t = cursor_.take();
    const Token& value = cursor_.peek();
    if (value.kind != Token::kNumber) cursor_.fail("the 64 bits of the word are missing");
    if (!cursor_.peek(1).is(";") || word_.micro().word != nop()) {
      cursor_.fail(t, "'word' is a whole microinstruction: nothing stands beside it");
    }
    word_.micro().word = value.value;
    word_.micro().verbatim = true;
    cursor_.take();
  }

  struct Target {
    int reg = -1;
    bool q = false, pair = false, counter = false;
    int ydst = -1;
    std::int64_t scratch = 0;
  };

  std::optional<Target> scratch_target(const Token& t) {
    Target d;
    if (t.is("spad") && cursor_.peek(1).is("[") && cursor_.peek(2).is("sar")) {
      cursor_.seek(cursor_.position() + 3);
      d.ydst = cursor_.accept("++") ? kYSpadArInc : kYSpadAr;
      if (!cursor_.accept("]")) cursor_.fail("']' is missing after sar");
      return d;
    }
    if (!cursor_.peek(1).is("[")) return std::nullopt;
    // An operand looks the same: only the '=' behind the bracket tells, and the bracket holds constants.
    std::size_t i = 2;
    while (!cursor_.peek(i).is("]") && !cursor_.peek(i).is(";") && cursor_.peek(i).kind != Token::kEnd) ++i;
    if (!cursor_.peek(i + 1).is("=")) return std::nullopt;
    d.ydst = kYSpad;
    d.scratch = parse_scratch_address(cursor_, symbols_);
    return d;
  }

  std::optional<Target> destination() {
    const Token t = cursor_.peek();
    if (t.kind != Token::kIdentifier) return std::nullopt;
    if (t.is("spad") || symbols_.scratch(t.text)) return scratch_target(t);
    Target d;
    const int r = symbols_.register_number(t.text);
    if (r >= 0) {
      d.reg = r;
      if (cursor_.peek(1).is(":") && cursor_.peek(2).is("q")) {
        d.pair = true;
        cursor_.seek(cursor_.position() + 2);
      }
    } else if (t.is("q")) {
      d.q = true;
    } else if (t.is("counter")) {
      d.counter = true;
    } else {
      for (unsigned y = kYBusX; y <= kYSeq; ++y) {
        if (y != kYSpad && y != kYSpadAr && y != kYSpadArInc && t.is(kYdstNames[y]))
          d.ydst = static_cast<int>(y);
      }
      if (d.ydst < 0) return std::nullopt;
    }
    cursor_.take();
    return d;
  }

  /// Adds one place to the chain `a = b = ...`.
  void join(Destinations& all, const Target& d, const Token& at) {
    if (d.reg >= 0) {
      if (all.reg >= 0) cursor_.fail(at, "two writers of the field 'b': a word writes one register");
      all.reg = d.reg;
      all.pair = d.pair;
    } else if (d.q) {
      if (all.q) cursor_.fail(at, "q is written twice");
      all.q = true;
    } else {
      if (all.ydst >= 0) cursor_.fail(at, "two writers of the field 'ydst': the Y bus goes to one place");
      all.ydst = d.counter ? static_cast<int>(kYSeq) : d.ydst;
      all.scratch = d.scratch;
      all.y_at = at;
    }
    all.at = at;
  }

  void transfer() {
    const Token start = cursor_.peek();
    Destinations all;
    all.at = start;
    bool counter = false;
    int places = 0;
    for (;;) {
      const std::size_t before = cursor_.position();
      const Token at = cursor_.peek();
      const auto d = destination();
      if (!d || !cursor_.accept("=")) {
        cursor_.seek(before);
        break;
      }
      join(all, *d, at);
      counter |= d->counter;
      ++places;
    }
    if (places == 1 && all.q && q_shift()) return;
    if (counter && places == 1 && symbols_.constant_ahead(cursor_)) return constant_counter(start);
    const Expression e = parse_expression(cursor_, symbols_, label_);
    if (counter) {
      word_.set_sequencer(am2910::kLDCT, kAlways, false, start);
      y_input_ = true;
    }
    if (cursor_.accept("->")) {
      const Token t = cursor_.take();
      if (!t.is("flags")) cursor_.fail(t, "'-> flags' is the only arrow, not " + shown(t));
      word_.set(kLatch, 1, t);
    } else if (places == 0) {
      cursor_.fail(start, "this value goes nowhere: write 'place = ...' or '... -> flags'");
    }
    word_.set_alu(e, all, start);
  }

  void constant_counter(const Token& start) {
    const std::int64_t n = symbols_.expression(cursor_);
    if (n < 0 || n > 4095) cursor_.fail(start, fmt::format("the counter holds 0 to 4095, not {}", n));
    word_.set_sequencer(am2910::kLDCT, kAlways, false, start);
    word_.set_imm(n, {}, start, "the counter's value");
    imm_target_ = true;
    y_at_ = start;
  }

  /// `q = q >> 1` and `q = q << 1` need no ALU.
  bool q_shift() {
    const bool right = cursor_.peek(1).is(">>");
    if (!cursor_.peek().is("q") || !(right || cursor_.peek(1).is("<<"))) return false;
    const Token at = cursor_.take();
    cursor_.take();
    const Token by = cursor_.take();
    if (by.kind != Token::kNumber || by.value != 1) cursor_.fail(by, "the shifter moves by 1");
    const unsigned fill = parse_fill(cursor_);
    word_.set_q_shift(!right, fill, at);
    return true;
  }

  TokenCursor& cursor_;
  const Symbols& symbols_;
  const LabelLookup& label_;
  WordBuilder word_;
  Token condition_at_, y_at_;
  bool y_input_ = false, imm_target_ = false;
};

}  // namespace

Condition parse_condition(TokenCursor& cursor) {
  Condition c;
  c.inverted = cursor.accept("!");
  c.at = cursor.peek();
  if (cursor.peek().is("old")) {
    cursor.take();
    cursor.expect("(", "after old");
    c.old = true;
  }
  const Token& t = cursor.take();
  for (unsigned i = 0; i < 16; ++i) {
    if (!t.is(kCondNames[i])) continue;
    c.code = i;
    if (c.old) cursor.expect(")", "after the condition");
    return c;
  }
  std::string names;
  for (const char* name : kCondNames) names += std::string(names.empty() ? "" : ", ") + name;
  cursor.fail(t, shown(t) + " is no condition: " + names);
}

Micro parse_statement(TokenCursor& cursor, const Symbols& symbols, Program& program,
                      const LabelLookup& label) {
  return Statement(cursor, symbols, program, label).parse();
}

Micro parse_loop_count(TokenCursor& cursor, const Symbols& symbols, Program& program,
                       const LabelLookup& label) {
  return Statement(cursor, symbols, program, label).parse_count();
}

}  // namespace dendro::tools
