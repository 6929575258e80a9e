#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"
#include "models/parts/igc/igc_isa.h"

namespace dendro::pixel_planes {

/// Applies the array words of one command to all pixels, one after another, with the tree's bits in closed form: what any
/// micro-program does to the memory, clock by clock. Words that cannot change it are left out, so E, C and D are not what they
/// are in the machine. Streams must not spill into each other. With `only` no other words of 64 pixels are looked at: the command must
/// not change them.
void apply_words(const Spec& spec, const igc::Command& command, const std::vector<igc::ArrayWord>& words,
                 ArrayState& state, const std::vector<std::uint32_t>* only = nullptr);

/// An array word and the bit of the expression that it meets; -1: none, or a leading zero.
struct ArrayStep {
  igc::ArrayWord word;
  int bit = -1;
  bool last_enable = false;  ///< nothing but the memory behind it matters, and no word behind it sets E again
};

/// Applies words with the bits of one expression to all pixels, or to `only` those, exactly: memory, E, C and D.
void apply_steps(const Spec& spec, const igc::Command& expression, const std::vector<ArrayStep>& steps, ArrayState& state,
                 const std::vector<std::uint32_t>* only = nullptr);

/// Bit `bit` of A·x + B·y + C, as a stream of two's complement without end.
bool expression_bit(const igc::Command& command, int x, int y, unsigned bit);

}  // namespace dendro::pixel_planes
