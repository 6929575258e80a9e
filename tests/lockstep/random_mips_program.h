#pragma once

#include <cstdint>

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// A machine with timing parameters drawn from their ranges, small caches among them.
Spec random_spec(std::uint32_t seed);

/// A program in kernel mode that ends by a call of the service block: all opcodes with dependences in every slot,
/// branches and loops, floating point that overlaps and interrupts, data that conflicts in the caches, mapped,
/// uncached and isolated accesses, faults in and out of slots. Its code lies in kseg0, kseg1 or mapped pages. Left
/// out is what the data sheets leave undefined.
ProgramImage random_program(std::uint32_t seed);

/// Ends the machine at exit, answers 0 to everything else.
struct ExitService : service_block::Services {
  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>& arguments,
                                 std::vector<std::uint8_t>& memory) override;
};

}  // namespace dendro::sgi_4d35
