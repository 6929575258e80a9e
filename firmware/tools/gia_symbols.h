#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/tools/gia_lexer.h"
#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// A position in the tokens of one source, with errors that name it.
class TokenCursor {
 public:
  TokenCursor(const std::vector<Token>& tokens, const std::string& file) : tokens_(tokens), file_(file) {}

  const Token& peek(std::size_t ahead = 0) const {
    return tokens_[at_ + ahead < tokens_.size() ? at_ + ahead : tokens_.size() - 1];
  }
  const Token& take() {
    const Token& t = peek();
    if (at_ + 1 < tokens_.size()) ++at_;
    return t;
  }
  bool accept(std::string_view text) {
    if (!peek().is(text)) return false;
    take();
    return true;
  }
  void expect(std::string_view text, std::string_view where);
  const Token& expect_identifier(std::string_view what);
  std::size_t position() const { return at_; }
  void seek(std::size_t position) { at_ = position; }
  const std::string& file() const { return file_; }

  [[noreturn]] void fail(const std::string& message) const { fail(peek(), message); }
  [[noreturn]] void fail(const Token& token, const std::string& message) const;

 private:
  const std::vector<Token>& tokens_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// How a token reads in an error message.
std::string shown(const Token& token);

/// Everything a name can stand for except a label.
class Symbols {
 public:
  /// Reads all declarations (wherever they stand) and places the scratch areas. Throws SourceError.
  Symbols(const std::vector<Token>& tokens, Program& program, unsigned scratch_words);

  /// Register number of `name` (r0-r15 or a declared name), or -1.
  int register_number(const std::string& name) const;
  bool is_constant(const std::string& name) const { return constants_.count(name) || scratch_.count(name); }
  const ScratchSymbol* scratch(const std::string& name) const;
  bool is_declared(const std::string& name) const { return is_constant(name) || registers_.count(name); }

  /// True when a constant (not an ALU operand) starts at the cursor.
  bool constant_ahead(const TokenCursor& cursor) const;
  /// A constant expression, C precedence without comparisons. Throws SourceError.
  std::int64_t expression(TokenCursor& cursor) const;
  /// A number, name, parenthesised expression or one of these with - or ~ in front.
  std::int64_t constant(TokenCursor& cursor) const;

  /// Skips a declaration that the constructor has read. Returns false when none starts here.
  static bool skip_declaration(TokenCursor& cursor);

 private:
  struct Area;
  void declare(const Token& name, const TokenCursor& cursor);
  void read_const(TokenCursor& cursor);
  void read_register(TokenCursor& cursor);
  void read_scratch(TokenCursor& cursor);
  void read_data(TokenCursor& cursor);
  void read_literal(TokenCursor& cursor);
  std::vector<std::uint32_t> read_list(TokenCursor& cursor) const;
  void place_areas(const TokenCursor& cursor);
  void place_automatic(const TokenCursor& cursor, const Area& area, std::vector<bool>& used);
  void store(const TokenCursor& cursor, const Token& where, std::int64_t address, std::uint32_t value);
  std::int64_t binary(TokenCursor& cursor, int level) const;

  struct Area {
    Token name;
    std::int64_t size = 1;
    std::int64_t address = -1;
    std::vector<std::uint32_t> init;
  };

  Program& program_;
  std::int64_t scratch_words_;
  std::map<std::string, std::int64_t> constants_;
  std::map<std::string, ScratchSymbol> scratch_;
  std::map<std::string, int> registers_;  // -1 until an automatic one is chosen
  std::vector<std::string> automatic_;
  std::vector<Area> areas_;
  std::map<std::string, Token> declared_;
  mutable int nesting_ = 0;
};

}  // namespace dendro::tools
