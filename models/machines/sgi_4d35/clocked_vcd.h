#pragma once

#include <array>
#include <cstdint>

#include "models/machines/machine.h"
#include "sim/trace/vcd.h"

namespace dendro::sgi_4d35 {

class ClockedPipeline;

/// When clock `n` begins: its edges lie at the picosecond next to n / clock_hz.
std::int64_t clock_ps(double clock_hz, std::uint64_t n);

/// The waveform of a clocked 4D/35. At the time of clock n stand the latches as its stages see them. Units:
/// pipeline, registers, fpu, memory.
class ClockedVcd {
 public:
  /// Throws UserError for a file that cannot be written, an unknown unit or an empty window.
  ClockedVcd(const ClockedPipeline& pipeline, const MachineOptions& options, double clock_hz);

  bool wants(std::uint64_t n) const { return n >= from_ && n < to_; }
  void during(std::uint64_t n);  ///< between look() and move()
  void after();                  ///< what the clock was used for
  void close() { writer_.close(); }

 private:
  using Signal = trace::VcdWriter::Signal;
  static constexpr unsigned kStages = 4;

  const ClockedPipeline& pipeline_;
  std::uint64_t from_, to_;
  double clock_hz_;
  trace::VcdWriter writer_;
  Signal if_pc_, if_asks_, if_missing_, cause_, multiplier_;
  std::array<Signal, kStages> live_, pc_, word_;
  Signal alu_result_, mem_address_;
  std::array<Signal, 32> r_, fpr_;
  Signal hi_, lo_, status_, fpu_control_;
  std::array<Signal, 3> unit_;
  Signal memory_state_, memory_address_, entries_;
};

}  // namespace dendro::sgi_4d35
