#include "models/machines/rds3000/devices.h"

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::rds3000 {

std::uint32_t read_device(const dr64::Core& memory, const video::State& video, std::uint32_t address,
                          unsigned function) {
  const std::uint32_t a = address & kAddressMask;
  switch (device_at(a)) {
    case Device::Image: return memory.read(a, function);
    case Device::LookUpTable: return video.lut[a - kLookUpTable];
    case Device::LuvoCrossbar: return video.luvo_crossbar;
    case Device::Crossbar: return video.crossbar[a - kCrossbar];
    default: return 0;
  }
}

void Devices::write(std::uint32_t address, std::uint32_t data, unsigned function) {
  const std::uint32_t a = address & kAddressMask;
  switch (device_at(a)) {
    case Device::Image: memory.write(a, data, function); break;
    case Device::LookUpTable: video.lut[a - kLookUpTable] = data & 0x3FFFFFFF; break;
    case Device::LuvoCrossbar: video.luvo_crossbar = data & 0x3F; break;
    case Device::Crossbar: video.crossbar[a - kCrossbar] = data & 0x3F; break;
    case Device::Fbc: video.fbc[a - kFbc] = data; break;
    default: break;
  }
}

std::uint32_t read_processor_board(const ProcessorState& processor, std::uint32_t address) {
  const std::uint32_t a = address & kAddressMask;
  switch (device_at(a)) {
    case Device::ControlStore: {
      const std::size_t word = (a - kControlStore) / 2;
      if (word >= processor.control.size()) return 0;
      return static_cast<std::uint32_t>(processor.control[word] >> (a & 1 ? 32 : 0));
    }
    case Device::Scratchpad: {
      const std::size_t word = a - kScratchpad;
      return word < processor.scratch.size() ? processor.scratch[word] : 0;
    }
    case Device::Processor: return processor.pc | std::uint32_t{processor.page} << 12;
    default: return 0;
  }
}

std::int64_t write_processor_board(ProcessorState& processor, std::uint32_t address, std::uint32_t data) {
  const std::uint32_t a = address & kAddressMask;
  switch (device_at(a)) {
    case Device::ControlStore: {
      const std::size_t word = (a - kControlStore) / 2;
      if (word >= processor.control.size()) return -1;
      const unsigned shift = a & 1 ? 32 : 0;
      const std::uint64_t kept = processor.control[word] & ~(std::uint64_t{0xFFFFFFFF} << shift);
      processor.control[word] = kept | std::uint64_t{data} << shift;
      return static_cast<std::int64_t>(word);
    }
    case Device::Scratchpad:
      if (a - kScratchpad < processor.scratch.size()) processor.scratch[a - kScratchpad] = data;
      return -1;
    case Device::Processor:
      processor.z = data & bps32::kStatusZ;
      processor.n = data & bps32::kStatusN;
      processor.c = data & bps32::kStatusC;
      processor.v = data & bps32::kStatusV;
      processor.host_flag = data & bps32::kStatusHost;
      processor.restart_pc = (data >> 16) & 0xFFF;
      processor.restart_page = (data >> 28) & 7;
      return -1;
    default: return -1;
  }
}

void reset(ProcessorState& processor) {
  processor.pc = processor.restart_pc;
  processor.page = processor.restart_page;
  processor.depth = 0;
  if (processor.product_in > 0) processor.product = processor.pending_product;
  processor.product_in = 0;
  processor.running = false;
  processor.interrupt = false;
}

std::uint32_t peek_at(const ProcessorState& processor, const video::State& video, const dr64::Core& memory,
                      std::uint32_t address, unsigned function) {
  if (on_processor_board(address)) return read_processor_board(processor, address);
  if (device_at(address) == Device::Fbc) return video.fbc[(address & kAddressMask) - kFbc];
  return read_device(memory, video, address, function);
}

void replace_marks(std::map<std::uint32_t, std::string>& marks,
                   const std::map<std::uint32_t, std::string>& program, std::uint32_t first) {
  marks.erase(marks.lower_bound(first), marks.lower_bound(first + bps32::kPageWords));
  for (const auto& [address, name] : program) marks[first + address] = name;
}

}  // namespace dendro::rds3000
