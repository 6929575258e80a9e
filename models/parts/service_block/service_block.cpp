#include "models/parts/service_block/service_block.h"

namespace dendro::service_block {

bool read(const State& state, const Program& program, std::uint32_t memory_bytes, std::uint32_t offset,
          std::uint32_t& value) {
  switch (offset) {
    case DENDRO_SERVICE_RESULT:
      value = state.last.value;
      return true;
    case DENDRO_SERVICE_FAILED:
      value = state.last.failed;
      return true;
    case DENDRO_SERVICE_ENTRY:
      value = program.entry;
      return true;
    case DENDRO_SERVICE_STACK:
      value = program.stack;
      return true;
    case DENDRO_SERVICE_BREAK:
      value = program.first_break;
      return true;
    case DENDRO_SERVICE_MEMORY:
      value = memory_bytes;
      return true;
    case DENDRO_SERVICE_MAPPED:
      value = program.mapped;
      return true;
    default:
      return false;
  }
}

bool write(State& state, Services& services, base::ZeroedBytes& memory, std::uint32_t offset,
           std::uint32_t value) {
  if (offset == DENDRO_SERVICE_CALL) {
    state.last = services.call(value, state.arguments, memory);
    return true;
  }
  const std::uint32_t index = (offset - DENDRO_SERVICE_ARGUMENT) / 4;
  if (offset < DENDRO_SERVICE_ARGUMENT || offset % 4 != 0 || index >= state.arguments.size()) return false;
  state.arguments[index] = value;
  return true;
}

}  // namespace dendro::service_block
