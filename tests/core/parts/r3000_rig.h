#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "models/parts/r3000/r3000.h"

namespace dendro::r3000 {

/// 1 MiB of memory from physical 0; one device word at 0x10000000; a bus error elsewhere.
struct RigPort {
  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(1 << 20);
  std::uint32_t device = 0;
  bool halt = false;

  std::uint8_t* page(std::uint32_t physical) {
    return physical < memory.size() ? memory.data() + (physical & kPageMask) : nullptr;
  }
  bool read(std::uint32_t physical, unsigned, std::uint32_t& value) {
    value = device;
    return physical == 0x10000000;
  }
  bool write(std::uint32_t physical, unsigned, std::uint32_t value) {
    device = value;
    return physical == 0x10000000;
  }
  template <class Use>
  void changed_pages(const Use&) const {}
  bool stopped() const { return halt; }
};

constexpr unsigned kT0 = 8, kT1 = 9, kT2 = 10, kT3 = 11, kT4 = 12, kRa = 31;
constexpr std::uint32_t kCode = 0x80010000, kData = 0x80020000, kHandler = kGeneralVector;

/// Kernel mode, unmapped, vectors in memory, the R3010 usable.
struct Rig {
  RigPort port;
  Core<RigPort> core;

  explicit Rig(std::vector<std::uint32_t> words = {}, const Spec& spec = {}) : core(spec, port) {
    state().status = kStatusCu1;
    jump(kCode);
    put(kCode, words);
  }
  State& state() { return core.state(); }
  std::uint32_t& r(unsigned reg) { return core.state().r[reg]; }
  void jump(std::uint32_t address) {
    state().pc = address;
    state().next_pc = address + 4;
  }
  void put(std::uint32_t address, const std::vector<std::uint32_t>& words) {
    for (std::size_t i = 0; i < words.size(); ++i)
      poke(address + static_cast<std::uint32_t>(4 * i), words[i]);
    core.forget();
  }
  void poke(std::uint32_t address, std::uint32_t word) {
    for (unsigned i = 0; i < 4; ++i)
      port.memory[(address & 0x1FFFFFFF) + i] = static_cast<std::uint8_t>(word >> (24 - 8 * i));
  }
  std::uint32_t peek(std::uint32_t address) const {
    std::uint32_t word = 0;
    for (unsigned i = 0; i < 4; ++i) word = word << 8 | port.memory[(address & 0x1FFFFFFF) + i];
    return word;
  }
  Rig& run(std::uint64_t words) {
    core.run(words);
    return *this;
  }
  unsigned code() { return state().cause >> 2 & 31; }
};

}  // namespace dendro::r3000
