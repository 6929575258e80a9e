#include "firmware/tools/gia_alu.h"

#include <fmt/format.h>

#include <string_view>

namespace dendro::tools {
namespace {

using namespace bps32;

struct SpecialName {
  std::string_view name;
  unsigned dest;
  bool two_operands;
};
constexpr SpecialName kSpecials[] = {
    {"umul_step", 0, true},         {"smul_step", 2, true}, {"increment", 4, false},
    {"sign_magnitude", 5, false},   {"smul_last", 6, true}, {"normalize", 8, false},
    {"double_normalize", 10, true}, {"div_step", 12, true}, {"div_correct", 14, true}};

struct SourceName {
  std::string_view name;
  Dsrc source;
};
constexpr SourceName kSources[] = {{"none", kDNone},
                                   {"bus", kDBus},
                                   {"product", kDProduct},
                                   {"product_hi", kDProductHi},
                                   {"product_lo", kDProductLo},
                                   {"counter", kDCounter},
                                   {"status", kDStatus},
                                   {"bus_address", kDBusAddress},
                                   {"sar", kDSar}};

class Parser {
 public:
  Parser(TokenCursor& cursor, const Symbols& symbols, const std::function<int(const Token&)>& label)
      : cursor_(cursor), symbols_(symbols), label_(label) {}

  Expression parse() {
    e_.at = cursor_.peek();
    if (cursor_.peek().is("spread") && cursor_.peek(1).is("(")) {
      parse_spread();
    } else if (!parse_special()) {
      parse_sum();
      parse_shift();
    }
    return e_;
  }

 private:
  void parse_spread() {
    cursor_.take();
    cursor_.take();
    parse_sum();
    e_.shift = Expression::kSpread;
    cursor_.expect(",", "between the expression and the fill");
    e_.fill = parse_fill(cursor_);
    cursor_.expect(")", "after the fill: zero, sign, rotate or carry");
  }

  bool parse_special() {
    for (const SpecialName& s : kSpecials) {
      if (!cursor_.peek().is(s.name)) continue;
      cursor_.take();
      e_.op = Expression::kSpecialFunction;
      e_.special = s.dest;
      cursor_.expect("(", "after the special function");
      e_.x = operand();
      if (s.two_operands) {
        cursor_.expect(",", "between the operands S and R");
        e_.y = operand();
      } else {
        e_.y = e_.x;
      }
      cursor_.expect(")", "after the operands");
      if (cursor_.accept("+")) e_.carry = carry_term(false);
      return true;
    }
    return false;
  }

  /// `1`, `carry`, `!carry`, `borrow` as the third term.
  unsigned carry_term(bool minus) {
    const Token t = cursor_.take();
    if (t.kind == Token::kNumber && t.value == 1) return minus ? kCarryZero : kCarryOne;
    if (t.is("carry")) return minus ? kCarryLatchedNot : kCarryLatched;
    if (t.is("borrow") && minus) return kCarryLatched;
    if (t.is("!") && cursor_.accept("carry")) return minus ? kCarryLatched : kCarryLatchedNot;
    cursor_.fail(t, minus ? "the last term is 1, carry, !carry or borrow: it is the carry-in"
                          : "the last term is 1, carry or !carry: it is the carry-in");
  }

  bool carry_ahead() const {
    return cursor_.peek().is("carry") || cursor_.peek().is("borrow") || cursor_.peek().is("!");
  }

  bool group_ahead() const { return cursor_.peek().is("(") && !symbols_.constant_ahead(cursor_); }

  void parse_sum() {
    if (group_ahead()) {
      cursor_.take();
      parse_plain_sum();
      cursor_.expect(")", "after the expression");
    } else {
      parse_plain_sum();
    }
  }

  void parse_plain_sum() {
    const bool constant = symbols_.constant_ahead(cursor_);
    if (!constant && cursor_.peek().is("~")) {
      cursor_.take();
      if (group_ahead()) return parse_inverted_group();
      e_.x = operand();
      if (cursor_.accept("&")) {
        e_.op = Expression::kAndNot;
        e_.y = operand();
        return;
      }
      e_.op = Expression::kInvert;
      if (cursor_.accept("+")) e_.carry = carry_term(false);
      return;
    }
    if (!constant && cursor_.accept("-")) {
      e_.x = operand();
      e_.op = Expression::kInvert;
      e_.carry = kCarryOne;
      return;
    }
    e_.x = operand();
    if (cursor_.peek().is("+") || cursor_.peek().is("-")) {
      parse_sum_tail();
    } else if (cursor_.peek().is("&") || cursor_.peek().is("|") || cursor_.peek().is("^")) {
      parse_logic_tail(false);
    } else {
      finish_single();
    }
  }

