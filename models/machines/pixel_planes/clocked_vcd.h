#pragma once

#include <cstdint>

#include "models/machines/machine.h"
#include "sim/trace/vcd.h"

namespace dendro::pixel_planes {

class ClockedEngine;
enum class ClockedCause : std::uint8_t;

/// The waveform of a clocked Pixel-Planes. At the time of clock n stand the registers as they were before it
/// and the signals during it. Units: host, translator, controller, tree, array.
class ClockedVcd {
 public:
  /// Throws UserError for a file that cannot be written, an unknown unit or an empty window.
  ClockedVcd(ClockedEngine& engine, const MachineOptions& options);

  bool wants(std::int64_t n) const { return n >= from_ && n < to_; }
  void before(std::int64_t n);
  void after(ClockedCause cause);
  void close() { writer_.close(); }

 private:
  using Signal = trace::VcdWriter::Signal;

  ClockedEngine& engine_;
  std::int64_t from_, to_, tick_ps_;
  trace::VcdWriter writer_;
  Signal fifo_words_, host_waits_room_, host_waits_idle_, idle_;
  Signal state_, header_;
  Signal running_, address_, turn_, cause_;
  Signal a_, b_, c_, clear_;
  Signal function_, x_, y_, data_, source_, ports_, address_a_, address_b_, uses_tree_, enabled_;
};

}  // namespace dendro::pixel_planes
