#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "tests/support/in_child.h"
#include "tests/support/systemc_main.h"

/// What the tests of the clocked Pixel-Planes share: a small machine, hand-assembled programs, one simulation
/// per child process.
namespace dendro::pixel_planes {

/// 64 x 64 pixels of 32 bits, 10 MHz, no stolen clocks, a host that sends a word every 4 clocks.
inline Spec small() {
  Spec s;
  s.array.width = s.array.height = 64;
  s.array.memory_bits = 32;
  return s;
}

using Program = std::vector<igc::MicroWord>;

/// M[0 .. bits) := T, in all pixels, with `idle` words in front.
inline Program store_program(unsigned bits, unsigned idle = 0) {
  Program p(idle);
  igc::MicroWord enable;
  enable.function = igc::Function::kSetEnable;
  p.push_back(enable);
  igc::MicroWord zeros;
  zeros.tree = zeros.loop_end = true;
  zeros.loop = igc::LoopCount::kGap;
  p.push_back(zeros);
  igc::MicroWord skip = zeros;
  skip.loop = igc::LoopCount::kFraction;
  p.push_back(skip);
  igc::MicroWord store;
  store.tree = store.write_a = store.indexed_a = store.loop_end = true;
  store.x = igc::Operand::kTree;
  store.loop = igc::LoopCount::kNumber;
  store.loop_number = static_cast<std::uint8_t>(bits);
  p.push_back(store);
  igc::MicroWord end;
  end.end = true;
  p.push_back(end);
  return p;
}

inline std::uint32_t single(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline std::vector<std::uint32_t> plane_command(unsigned entry, float a, float b, float c,
                                                unsigned fraction = 0) {
  igc::Header h;
  h.entry = entry;
  h.fraction = fraction;
  h.expression = true;
  return {igc::pack(h), single(a), single(b), single(c)};
}

inline std::uint32_t register_write(unsigned number, unsigned value) {
  igc::Header h;
  h.register_write = true;
  h.register_number = number, h.value = value;
  return igc::pack(h);
}

inline std::int64_t now_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }

class Rig {
 public:
  explicit Rig(const Spec& s, const MachineOptions& options = {}) : spec(s) {
    sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
    engine = std::make_unique<ClockedEngine>("machine", spec, options);
  }
  void load(HostPort& host, const Program& program, unsigned entry = 0) const {
    for (std::uint32_t i = 0; i < program.size(); ++i) {
      const std::uint64_t word = igc::pack(program[i]);
      host.write(2 * (entry + i), static_cast<std::uint32_t>(word), 0);
      host.write(2 * (entry + i) + 1, static_cast<std::uint32_t>(word >> 32), 0);
    }
  }
  void send(HostPort& host, const std::vector<std::uint32_t>& words) const {
    host.dma_to(kFifo, words.data(), words.size(), 0, 1);
  }
  /// M[low .. low + bits) as a signed number.
  std::int64_t number(unsigned x, unsigned y, unsigned low, unsigned bits) {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < bits; ++i) value |= std::uint64_t{engine->planes().memory(low + i, x, y)} << i;
    return static_cast<std::int64_t>(value << (64 - bits)) >> (64 - bits);
  }
  std::uint64_t total() const {
    const ControllerCounters& c = engine->controller_counters();
    return c.busy + c.stall_refresh + c.stall_video + c.stall_translator + c.stall_drain + c.idle;
  }

  Spec spec;
  std::unique_ptr<ClockedEngine> engine;
};

}  // namespace dendro::pixel_planes