  void finish_single() {
    if (e_.x.kind != Operand::kConstant) return;
    if (e_.x.value == 0) e_.op = Expression::kFixedZero;
    if (e_.x.value == -1 || e_.x.value == 0xFFFFFFFF) e_.op = Expression::kFixedOnes;
  }

  void parse_inverted_group() {
    cursor_.take();
    e_.x = operand();
    if (!cursor_.peek().is("&") && !cursor_.peek().is("|") && !cursor_.peek().is("^")) {
      cursor_.fail("~( ) inverts x & y, x | y or x ^ y only: the ALU has no other inverted result");
    }
    parse_logic_tail(true);
    cursor_.expect(")", "after the inverted operation");
  }

  void parse_logic_tail(bool inverted) {
    const Token op = cursor_.take();
    e_.op = Expression::kLogic;
    if (op.is("&") && !inverted && cursor_.peek().is("~") && !symbols_.constant_ahead(cursor_)) {
      cursor_.take();
      e_.op = Expression::kAndNot;
      e_.y = e_.x;
      e_.x = operand();
      return;
    }
    e_.func = op.is("&")   ? (inverted ? kNand : kAnd)
              : op.is("|") ? (inverted ? kNor : kOr)
                           : (inverted ? kXnor : kXor);
    e_.y = operand();
  }

  void parse_sum_tail() {
    const bool minus = cursor_.take().is("-");
    if (!minus && carry_ahead()) {
      e_.carry = carry_term(false);
      return;
    }
    const bool one = cursor_.peek().kind == Token::kNumber && cursor_.peek().value == 1;
    e_.y = operand();
    const bool third = cursor_.peek().is("+") || cursor_.peek().is("-");
    if (third) {
      const Token& sign = cursor_.take();
      if (sign.is("-") != minus) cursor_.fail(sign, "the carry-in has the sign of the second term");
      e_.op = minus ? Expression::kSubtract : Expression::kAdd;
      e_.carry = carry_term(minus);
    } else if (one && !minus) {
      e_.carry = kCarryOne;
    } else if (one) {
      e_.op = Expression::kSubtract;
      e_.y.value = 0;
      e_.carry = kCarryZero;
    } else {
      e_.op = minus ? Expression::kSubtract : Expression::kAdd;
      e_.carry = minus ? kCarryOne : kCarryZero;
    }
  }

  void parse_shift() {
    if (!cursor_.peek().is(">>") && !cursor_.peek().is("<<")) return;
    e_.shift = cursor_.take().is(">>") ? Expression::kRight : Expression::kLeft;
    const Token& by = cursor_.take();
    if (by.kind != Token::kNumber || by.value != 1) {
      cursor_.fail(by, "the shifter moves by 1; D bus sources turn by 8, 16 or 24 with ror8, ror16, ror24");
    }
    e_.fill = parse_fill(cursor_);
    e_.keep_sign = cursor_.accept("keep");
  }

  Operand operand() {
    Operand o;
    o.at = cursor_.peek();
    if (symbols_.constant_ahead(cursor_)) {
      o.value = symbols_.constant(cursor_);
      if (o.value < INT32_MIN || o.value > UINT32_MAX) {
        cursor_.fail(o.at, fmt::format("{} does not fit 32 bits", o.value));
      }
      return o;
    }
    const Token t = cursor_.take();
    if (t.is("#")) return immediate(o);
    if (t.kind != Token::kIdentifier) cursor_.fail(t, "an operand is missing: " + shown(t) + " stands here");
    if (t.is("q")) {
      o.kind = Operand::kQ;
      return o;
    }
    const int r = symbols_.register_number(t.text);
    if (r >= 0) {
      o.kind = Operand::kRegister;
      o.reg = static_cast<unsigned>(r);
      return o;
    }
    return d_source(t, o);
  }

