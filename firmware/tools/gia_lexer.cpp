#include "firmware/tools/gia_lexer.h"

#include <fmt/format.h>

#include <cctype>

#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

bool identifier_start(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool identifier_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

int digit_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char l = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return l >= 'a' && l <= 'z' ? l - 'a' + 10 : 99;
}

std::uint64_t number_value(const std::string& text, const std::string& file, int line, int column) {
  int base = 10;
  std::size_t at = 0;
  if (text.size() > 1 && text[0] == '0') {
    const char prefix = static_cast<char>(std::tolower(static_cast<unsigned char>(text[1])));
    base = prefix == 'x' ? 16 : prefix == 'b' ? 2 : prefix == 'o' ? 8 : 0;
    if (base == 0)
      throw SourceError(file, line, column, "a number starts with 1-9, 0x, 0o or 0b, not '" + text + "'");
    at = 2;
  }
  std::uint64_t value = 0;
  if (at == text.size()) throw SourceError(file, line, column, "'" + text + "' has no digits");
  for (; at < text.size(); ++at) {
    if (text[at] == '_') continue;
    const int d = digit_value(text[at]);
    if (d >= base) {
      throw SourceError(file, line, column, fmt::format("'{}' is not a digit of base {}", text[at], base));
    }
    std::uint64_t next = 0;
    if (__builtin_mul_overflow(value, static_cast<std::uint64_t>(base), &next) ||
        __builtin_add_overflow(next, static_cast<std::uint64_t>(d), &next)) {
      throw SourceError(file, line, column, "the number '" + text + "' does not fit 64 bits");
    }
    value = next;
  }
  return value;
}

}  // namespace

std::vector<Token> tokenize(std::string_view source, const std::string& file) {
  static constexpr std::string_view kPairs[] = {"->", ">>", "<<", "++"};
  static constexpr std::string_view kSingles = "{}()[];,:=+-*/%&|^~!#@";
  std::vector<Token> tokens;
  int line = 1;
  std::size_t line_start = 0;
  std::size_t at = 0;
  while (at < source.size()) {
    const char c = source[at];
    const int column = static_cast<int>(at - line_start) + 1;
    if (c == '\n') {
      ++line;
      line_start = ++at;
      continue;
    }
    if (c == ' ' || c == '\t' || c == '\r') {
      ++at;
      continue;
    }
    if (source.substr(at, 2) == "//") {
      while (at < source.size() && source[at] != '\n') ++at;
      continue;
    }
    Token token;
    token.line = line;
    token.column = column;
    std::size_t end = at + 1;
    if (identifier_start(c) || (c >= '0' && c <= '9')) {
      while (end < source.size() && identifier_part(source[end])) ++end;
      token.text = std::string(source.substr(at, end - at));
      token.kind = identifier_start(c) ? Token::kIdentifier : Token::kNumber;
      if (token.kind == Token::kNumber) token.value = number_value(token.text, file, line, column);
    } else {
      for (const std::string_view pair : kPairs) {
        if (source.substr(at, 2) == pair) end = at + 2;
      }
      if (end == at + 1 && (c == '\0' || kSingles.find(c) == std::string_view::npos)) {
        const bool printable = std::isprint(static_cast<unsigned char>(c)) != 0;
        const std::string shown =
            printable ? fmt::format("'{}'", c) : fmt::format("byte 0x{:02x}", static_cast<unsigned char>(c));
        throw SourceError(file, line, column, shown + " means nothing in a microprogram");
      }
      token.kind = Token::kPunctuation;
      token.text = std::string(source.substr(at, end - at));
    }
    tokens.push_back(std::move(token));
    at = end;
  }
  Token last;
  last.line = line;
  last.column = static_cast<int>(at - line_start) + 1;
  tokens.push_back(last);
  return tokens;
}

}  // namespace dendro::tools
