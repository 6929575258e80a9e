#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"

/// A small pixel array without time, for host programs.
namespace dendro::test {

pixel_planes::Spec square_array(int side);

/// The micro-programs in these files, one behind the other.
lib::IgcPrograms assemble_files(const std::vector<std::string>& paths, const std::map<std::string, unsigned>& registers,
                                int memory_bits = 72);

/// A host whose words go to an array without time; counts the words that programs send to the array.
class ArrayPort : public HostPort {
 public:
  explicit ArrayPort(const pixel_planes::Spec& spec, bool lazy = false) : spec_(spec), device_(spec, lazy) {}

  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t address, std::uint32_t value, unsigned) override {
    if (const auto done = device_.write(address, value)) clocks += done->words;
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) write(address + static_cast<std::uint32_t>(i) * step, words[i], function);
  }
  void dma_from(std::uint32_t, std::uint32_t*, std::size_t, unsigned, std::uint32_t) override {}
  void command(std::uint32_t) override {}
  void wait_interrupt() override {}
  void compute(const Work& work) override { flops += work.flops; }
  void phase(std::string_view) override {}

  /// A field of a pixel.
  std::uint32_t field(int x, int y, unsigned low, unsigned bits) {
    return device_.peek(static_cast<std::uint32_t>(y * spec_.array.width + x), low) & ((std::uint64_t{1} << bits) - 1);
  }
  const std::vector<pixel_planes::Plane>& memory() { return device_.engine().bits().memory; }
  const pixel_planes::WordCounters& counters() { return device_.engine().counters(); }
  Picture picture() { return device_.picture(); }
  std::uint32_t peek(std::uint32_t pixel, unsigned low) const override { return device_.peek(pixel, low); }
  void program(std::string_view, std::uint32_t) override {}

  std::uint64_t clocks = 0, flops = 0;

 private:
  pixel_planes::Spec spec_;
  mutable pixel_planes::Device device_;  // reading brings waiting tiles up to date
};

}  // namespace dendro::test