  Operand immediate(Operand o) {
    o.kind = Operand::kD;
    o.dsrc = kDImm;
    o.uses_imm = true;
    const Token& t = cursor_.peek();
    if (t.kind == Token::kIdentifier && !t.is("sizeof") && !symbols_.is_constant(t.text)) {
      o.fixup.kind = Fixup::kLabel;
      o.fixup.index = label_(cursor_.take());
      return o;
    }
    o.value = symbols_.constant(cursor_);
    if (o.value < -2048 || o.value > 2047) {
      cursor_.fail(o.at, fmt::format("{} does not fit the 12 signed bits of imm: -2048 to 2047", o.value));
    }
    return o;
  }

  Operand d_source(const Token& t, Operand o) {
    o.kind = Operand::kD;
    for (const SourceName& s : kSources) {
      if (!t.is(s.name)) continue;
      o.dsrc = s.source;
      return o;
    }
    if (t.is("ror8") || t.is("ror16") || t.is("ror24")) return rotated(t, o);
    if (t.is("old")) {
      cursor_.expect("(", "after old");
      o = operand();
      cursor_.expect(")", "after the operand");
      if (o.dsrc != kDProduct && o.dsrc != kDProductHi && o.dsrc != kDProductLo) {
        cursor_.fail(o.at, "old( ) is for product, product_hi, product_lo and for conditions");
      }
      e_.old_product = true;
      return o;
    }
    if (t.is("spad") && cursor_.peek().is("[") && cursor_.peek(1).is("sar")) {
      cursor_.take();
      cursor_.take();
      o.dsrc = cursor_.accept("++") ? kDSpadArInc : kDSpadAr;
      cursor_.expect("]", "after sar");
      return o;
    }
    if (t.is("spad") || symbols_.scratch(t.text)) {
      cursor_.seek(cursor_.position() - 1);
      o.dsrc = kDSpad;
      o.uses_imm = true;
      o.value = parse_scratch_address(cursor_, symbols_);
      return o;
    }
    cursor_.fail(t, shown(t) + " is no register, constant or D bus source");
  }

  Operand rotated(const Token& t, Operand o) {
    cursor_.expect("(", "after " + t.text);
    if (cursor_.peek().is("ror8") || cursor_.peek().is("ror16") || cursor_.peek().is("ror24")) {
      cursor_.fail("one rotation: the D bus turns once");
    }
    const Token at = o.at;
    o = operand();
    cursor_.expect(")", "after the operand");
    if (o.kind != Operand::kD) {
      cursor_.fail(at, t.text + " turns the D bus: a register or constant does not pass there (#n does)");
    }
    o.lane = t.is("ror8") ? 1 : t.is("ror16") ? 2 : 3;
    return o;
  }

  TokenCursor& cursor_;
  const Symbols& symbols_;
  const std::function<int(const Token&)>& label_;
  Expression e_;
};

}  // namespace

unsigned parse_fill(TokenCursor& cursor) {
  if (cursor.accept("zero")) return kFillZero;
  if (cursor.accept("sign")) return kFillSign;
  if (cursor.accept("rotate")) return kFillRotate;
  if (cursor.accept("carry")) return kFillCarry;
  return kFillZero;
}

std::int64_t parse_scratch_address(TokenCursor& cursor, const Symbols& symbols) {
  const Token name = cursor.take();
  cursor.expect("[", "after " + shown(name));
  const ScratchSymbol* area = symbols.scratch(name.text);
  std::int64_t at = symbols.expression(cursor);
  cursor.expect("]", "after the scratch address");
  if (area) {
    if (at < 0 || at >= area->size) {
      cursor.fail(name, fmt::format("'{}' has {} words: [{}] lies outside", name.text, area->size, at));
    }
    at += area->address;
  }
  if (at < 0 || at > 4095) {
    cursor.fail(name, fmt::format("scratch word {} is out of reach of imm (0 to 4095): go through sar", at));
  }
  return at;
}

Expression parse_expression(TokenCursor& cursor, const Symbols& symbols,
                            const std::function<int(const Token&)>& label) {
  return Parser(cursor, symbols, label).parse();
}

}  // namespace dendro::tools
