#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dendro::tools {

struct Token {
  enum Kind { kIdentifier, kNumber, kPunctuation, kEnd };
  Kind kind = kEnd;
  std::string text;
  std::uint64_t value = 0;  ///< of a number
  int line = 0;
  int column = 0;

  bool is(std::string_view t) const { return kind != kEnd && kind != kNumber && text == t; }
};

/// Splits a microprogram source into tokens; the last one is kEnd. Throws SourceError on a character or
/// number that the language does not have.
std::vector<Token> tokenize(std::string_view source, const std::string& file);

}  // namespace dendro::tools
