#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/tools/gia_include.h"
#include "firmware/tools/ucode.h"

/// The microassembler of the BPS32. docs/microassembler.md describes the language.
namespace dendro::tools {

struct AssembleOptions {
  std::string pack = "none";  ///< "none": a line is a word; "full": words are merged where nothing changes
  int multiply_ticks = 2;     ///< words from a start to its product, 1 to 64
  unsigned scratch_words = 8192;  ///< size of the scratchpad, 1 to 8,192
  /// Words without effect are inserted where a product would be taken, or a multiplication started, too
  /// early; without it that is an error. A source that branches to numbers cannot be filled.
  bool fill_products = false;
  unsigned control_words = 4096;  ///< words that a program may have, at most one page of 4,096
  IncludeReader include;          ///< finds what the source includes; empty: nothing can be included
};

/// An assembled program with what a listing needs.
struct Assembly {
  Ucode ucode;
  std::string file;                     ///< name of the source
  std::vector<std::string> source;      ///< its lines, those of included files behind them
  std::vector<std::vector<int>> lines;  ///< per word: the source lines (from 1) it was made of, ascending
};

/// Assembles a source text. `file_name` is only named in errors. Throws UserError `FILE:LINE:COLUMN:
/// message`.
Assembly assemble(std::string_view source, const std::string& file_name, const AssembleOptions& options = {});

/// Addresses, 64-bit words, source lines, and per straight-line stretch its cost in ticks (stalls not
/// included).
std::string listing(const Assembly& assembly);

}  // namespace dendro::tools
