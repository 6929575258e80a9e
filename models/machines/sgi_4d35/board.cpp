#include "models/machines/sgi_4d35/board.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint32_t kMostStackKept = 64 << 10;

}  // namespace

Board::Board(std::uint32_t main_bytes, const ProgramImage& image, service_block::Services& calls)
    : memory(main_bytes), services(calls), program(image.program) {
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

ProgramResult result_of(const r3000::State& state, const Board& board, const Spec& spec) {
  ProgramResult result;
  result.stopped = board.stopped();
  result.pc = state.pc;
  result.return_address = state.r[31];
  result.stack_pointer = state.r[29];
  const auto bytes = static_cast<std::uint32_t>(board.memory.size());
  const std::uint32_t used = (board.program.mapped ? r3000::kKseg0 : r3000::kKseg0 + bytes) - result.stack_pointer;
  if (used <= DENDRO_STACK_BYTES && used <= bytes) {
    const auto from = board.memory.end() - used;
    result.stack.assign(from, from + std::min(used, kMostStackKept));
  }
  result.instructions = state.instructions;
  result.clock_hz = spec.clock_hz;
  return result;
}

}  // namespace dendro::sgi_4d35
