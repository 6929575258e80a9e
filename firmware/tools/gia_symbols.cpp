#include "firmware/tools/gia_symbols.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

constexpr std::int64_t kSmallArea =
    256;  // larger automatic areas leave the words that imm reaches to the others
constexpr int kMaxNesting = 64;

bool is_declaration(const Token& t) {
  return t.is("const") || t.is("reg") || t.is("scratch") || t.is("data") || t.is("literal");
}

std::int64_t wrap(std::uint64_t v) { return static_cast<std::int64_t>(v); }

}  // namespace

std::string shown(const Token& t) {
  return t.kind == Token::kEnd ? "the end of the file" : "'" + t.text + "'";
}

void TokenCursor::expect(std::string_view text, std::string_view where) {
  if (!accept(text)) fail(fmt::format("'{}' is missing {}: {} stands here", text, where, shown(peek())));
}

const Token& TokenCursor::expect_identifier(std::string_view what) {
  if (peek().kind != Token::kIdentifier)
    fail(fmt::format("{} is missing: {} stands here", what, shown(peek())));
  return take();
}

void TokenCursor::fail(const Token& token, const std::string& message) const {
  throw SourceError(file_, token.line, token.column, message);
}

Symbols::Symbols(const std::vector<Token>& tokens, Program& program, unsigned scratch_words)
    : program_(program), scratch_words_(scratch_words) {
  TokenCursor cursor(tokens, program.file);
  std::vector<std::size_t> data;
  // Areas are placed before the statements are read, so that an address is a constant wherever it is used.
  while (cursor.peek().kind != Token::kEnd) {
    const Token& t = cursor.peek();
    if (!is_declaration(t)) {
      cursor.take();
      continue;
    }
    if (t.is("data")) {
      data.push_back(cursor.position());
      skip_declaration(cursor);
      continue;
    }
    cursor.take();
    if (t.is("const")) read_const(cursor);
    if (t.is("reg")) read_register(cursor);
    if (t.is("scratch")) read_scratch(cursor);
    if (t.is("literal")) read_literal(cursor);
  }
  place_areas(cursor);
  for (const std::size_t at : data) {
    cursor.seek(at + 1);
    read_data(cursor);
  }
  for (const std::string& name : automatic_) {
    int r = 0;
    const auto taken = [&](int n) {
      return std::any_of(registers_.begin(), registers_.end(), [&](const auto& e) { return e.second == n; });
    };
    while (r < 16 && taken(r)) ++r;
    if (r == 16) cursor.fail(declared_[name], "no register is left for '" + name + "': there are 16");
    registers_[name] = r;
  }
  program_.scratch = scratch_;
}

bool Symbols::skip_declaration(TokenCursor& cursor) {
  if (!is_declaration(cursor.peek())) return false;
  while (cursor.peek().kind != Token::kEnd && !cursor.peek().is(";")) cursor.take();
  cursor.expect(";", "after the declaration");
  return true;
}

void Symbols::declare(const Token& name, const TokenCursor& cursor) {
  if (!is_free_name(name.text))
    cursor.fail(name, "'" + name.text + "' is a word of the language and no free name");
  const auto [it, fresh] = declared_.emplace(name.text, name);
  if (!fresh) {
    cursor.fail(name, fmt::format("'{}' is declared twice: first in line {}", name.text, it->second.line));
  }
}

void Symbols::read_const(TokenCursor& cursor) {
  const Token name = cursor.expect_identifier("the name of the constant");
  declare(name, cursor);
  cursor.expect("=", "after the constant's name");
  const std::int64_t value = expression(cursor);
  cursor.expect(";", "after the constant");
  constants_[name.text] = value;
}

void Symbols::read_register(TokenCursor& cursor) {
  const Token name = cursor.expect_identifier("the name of the register");
  declare(name, cursor);
  if (cursor.accept("=")) {
    const Token& t = cursor.expect_identifier("r0 to r15");
    const int r = register_number(t.text);
    if (r < 0) cursor.fail(t, shown(t) + " is no register: r0 to r15");
    registers_[name.text] = r;
  } else {
    registers_[name.text] = -1;
    automatic_.push_back(name.text);
  }
  cursor.expect(";", "after the register");
}

std::vector<std::uint32_t> Symbols::read_list(TokenCursor& cursor) const {
  cursor.expect("{", "before the initial words");
  std::vector<std::uint32_t> values;
  while (!cursor.peek().is("}")) {
    const Token& at = cursor.peek();
    const std::int64_t v = expression(cursor);
    if (v < INT32_MIN || v > UINT32_MAX) cursor.fail(at, fmt::format("{} does not fit 32 bits", v));
    values.push_back(static_cast<std::uint32_t>(v));
    if (!cursor.accept(",")) break;
  }
  cursor.expect("}", "after the initial words");
  return values;
}

