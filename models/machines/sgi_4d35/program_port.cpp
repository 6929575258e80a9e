#include "models/machines/sgi_4d35/program_port.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::sgi_4d35 {

ProgramPort::ProgramPort(const Spec& spec, const ProgramImage& image, service_block::Services& called)
    : memory(spec.main_bytes), services(called), program(image.program) {
  for (const ProgramImage::Chunk& chunk : image.chunks) {
    DENDRO_CHECK(chunk.physical <= memory.size() && chunk.bytes.size() <= memory.size() - chunk.physical,
                 "0x{:x} + {} bytes", chunk.physical, chunk.bytes.size());
    std::copy(chunk.bytes.begin(), chunk.bytes.end(), memory.begin() + chunk.physical);
  }
}

void start(r3000::State& state, const ProgramImage& image) {
  state.pc = image.start;
  state.next_pc = image.start + 4;
  state.status = 0;
}

ProgramResult result_of(const r3000::State& state, const ProgramPort& port, const Spec& spec) {
  ProgramResult result;
  result.stopped = port.stopped();
  result.pc = state.pc;
  result.return_address = state.r[31];
  result.instructions = state.instructions;
  result.clock_hz = spec.clock_hz;
  return result;
}

}  // namespace dendro::sgi_4d35
