#pragma once

#include <vector>

#include "models/machines/pixel_planes/macro.h"

namespace dendro::pixel_planes {

/// What registers stand for in a pattern: the number of bits of a field, and where fields begin.
enum Role : std::uint8_t { kBits, kField0, kField1, kField2, kRoles };

constexpr unsigned kNone = 0xFF;  ///< the pattern has no such field
constexpr unsigned kFlag = 1;     ///< only bit 0 of the field is used

/// A micro-program that word arithmetic knows; register numbers in its words are roles.
struct Pattern {
  MacroKind kind;
  std::vector<unsigned> bits;  ///< per field: 0 as many as role kBits says, else so many, kNone or kFlag
  bool expression;
  std::vector<igc::MicroWord> words;
};

const std::vector<Pattern>& patterns();

}  // namespace dendro::pixel_planes
