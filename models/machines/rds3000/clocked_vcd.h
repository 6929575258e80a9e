#pragma once

#include <array>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/rds3000/clocked_processor.h"
#include "sim/trace/vcd.h"

namespace dendro::rds3000 {

class ClockedEngine;

/// The waveform of a clocked RDS-3000. At the time of tick n stand the registers as they were before it and
/// the signals during it. Units: processor, bus, frame_memory, video, host.
class ClockedVcd {
 public:
  /// Throws UserError for a file that cannot be written, an unknown unit or an empty window.
  ClockedVcd(const ClockedEngine& engine, const MachineOptions& options);

  bool wants(std::int64_t n) const { return n >= from_ && n < to_; }
  void before(std::int64_t n);                     ///< registers, display, cards
  void after(std::int64_t n, ClockedCause cause);  ///< what the tick was used for
  void close() { writer_.close(); }

 private:
  using Signal = trace::VcdWriter::Signal;

  void add_processor();
  void add_cards();

  const ClockedEngine& engine_;
  std::int64_t from_, to_, tick_ps_;
  trace::VcdWriter writer_;

  Signal running_, pc_, page_, word_, flags_, q_, f_, y_, sar_, product_, cause_, counter_;
  Signal address_, write_data_, read_data_;
  std::array<Signal, 16> ram_;
  Signal owner_, bus_address_, bus_data_, bus_function_, grant_;
  std::vector<Signal> card_busy_, card_waiting_;
  Signal blank_, field_, line_;
  Signal request_, ack_, interrupt_;
};

}  // namespace dendro::rds3000
