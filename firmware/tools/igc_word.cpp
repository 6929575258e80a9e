#include "firmware/tools/igc_word.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/tools/source_error.h"

namespace dendro::tools {

using igc::DataOp;
using igc::Function;
using igc::Operand;
using igc::Source;

bool is_reserved_word(std::string_view text) {
  static constexpr std::string_view kWords[] = {"register", "program", "phase",  "loop",  "gap",     "fraction",
                                                "guard",    "tree",    "idle",   "enable", "carry",  "data",
                                                "borrow",   "sum",     "same",   "constant", "i",    "majority"};
  return std::find(std::begin(kWords), std::end(kWords), text) != std::end(kWords);
}

IgcWordBuilder::IgcWordBuilder(const std::string& file, const IgcOptions& options,
                         const std::map<std::string, unsigned>& registers, const LoopPlace& place,
                         KnownRegisters& known)
    : file_(file), options_(options), registers_(registers), place_(place), known_(known), set_(known) {
  word_.loop = place.count;
  word_.loop_number = static_cast<std::uint8_t>(place.number);
}

void IgcWordBuilder::fail(const Token& token, const std::string& message) const {
  throw SourceError(file_, token.line, token.column, message);
}

bool IgcWordBuilder::take(std::string_view text) {
  if (!now().is(text)) return false;
  ++at_;
  return true;
}

void IgcWordBuilder::expect(std::string_view text) {
  if (!take(text)) fail(now(), fmt::format("`{}` stands here", text));
}

unsigned IgcWordBuilder::number(const char* what, unsigned most) {
  if (now().kind != Token::kNumber || now().value > most) fail(now(), fmt::format("{} is 0..{}", what, most));
  return static_cast<unsigned>((*tokens_)[at_++].value);
}

std::size_t IgcWordBuilder::add_part(const std::vector<Token>& tokens, std::size_t at) {
  tokens_ = &tokens, at_ = at;
  const Token start = now();
  if (take("idle")) return at_;
  if (take("tree")) {
    word_.tree = true;
    return at_;
  }
  if (take("enable"))
    enable_part(start);
  else if (take("carry"))
    carry_part(start);
  else if (take("data"))
    data_part(start);
  else
    write_part(start);
  return at_;
}

void IgcWordBuilder::use_known(const Token& token, bool known, const char* name) const {
  if (!known) fail(token, fmt::format("`{}` is used before the program sets it", name));
}

void IgcWordBuilder::use_function(const Token& token, Function function) {
  if (function_)
    fail(token, "one word changes enable or carry, and only once: the function field is taken");
  function_ = word_.function = function;
}

void IgcWordBuilder::use_x(const Token& token, Operand x) {
  if (x_ && *x_ != x) fail(token, "operand x of this word is something else already");
  x_ = word_.x = x;
}

void IgcWordBuilder::use_y(const Token& token, Operand y) {
  if (y_ && *y_ != y) fail(token, "operand y of this word is something else already");
  y_ = word_.y = y;
}

void IgcWordBuilder::operand_pair() {
  expect("(");
  const Token first = now();
  const Operand x = operand();
  expect(",");
  const Token second = now();
  const Operand y = operand();
  expect(")");
  use_x(first, x), use_y(second, y);
}

// enable = 1 | enable & carry | enable & ~carry
void IgcWordBuilder::enable_part(const Token& start) {
  expect("=");
  if (now().kind == Token::kNumber) {
    if (number("what enable is set to", 1) != 1) fail(start, "enable is set to 1 or ANDed with the carry");
    use_function(start, Function::kSetEnable);
  } else {
    expect("enable");
    expect("&");
    use_function(start, take("~") ? Function::kAndNotCarry : Function::kAndCarry);
    const Token carry = now();
    expect("carry");
    use_known(start, known_.enable, "enable");
    use_known(carry, known_.carry, "carry");
  }
  set_.enable = true;
}

// carry = x | borrow(x, y) | majority(x, y) | same(x, y)
void IgcWordBuilder::carry_part(const Token& start) {
  expect("=");
  const Token name = now();
  Function function = Function::kLoad;
  if (take("borrow")) function = Function::kBorrow;
  else if (take("majority")) function = Function::kCarry;
  else if (take("same")) function = Function::kEqual;
  use_function(start, function);
  if (function == Function::kLoad) {
    use_x(name, operand());
  } else {
    use_known(name, known_.carry, "carry");
    operand_pair();
  }
  set_.carry = true;
}

// data = 0 | tree | data | tree | FIELD
void IgcWordBuilder::data_part(const Token& start) {
  expect("=");
  if (data_op_) fail(start, "the data register is changed twice in one word");
  data_op_ = true;
  const Token value = now();
  if (value.kind == Token::kNumber) {
    if (number("what data is set to", 0) == 0) word_.data = DataOp::kClear;
  } else if (take("tree")) {
    word_.data = DataOp::kTree, word_.tree = true;
  } else if (take("data")) {
    use_known(value, known_.data, "data");
    expect("|");
    expect("tree");
    word_.data = DataOp::kOrTree, word_.tree = true;
  } else {
    ++at_;
    if (port_of(value, place(value)) != Operand::kPortA)
      fail(value, "the data register is loaded through port a: name this field first in the word");
    word_.read_a = true;
    word_.data = DataOp::kPortA;
  }
  set_.data = true;
}

// FIELD = tree | carry | sum(x, y) | x | x | data | x & ~data
void IgcWordBuilder::write_part(const Token& start) {
  if (start.kind != Token::kIdentifier) fail(start, "a word's part begins with a name");
  ++at_;
  const Operand port = port_of(start, place(start));
  use_known(start, known_.enable, "enable");
  (port == Operand::kPortA ? word_.write_a : word_.write_b) = true;
  expect("=");
  const Token value = now();
  Source source = Source::kX;
  if (take("carry") || take("sum")) {
    use_known(value, known_.carry, "carry");
    source = Source::kSum;
    if (value.is("sum")) {
      operand_pair();
    } else {
      use_x(value, Operand::kZero), use_y(value, Operand::kZero);
    }
  } else {
    const Operand x = operand();
    if (take("|")) {
      use_known(now(), known_.data, "data");
      expect("data");
      source = Source::kXOrData;
    } else if (take("&")) {
      expect("~");
      use_known(now(), known_.data, "data");
      expect("data");
      source = Source::kXAndNotData;
    }
    if (source == Source::kX && x == Operand::kTree && x_ && *x_ != x)
      source = Source::kTree;
    else
      use_x(value, x);
  }
  if (source_ && *source_ != source) fail(value, "one word writes one value: the source field is taken");
  source_ = word_.source = source;
}

// NAME [ i | number | i + number ]
IgcWordBuilder::Place IgcWordBuilder::place(const Token& name) {
  Place out;
  const auto found = registers_.find(name.text);
  if (name.kind != Token::kIdentifier || found == registers_.end())
    fail(name, fmt::format("`{}` is no register: declare it with `register {} = number;`", name.text, name.text));
  out.number = found->second;
  expect("[");
  if (take("i")) {
    if (place_.count == igc::LoopCount::kNone) fail(name, "`i` counts the turns of a loop; this word is in none");
    out.indexed = true;
    if (take("+")) out.offset = number("an offset", 255);
  } else {
    out.offset = number("an offset", 255);
  }
  expect("]");
  check_memory(name, out);
  return out;
}

void IgcWordBuilder::check_memory(const Token& name, const Place& at) const {
  const auto base = options_.registers.find(name.text);
  if (base == options_.registers.end() || (at.indexed && !place_.turns)) return;
  if (at.indexed && *place_.turns == 0) return;
  const unsigned last = base->second + at.offset + (at.indexed ? *place_.turns - 1 : 0);
  if (last >= static_cast<unsigned>(options_.memory_bits))
    fail(name, fmt::format("`{}` reaches bit {} of a pixel; the memory has bits 0..{}", name.text, last,
                           options_.memory_bits - 1));
}

Operand IgcWordBuilder::port_of(const Token& token, const Place& at) {
  auto found = std::find(ports_.begin(), ports_.end(), at);
  if (found == ports_.end()) {
    if (static_cast<int>(ports_.size()) >= options_.ports)
      fail(token, fmt::format("two uses of one port in a clock: the array's memory has {} port{}", options_.ports,
                              options_.ports == 1 ? "" : "s"));
    ports_.push_back(at);
    found = ports_.end() - 1;
    const auto number = static_cast<std::uint8_t>(at.number), offset = static_cast<std::uint8_t>(at.offset);
    if (ports_.size() == 1)
      word_.register_a = number, word_.offset_a = offset, word_.indexed_a = at.indexed;
    else
      word_.register_b = number, word_.offset_b = offset, word_.indexed_b = at.indexed;
  }
  return found == ports_.begin() ? Operand::kPortA : Operand::kPortB;
}

Operand IgcWordBuilder::operand() {
  const Token token = now();
  if (token.kind == Token::kNumber) return number("an operand", 1) == 0 ? Operand::kZero : Operand::kOne;
  ++at_;
  if (token.is("tree")) {
    word_.tree = true;
    return Operand::kTree;
  }
  if (token.is("data")) {
    use_known(token, known_.data, "data");
    return Operand::kData;
  }
  if (token.is("constant")) {
    if (take("[")) {
      expect("i");
      expect("+");
      const unsigned offset = number("a constant's offset", 63);
      if (word_.constant_offset != 0 && word_.constant_offset != offset)
        fail(token, "one word uses one bit of the constant");
      word_.constant_offset = static_cast<std::uint8_t>(offset);
      expect("]");
    }
    return Operand::kConstant;
  }
  const Operand port = port_of(token, place(token));
  (port == Operand::kPortA ? word_.read_a : word_.read_b) = true;
  return port;
}

igc::MicroWord IgcWordBuilder::finish() {
  known_ = set_;
  return word_;
}

}  // namespace dendro::tools
