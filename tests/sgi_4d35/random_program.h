#pragma once

#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {

/// A seeded program of all kinds of words that always ends: branches lead forward inside a loop of a few
/// passes, exceptions skip the word. It begins with the registers' first values; pointers to cached,
/// conflicting, uncached and mapped data stay as they are.
Memory random_program(std::uint32_t seed, unsigned words, unsigned passes);

/// Parameters inside the ranges that the machine accepts.
Spec random_spec(std::uint32_t seed);

}  // namespace dendro::sgi_4d35
