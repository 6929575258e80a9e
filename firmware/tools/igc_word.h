#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/tools/gia_lexer.h"
#include "firmware/tools/igc_assembler.h"
#include "models/parts/igc/igc_isa.h"

namespace dendro::tools {

/// Which of a pixel's registers the program has set so far.
struct KnownRegisters {
  bool enable = false, carry = false, data = false;
};

/// The loop that a word stands in.
struct LoopPlace {
  igc::LoopCount count = igc::LoopCount::kNone;
  unsigned number = 0;
  std::optional<unsigned> turns;  ///< if known
  std::string text;
  bool may_be_empty = false;
};

bool is_reserved_word(std::string_view text);

/// Gathers the parts of one word and finds those that exclude each other. All members throw SourceError.
class IgcWordBuilder {
 public:
  IgcWordBuilder(const std::string& file, const IgcOptions& options, const std::map<std::string, unsigned>& registers,
              const LoopPlace& place, KnownRegisters& known);

  /// Reads one part from tokens[at]; returns the index behind it.
  std::size_t add_part(const std::vector<Token>& tokens, std::size_t at);

  igc::MicroWord finish();

 private:
  struct Place {
    unsigned number = 0, offset = 0;
    bool indexed = false;
    bool operator==(const Place& other) const {
      return number == other.number && offset == other.offset && indexed == other.indexed;
    }
  };

  const Token& now() const { return (*tokens_)[at_]; }
  bool take(std::string_view text);
  void expect(std::string_view text);
  [[noreturn]] void fail(const Token& token, const std::string& message) const;
  unsigned number(const char* what, unsigned most);

  void enable_part(const Token& start);
  void carry_part(const Token& start);
  void data_part(const Token& start);
  void write_part(const Token& start);
  Place place(const Token& name);
  void check_memory(const Token& name, const Place& at) const;
  igc::Operand port_of(const Token& token, const Place& at);
  igc::Operand operand();
  void use_x(const Token& token, igc::Operand x);
  void use_y(const Token& token, igc::Operand y);
  void operand_pair();  ///< (x, y)
  void use_function(const Token& token, igc::Function function);
  void use_known(const Token& token, bool known, const char* name) const;

  const std::string& file_;
  const IgcOptions& options_;
  const std::map<std::string, unsigned>& registers_;
  const LoopPlace& place_;
  KnownRegisters& known_;
  KnownRegisters set_;
  const std::vector<Token>* tokens_ = nullptr;
  std::size_t at_ = 0;
  igc::MicroWord word_;
  std::optional<igc::Operand> x_, y_;
  std::optional<igc::Function> function_;
  std::optional<igc::Source> source_;
  bool data_op_ = false;
  std::vector<Place> ports_;
};

}  // namespace dendro::tools
