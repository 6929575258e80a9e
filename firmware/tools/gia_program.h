#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/tools/ucode.h"
#include "models/parts/bps32/bps32_isa.h"

/// What the parser makes of a source: microinstructions in order, with what is not known before layout left
/// open.
namespace dendro::tools {

/// What the imm field will hold once addresses are known.
struct Fixup {
  enum Kind : std::uint8_t { kNone, kLabel, kPool };
  Kind kind = kNone;
  int index = 0;   ///< of the label or the pool constant
  int offset = 0;  ///< added to a label's address

  bool operator==(const Fixup& o) const { return kind == o.kind && index == o.index && offset == o.offset; }
};

struct Micro {
  std::uint64_t word = bps32::nop();
  Fixup imm;
  int line = 0;
  int column = 0;
  bool verbatim = false;       ///< `word 0x...`: never merged or moved
  bool old_condition = false;  ///< `old(cond)`: the test of the state before this word is meant
  bool old_product = false;    ///< `old(product)`: reading before the new product is there is meant
  bool numeric_target =
      false;  ///< branches to a number or to label + number, so words must stay where they are
};

struct Label {
  std::string name;  ///< empty: made by a structured statement
  int at = -1;       ///< index of the micro it stands before; -1: not defined
  int line = 0;      ///< of its definition, or of its first use while not defined
  int column = 0;
};

struct Program {
  std::string file;
  std::vector<Micro> micros;
  std::vector<Label> labels;
  std::vector<std::uint32_t> pool;  ///< constants that do not fit imm
  std::map<std::string, ScratchSymbol> scratch;
  std::map<std::uint32_t, std::uint32_t> scratch_data;
  int entry_label = -1;
  std::uint32_t entry_address = 0;  ///< when there is no entry label
  bool literal = false;             ///< a disassembly: words stay as they are, no static checks
  std::string literal_pack;
  int literal_multiply_ticks = 0;
};

/// The tests of old flags, and carry-ins that read the latched C.
inline bool tests_flags(unsigned cond) {
  return (cond >= bps32::kZero && cond <= bps32::kLessEqual) || cond == bps32::kLowerEqual;
}

/// True when the sequencer operation of the word depends on its condition.
bool uses_condition(std::uint64_t word);
/// True when the sequencer operation can use its D input (imm or Y).
bool uses_sequencer_input(std::uint64_t word);
/// True when the word's next address can be other than the next word, or the word stops the processor.
bool ends_block(std::uint64_t word);
/// True when the word always goes elsewhere than to the next word (a call counts as coming back).
bool never_falls_through(std::uint64_t word);
/// True when the word writes RAM[B], which then takes Y.
bool writes_ram(std::uint64_t word);
bool latches_flags(std::uint64_t word);
bool reads_product(std::uint64_t word);
bool starts_multiply(std::uint64_t word);

}  // namespace dendro::tools
