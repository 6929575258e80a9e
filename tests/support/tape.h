#pragma once

#include <utility>
#include <vector>

#include "models/parts/host/host_port.h"

namespace dendro {

/// Keeps what a host program writes; reads give 0.
class Tape : public HostPort {
 public:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> words;  ///< address and value, in order

  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t address, std::uint32_t value, unsigned) override {
    words.emplace_back(address, value);
  }
  void dma_to(std::uint32_t address, const std::uint32_t* values, std::size_t count, unsigned,
              std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i)
      words.emplace_back(address + static_cast<std::uint32_t>(i) * step, values[i]);
  }
  void dma_from(std::uint32_t, std::uint32_t*, std::size_t, unsigned, std::uint32_t) override {}
  void command(std::uint32_t) override {}
  void wait_interrupt() override {}
  void compute(const Work&) override {}
  void phase(std::string_view) override {}
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }
  void program(std::string_view, std::uint32_t) override {}
};

}  // namespace dendro
