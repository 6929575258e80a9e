#pragma once

#include <string>

#include "models/parts/igc/igc_isa.h"

namespace dendro::igc {

/// What the fields of a word stand for in its text.
struct WordNames {
  std::string port_a, port_b, constant;
};

/// A word as statements of the assembler's language, "idle" when it does nothing. The field named first takes port a.
std::string text_of(const MicroWord& word, const WordNames& names);

/// A word that the array is sent: as above, a bit of the memory as m[12].
std::string text_of(const ArrayWord& word);

/// A command: "program at word 18, fraction 10, guard 2, A 512, B 0, C -3", or "register 4 = 40".
std::string text_of(const Command& command);

}  // namespace dendro::igc
