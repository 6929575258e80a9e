#pragma once

#include <array>
#include <cstdint>

#include "models/parts/service_block/service_block_isa.h"
#include "sim/base/zeroed_bytes.h"

namespace dendro::service_block {

struct CallResult {
  std::uint32_t value = 0;  ///< or the error's number
  bool failed = false;
  bool stops = false;  ///< the machine stops: the program is done
  std::uint32_t changed = 0, changed_bytes = 0;  ///< memory that the call wrote, physical
};

/// What stands behind the calls. Addresses among the arguments are physical and may lie outside of `memory`.
class Services {
 public:
  virtual ~Services() = default;
  virtual CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>& arguments,
                          base::ZeroedBytes& memory) = 0;
};

/// What the monitor asks about the program.
struct Program {
  std::uint32_t entry = 0, stack = 0, first_break = 0;
  bool mapped = true;
};

struct State {
  std::array<std::uint32_t, 4> arguments = {};
  CallResult last;
};

/// True if a register lies there; `offset` from DENDRO_SERVICE_BASE.
bool read(const State& state, const Program& program, std::uint32_t memory_bytes, std::uint32_t offset,
          std::uint32_t& value);
bool write(State& state, Services& services, base::ZeroedBytes& memory, std::uint32_t offset,
           std::uint32_t value);

}  // namespace dendro::service_block