void Symbols::read_scratch(TokenCursor& cursor) {
  Area area;
  area.name = cursor.expect_identifier("the name of the scratch area");
  declare(area.name, cursor);
  if (cursor.accept("[")) {
    area.size = expression(cursor);
    cursor.expect("]", "after the size");
  }
  if (area.size < 1 || area.size > scratch_words_) {
    cursor.fail(area.name, fmt::format("scratch area '{}' of {} words: the scratchpad has {}", area.name.text,
                                       area.size, scratch_words_));
  }
  if (cursor.accept("=")) area.init = read_list(cursor);
  if (cursor.accept("@")) {
    area.address = expression(cursor);
    if (area.address < 0 || area.address + area.size > scratch_words_) {
      cursor.fail(area.name,
                  fmt::format("scratch area '{}' at {} with {} words overflows the scratchpad of {}",
                              area.name.text, area.address, area.size, scratch_words_));
    }
    scratch_[area.name.text] = {static_cast<std::uint32_t>(area.address),
                                static_cast<std::uint32_t>(area.size)};
  }
  if (static_cast<std::int64_t>(area.init.size()) > area.size) {
    cursor.fail(area.name, fmt::format("'{}' has {} initial values for {} words", area.name.text,
                                       area.init.size(), area.size));
  }
  cursor.expect(";", "after the scratch area");
  areas_.push_back(std::move(area));
}

void Symbols::read_data(TokenCursor& cursor) {
  const Token where = cursor.peek();
  const std::int64_t address = expression(cursor);
  cursor.expect("=", "after the address");
  std::int64_t at = address;
  for (const std::uint32_t v : read_list(cursor)) store(cursor, where, at++, v);
  cursor.expect(";", "after the data");
}

void Symbols::read_literal(TokenCursor& cursor) {
  const Token pack = cursor.expect_identifier("none or full");
  if (!pack.is("none") && !pack.is("full")) cursor.fail(pack, "none or full is expected, not " + shown(pack));
  cursor.expect(",", "after the packing");
  const Token& at = cursor.peek();
  const std::int64_t ticks = expression(cursor);
  if (ticks < 1 || ticks > 64) cursor.fail(at, "multiply_ticks is 1 to 64");
  cursor.expect(";", "after the literal declaration");
  program_.literal = true;
  program_.literal_pack = pack.text;
  program_.literal_multiply_ticks = static_cast<int>(ticks);
}

void Symbols::store(const TokenCursor& cursor, const Token& where, std::int64_t address,
                    std::uint32_t value) {
  if (address < 0 || address >= scratch_words_) {
    cursor.fail(where, fmt::format("data at {}: the scratchpad has {} words", address, scratch_words_));
  }
  if (!program_.scratch_data.emplace(static_cast<std::uint32_t>(address), value).second) {
    cursor.fail(where, fmt::format("scratch word {} has two initial values", address));
  }
}

void Symbols::place_automatic(const TokenCursor& cursor, const Area& area, std::vector<bool>& used) {
  const bool small = area.size <= kSmallArea;
  const std::int64_t last = scratch_words_ - area.size;
  for (std::int64_t i = 0; i <= last; ++i) {
    const std::int64_t at = small ? i : last - i;
    const auto first = used.begin() + at;
    if (std::find(first, first + area.size, true) != first + area.size) continue;
    std::fill(first, first + area.size, true);
    scratch_[area.name.text] = {static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(area.size)};
    return;
  }
  cursor.fail(area.name, fmt::format("scratchpad overflow: no {} words in a row are left for '{}' of {}",
                                     area.size, area.name.text, scratch_words_));
}

void Symbols::place_areas(const TokenCursor& cursor) {
  std::vector<bool> used(static_cast<std::size_t>(scratch_words_), false);
  for (const Area& area : areas_) {
    if (area.address >= 0) std::fill_n(used.begin() + area.address, area.size, true);
  }
  for (const Area& area : areas_) {
    if (area.address < 0) place_automatic(cursor, area, used);
  }
  for (const Area& area : areas_) {
    std::int64_t at = scratch_[area.name.text].address;
    for (const std::uint32_t v : area.init) store(cursor, area.name, at++, v);
  }
}

int Symbols::register_number(const std::string& name) const {
  const auto it = registers_.find(name);
  if (it != registers_.end()) return it->second;
  for (int r = 0; r < 16; ++r) {
    if (name == fmt::format("r{}", r)) return r;
  }
  return -1;
}

