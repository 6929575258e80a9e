#pragma once

#include <cstdint>
#include <string>

namespace dendro::testing {

/// A random source in the microassembler's language that passes its static checks and halts: straight-line
/// stretches of every kind of transfer, with branches, counted loops and calls between them when
/// `structured`.
std::string random_source(std::uint32_t seed, int multiply_ticks, bool structured);

}  // namespace dendro::testing
