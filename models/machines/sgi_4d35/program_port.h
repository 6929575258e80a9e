#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "models/parts/r3000/r3000_state.h"

namespace dendro::sgi_4d35 {

/// Main memory with a program in it, and the service block: what the core sees of the machine (PortConcept).
struct ProgramPort {
  std::vector<std::uint8_t> memory;
  service_block::Services& services;
  const service_block::Program& program;
  service_block::State block;

  ProgramPort(const Spec& spec, const ProgramImage& image, service_block::Services& called);

  std::uint8_t* page(std::uint32_t physical) {
    return physical < memory.size() ? memory.data() + (physical & r3000::kPageMask) : nullptr;
  }
  static bool in_block(std::uint32_t physical, unsigned size) {
    return size == 4 && physical - DENDRO_SERVICE_BASE < DENDRO_SERVICE_BYTES;
  }
  bool read(std::uint32_t physical, unsigned size, std::uint32_t& value) {
    return in_block(physical, size) &&
           service_block::read(block, program, static_cast<std::uint32_t>(memory.size()),
                               physical - DENDRO_SERVICE_BASE, value);
  }
  bool write(std::uint32_t physical, unsigned size, std::uint32_t value) {
    return in_block(physical, size) &&
           service_block::write(block, services, memory, physical - DENDRO_SERVICE_BASE, value);
  }
  bool stopped() const { return block.last.stops; }
};

/// The processor as the loader leaves it: at the image's first word, in kernel mode.
void start(r3000::State& state, const ProgramImage& image);

/// What every level says of a run: where it ended, instructions.
ProgramResult result_of(const r3000::State& state, const ProgramPort& port, const Spec& spec);

}  // namespace dendro::sgi_4d35
