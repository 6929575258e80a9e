#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"

namespace dendro::pixel_planes {

/// One bit of every pixel: pixel p = y * width + x is bit p % 64 of word p / 64.
using Plane = std::vector<std::uint64_t>;

/// The pixels. E, C and D mean nothing between two commands (see models/parts/igc/README.md).
struct ArrayState {
  std::vector<Plane> memory;  ///< by bit address
  Plane enable, carry, data;

  explicit ArrayState(const Spec& spec)
      : memory(static_cast<std::size_t>(spec.array.memory_bits), Plane(static_cast<std::size_t>(spec.pixels()) / 64)),
        enable(memory[0]), carry(memory[0]), data(memory[0]) {}
};

/// What the video part sends to the monitor: 24 bits from `base` up, red in the lowest 8; the upper left corner of the array.
struct VideoState {
  unsigned base = 0;
  int width = 0, height = 0;  ///< 0: the whole array
};

/// The renderers that a word of the host goes to: the one with this number, or all when none has it.
struct Selection {
  std::uint32_t number = kAllRenderers;

  std::size_t first(std::size_t count) const { return number < count ? number : 0; }
  std::size_t end(std::size_t count) const { return number < count ? number + 1 : count; }
};

struct ControllerCounters {
  std::uint64_t busy = 0, stall_refresh = 0, stall_video = 0, stall_translator = 0, stall_drain = 0, idle = 0;
};

struct FifoCounters {
  std::uint64_t words = 0, commands = 0, full_clocks = 0;  ///< full_clocks: a host word waited
};

}  // namespace dendro::pixel_planes
