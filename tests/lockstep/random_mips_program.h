#pragma once

#include <cstdint>

#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {

/// A program in kernel mode that ends by a call of the service block: all opcodes with dependences in every slot,
/// branches and loops, floating point that overlaps and interrupts, data that conflicts in the caches, mapped,
/// uncached and isolated accesses, faults in and out of slots. Its code lies in kseg0, kseg1 or mapped pages. Left
/// out is what the data sheets leave undefined.
struct CornerProgram {
  Memory memory;
  std::uint32_t start = 0;
};
CornerProgram corner_program(std::uint32_t seed);

/// Timing parameters drawn from their ranges, caches of 1 to 8 KB.
Spec corner_spec(std::uint32_t seed);

}  // namespace dendro::sgi_4d35
