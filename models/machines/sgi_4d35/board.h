#pragma once

#include <cstring>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "models/parts/r3000/r3000_isa.h"
#include "models/parts/service_block/service_block.h"

namespace dendro::sgi_4d35 {

/// Main memory as bytes and the service block: what the processor's addresses reach. All are physical.
struct Board {
  base::ZeroedBytes memory;
  service_block::Services& services;
  const service_block::Program& program;
  service_block::State block;

  Board(std::uint32_t main_bytes, const ProgramImage& image, service_block::Services& calls);

  bool in_memory(std::uint32_t physical) const { return physical < memory.size(); }
  std::uint8_t* page(std::uint32_t physical) {
    return in_memory(physical) ? memory.data() + (physical & r3000::kPageMask) : nullptr;
  }
  /// The aligned word of main memory that holds the address.
  std::uint32_t word(std::uint32_t physical) const {
    std::uint32_t value;
    std::memcpy(&value, memory.data() + (physical & ~3u), 4);
    return __builtin_bswap32(value);
  }
  void put(std::uint32_t physical, std::uint32_t value) {
    value = __builtin_bswap32(value);
    std::memcpy(memory.data() + (physical & ~3u), &value, 4);
  }

  static bool in_block(std::uint32_t physical, unsigned size) {
    return size == 4 && physical - DENDRO_SERVICE_BASE < DENDRO_SERVICE_BYTES;
  }
  /// Devices; has no effect on them. False: nothing answers.
  bool read(std::uint32_t physical, unsigned size, std::uint32_t& value) const {
    return in_block(physical, size) &&
           service_block::read(block, program, static_cast<std::uint32_t>(memory.size()),
                               physical - DENDRO_SERVICE_BASE, value);
  }
  bool write(std::uint32_t physical, unsigned size, std::uint32_t value) {
    return in_block(physical, size) &&
           service_block::write(block, services, memory, physical - DENDRO_SERVICE_BASE, value);
  }
  /// What write() would say, without its effect.
  bool answers_write(std::uint32_t physical, unsigned size) {
    const std::uint32_t offset = physical - DENDRO_SERVICE_BASE;
    service_block::State unchanged = block;
    return in_block(physical, size) &&
           (offset == DENDRO_SERVICE_CALL || service_block::write(unchanged, services, memory, offset, 0));
  }
  /// Pages of main memory that the last call has written.
  template <class Use>
  void changed_pages(const Use& use) const {
    const std::uint64_t end = std::uint64_t{block.last.changed} + block.last.changed_bytes;
    for (std::uint64_t page = block.last.changed & r3000::kPageMask; page < end && block.last.changed_bytes != 0; page += ~r3000::kPageMask + 1)
      use(static_cast<std::uint32_t>(page));
  }
  bool stopped() const { return block.last.stops; }
};

/// The processor as the loader leaves it: at the image's first word, in kernel mode.
void start(r3000::State& state, const ProgramImage& image);

constexpr std::uint64_t kProgressWords = std::uint64_t{1} << 22;  ///< between two calls of MachineOptions::progress

/// What every level says of a run: where it ended, instructions.
ProgramResult result_of(const r3000::State& state, const Board& board, const Spec& spec);

}  // namespace dendro::sgi_4d35
