#include "models/machines/sgi_4d35/function.h"

#include <algorithm>

#include "models/parts/r3000/r3000.h"
#include "sim/base/check.h"

namespace dendro::sgi_4d35 {
namespace {

struct Port {
  std::vector<std::uint8_t> memory;
  service_block::Services& services;
  const service_block::Program& program;
  service_block::State block;

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

}  // namespace

ProgramResult run_function(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit) {
  Port port{std::vector<std::uint8_t>(spec.main_bytes), services, image.program, {}};
  for (const ProgramImage::Chunk& chunk : image.chunks) {
    DENDRO_CHECK(
        chunk.physical <= port.memory.size() && chunk.bytes.size() <= port.memory.size() - chunk.physical,
        "0x{:x} + {} bytes", chunk.physical, chunk.bytes.size());
    std::copy(chunk.bytes.begin(), chunk.bytes.end(), port.memory.begin() + chunk.physical);
  }
  r3000::Core<Port> core(spec.processor, port);
  core.state().pc = image.start;
  core.state().next_pc = image.start + 4;
  core.state().status = 0;
  core.run(limit);
  const r3000::State& state = core.state();
  ProgramResult result;
  result.stopped = port.stopped();
  result.pc = state.pc;
  result.return_address = state.r[31];
  result.instructions = state.instructions;
  result.clock_hz = spec.clock_hz;
  result.units.push_back({"sgi_4d35.processor",
                          {{"instructions", state.instructions},
                           {"exceptions", state.exceptions},
                           {"tlb_refills", state.tlb_refills}}});
  return result;
}

}  // namespace dendro::sgi_4d35