const ScratchSymbol* Symbols::scratch(const std::string& name) const {
  const auto it = scratch_.find(name);
  return it == scratch_.end() ? nullptr : &it->second;
}

bool Symbols::constant_ahead(const TokenCursor& cursor) const {
  std::size_t i = 0;
  while (cursor.peek(i).is("-") || cursor.peek(i).is("~")) ++i;
  const auto is_value = [&](const Token& t, const Token& next) {
    if (t.is("sizeof") || t.kind == Token::kNumber) return true;
    return t.kind == Token::kIdentifier && is_constant(t.text) && !next.is("[");
  };
  if (!cursor.peek(i).is("(")) return is_value(cursor.peek(i), cursor.peek(i + 1));
  for (int depth = 0;; ++i) {
    const Token& t = cursor.peek(i);
    if (t.is("(")) ++depth;
    if (t.is(")") && --depth == 0) return true;
    if (t.kind == Token::kEnd || t.is(";")) return false;
    if (t.kind == Token::kIdentifier && !is_value(t, cursor.peek(i + 1))) return false;
  }
}

std::int64_t Symbols::constant(TokenCursor& cursor) const {
  const Token t = cursor.take();
  if (t.is("-") || t.is("~")) {
    int minus = 0;
    const Token* sign = &t;
    std::vector<bool> negate{sign->is("-")};
    while (cursor.peek().is("-") || cursor.peek().is("~")) {
      negate.push_back(cursor.take().is("-"));
      if (++minus > kMaxNesting) cursor.fail("too many signs in a row");
    }
    auto v = static_cast<std::uint64_t>(constant(cursor));
    for (auto it = negate.rbegin(); it != negate.rend(); ++it) v = *it ? 0 - v : ~v;
    return wrap(v);
  }
  if (t.is("(")) {
    if (++nesting_ > kMaxNesting) cursor.fail(t, "the parentheses are nested too deeply");
    const std::int64_t v = expression(cursor);
    --nesting_;
    cursor.expect(")", "after the constant expression");
    return v;
  }
  if (t.kind == Token::kNumber) return wrap(t.value);
  if (t.is("sizeof")) {
    cursor.expect("(", "after sizeof");
    const Token& name = cursor.expect_identifier("the name of a scratch area");
    const ScratchSymbol* s = scratch(name.text);
    if (!s) cursor.fail(name, shown(name) + " is no scratch area");
    cursor.expect(")", "after the name");
    return s->size;
  }
  if (t.kind == Token::kIdentifier) {
    const auto it = constants_.find(t.text);
    if (it != constants_.end()) return it->second;
    if (const ScratchSymbol* s = scratch(t.text)) return s->address;
    if (declared_.count(t.text)) {
      cursor.fail(
          t, "'" + t.text + "' has no value here: a scratch area without '@' is placed after all constants");
    }
    cursor.fail(t, "'" + t.text + "' is not defined");
  }
  cursor.fail(t, "a constant is missing: " + shown(t) + " stands here");
}

std::int64_t Symbols::binary(TokenCursor& cursor, int level) const {
  static const std::vector<std::vector<std::string_view>> kLevels = {
      {"|"}, {"^"}, {"&"}, {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
  if (level == static_cast<int>(kLevels.size())) return constant(cursor);
  std::int64_t left = binary(cursor, level + 1);
  for (;;) {
    const Token op = cursor.peek();
    const auto& ops = kLevels[static_cast<std::size_t>(level)];
    if (std::none_of(ops.begin(), ops.end(), [&](std::string_view o) { return op.is(o); })) return left;
    cursor.take();
    const std::int64_t right = binary(cursor, level + 1);
    const auto a = static_cast<std::uint64_t>(left);
    const auto b = static_cast<std::uint64_t>(right);
    if (op.is("/") || op.is("%")) {
      if (right == 0 || (left == INT64_MIN && right == -1)) cursor.fail(op, "this division has no result");
      left = op.is("/") ? left / right : left % right;
    } else if (op.is("<<") || op.is(">>")) {
      if (right < 0 || right > 63) cursor.fail(op, "a shift is by 0 to 63 bits");
      left = op.is("<<") ? wrap(a << right) : left >> right;
    } else {
      left = op.is("|")   ? wrap(a | b)
             : op.is("^") ? wrap(a ^ b)
             : op.is("&") ? wrap(a & b)
             : op.is("+") ? wrap(a + b)
             : op.is("-") ? wrap(a - b)
                          : wrap(a * b);
    }
  }
}

std::int64_t Symbols::expression(TokenCursor& cursor) const { return binary(cursor, 0); }

}  // namespace dendro::tools
