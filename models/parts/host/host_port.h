#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dendro {

/// What a host program computed between two accesses; the host model turns it into time.
struct Work {
  std::uint64_t flops = 0;          ///< floating-point operations
  std::uint64_t instructions = 0;   ///< other machine instructions
  std::uint64_t program_loads = 0;  ///< programs opened, read and sent by the host's software (not the transfer)
};

/// The machine as its host computer sees it. A host program is one C++ source for all levels of fidelity:
/// plain calls at `function`, a SystemC thread elsewhere. Addresses, function codes and command bits are the
/// machine's own; words are 32 bits. Every call returns when the host could go on.
class HostPort {
 public:
  virtual ~HostPort() = default;

  /// One word by programmed I/O.
  virtual std::uint32_t read(std::uint32_t address, unsigned function) = 0;
  virtual void write(std::uint32_t address, std::uint32_t value, unsigned function) = 0;

  /// `count` words by DMA, the address stepping by `step` per word.
  virtual void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
                      std::uint32_t step = 1) = 0;
  virtual void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                        std::uint32_t step = 1) = 0;

  /// Writes the interface's command register (run, reset, clear); bits are the interface's.
  virtual void command(std::uint32_t bits) = 0;

  /// Sleeps until the machine raises its completion interrupt.
  virtual void wait_interrupt() = 0;

  /// The host computes.
  virtual void compute(const Work& work) = 0;

  /// Names what the host does from here on; time while the machine does not run is booked under this name.
  virtual void phase(std::string_view name) = 0;

  /// A word as a debugger sees it: no time passes, nothing changes. For measuring only.
  virtual std::uint32_t peek(std::uint32_t address, unsigned function) const = 0;

  /// Tells those who measure that the control store holds the program `name` from word `first` on. No time passes.
  virtual void program(std::string_view name, std::uint32_t first) = 0;
};

}  // namespace dendro
