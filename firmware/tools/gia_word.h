#pragma once

#include <string>

#include "firmware/tools/gia_alu.h"
#include "firmware/tools/gia_lexer.h"
#include "firmware/tools/gia_program.h"

namespace dendro::tools {

/// Where the result of the ALU goes.
struct Destinations {
  int reg = -1;              ///< RAM word, -1: none
  bool q = false;            ///< Q takes the result too
  bool pair = false;         ///< `x:q`: register and Q shift together
  int ydst = -1;             ///< Ydst code, -1: none
  std::int64_t scratch = 0;  ///< address for kYSpad
  Token at;                  ///< the last place
  Token y_at;                ///< the place on the Y bus
};

/// One control word in the making: every field has at most one writer. Errors name the place that comes
/// second.
class WordBuilder {
 public:
  WordBuilder(const std::string& file, Program& program) : file_(file), program_(program) {}

  /// Sets a field of the word. Throws SourceError when another transfer has set it.
  void set(const bps32::Field& field, unsigned value, const Token& at);
  /// Gives the imm field a use; the same value twice is one use.
  void set_imm(std::int64_t value, const Fixup& fixup, const Token& at, const std::string& use);
  /// The sequencer's operation with condition and polarity.
  void set_sequencer(unsigned op, unsigned cond, bool inverted, const Token& at);
  /// The one ALU operation. Encoded by finish().
  void set_alu(const Expression& expression, const Destinations& destinations, const Token& at);
  /// `q = q >> 1` and `q = q << 1`, beside an ALU operation that writes no register.
  void set_q_shift(bool left, unsigned fill, const Token& at);

  Micro& micro() { return micro_; }
  /// Encodes the ALU operation and returns the word.
  Micro finish();

 private:
  struct Choice;
  [[noreturn]] void fail(const Token& at, const std::string& message) const;
  void encode_alu();
  void encode_destination();
  void encode_operands();
  bool try_pair(const Operand* r, const Operand* s, unsigned func);
  bool try_choices(const Choice* choices, int count);
  [[noreturn]] void explain(const Choice* choices, int count) const;
  void to_bus(Operand& operand);
  void use_bus(const Operand& operand);

  const std::string& file_;
  Program& program_;
  Micro micro_;
  std::uint64_t set_ = 0;
  bool imm_used_ = false;
  std::string imm_use_;
  bool has_alu_ = false;
  Expression e_;
  Destinations d_;
  bool q_shift_ = false, q_left_ = false;
  unsigned q_fill_ = 0;
  Token q_at_;
};

}  // namespace dendro::tools
