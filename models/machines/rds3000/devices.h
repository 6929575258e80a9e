#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "models/machines/rds3000/rds3000_map.h"
#include "models/machines/rds3000/rds3000_spec.h"
#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/dr64/dr64.h"

namespace dendro::rds3000 {

/// A word of a board other than the processor, as the bus reads it: 0 where nothing answers or can be read.
std::uint32_t read_device(const dr64::Core& memory, const video::State& video, std::uint32_t address,
                          unsigned function);

/// The boards on the bus other than the processor: what their words are.
struct Devices {
  dr64::Core memory;
  video::State video;

  explicit Devices(const Spec& spec) : memory(spec.memory), video(video::power_on(spec.video.mode)) {}

  std::uint32_t read(std::uint32_t address, unsigned function) const {
    return read_device(memory, video, address, function);
  }
  void write(std::uint32_t address, std::uint32_t data, unsigned function);
};

/// The FBC registers that set the raster: a write that changes it restarts it.
constexpr bool sets_raster(std::uint32_t address) {
  const std::uint32_t a = address & kAddressMask;
  return a == kFbc + 1 || a == kFbc + 4 || a == kFbc + 5;
}

/// Whether an address belongs to the processor board: control store, scratchpad, status.
constexpr bool on_processor_board(std::uint32_t address) {
  const Device device = device_at(address);
  return device == Device::ControlStore || device == Device::Scratchpad || device == Device::Processor;
}

/// The processor board as the host reaches it over the bus.
std::uint32_t read_processor_board(const ProcessorState& processor, std::uint32_t address);
/// Returns the index of the control word that changed, or -1.
std::int64_t write_processor_board(ProcessorState& processor, std::uint32_t address, std::uint32_t data);

/// A word as the bus would read it, or for the FBC, whose registers cannot be read, what it holds.
std::uint32_t peek_at(const ProcessorState& processor, const video::State& video, const dr64::Core& memory,
                      std::uint32_t address, unsigned function);

/// The page of the control store that begins at word `first` gets the marks of another program.
void replace_marks(std::map<std::uint32_t, std::string>& marks,
                   const std::map<std::uint32_t, std::string>& program, std::uint32_t first);

/// Reset from the interface's command register.
void reset(ProcessorState& processor);

}  // namespace dendro::rds3000
