#include "tests/firmware/assembler/assembler_machine.h"

#include <random>

#include "models/parts/bps32/bps32.h"
#include "models/parts/bps32/bps32_execute.h"

namespace dendro::testing {
namespace {

struct Bus {
  MachineRun& run;
  std::map<std::uint32_t, std::uint32_t> memory;

  bool bus_busy() const { return false; }
  bool data_ready() const { return true; }
  bool vertical_blank() const { return false; }
  bool field() const { return false; }

  void start_read(std::uint32_t address, unsigned function) {
    const auto it = memory.find(address);
    const std::uint32_t data = it != memory.end() ? it->second : address * 2654435761u + 12345;
    run.state.read_data = data;
    run.accesses.emplace_back(address, function, data, 0);
  }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) {
    memory[address] = data;
    run.accesses.emplace_back(address, function, data, 1);
  }
};

}  // namespace

MachineRun run_program(const tools::Ucode& ucode, bps32::ProcessorState state, int limit) {
  MachineRun run;
  run.state = std::move(state);
  for (const auto& [at, value] : ucode.scratch_data) run.state.scratch[at] = value;
  run.state.pc = static_cast<std::uint16_t>(ucode.entry);
  run.state.running = true;
  bps32::ProcessorSpec spec;
  spec.multiply_ticks = ucode.multiply_ticks;
  std::vector<bps32::Decoded> decoded;
  for (const std::uint64_t w : ucode.words) decoded.push_back(bps32::decode(w));
  Bus bus{run, {}};
  while (run.state.running && run.words < limit && run.state.pc < decoded.size()) {
    bps32::execute(run.state, decoded[run.state.pc], spec, bus);
    ++run.words;
  }
  run.halted = !run.state.running;
  return run;
}

bps32::ProcessorState random_state(std::uint32_t seed) {
  std::mt19937 random(seed);
  bps32::ProcessorState s;
  for (auto& r : s.ram) r = static_cast<std::uint32_t>(random());
  s.q = static_cast<std::uint32_t>(random());
  const auto bits = random();
  s.z = bits & 1;
  s.n = bits & 2;
  s.c = bits & 4;
  s.v = bits & 8;
  s.divide_sign = bits & 16;
  s.counter = bits >> 8 & 0xFFF;
  s.sar = random() & 0x1FFF;
  s.bus_address = random() & 0xFFFFFF;
  s.write_data = static_cast<std::uint32_t>(random());
  s.read_data = static_cast<std::uint32_t>(random());
  s.mul_x = static_cast<std::uint16_t>(random());
  s.mul_y = static_cast<std::uint16_t>(random());
  s.product = s.pending_product = static_cast<std::uint32_t>(random());
  s.scratch.resize(8192);
  for (auto& w : s.scratch) w = static_cast<std::uint32_t>(random());
  return s;
}

}  // namespace dendro::testing
