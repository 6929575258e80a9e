#include "models/machines/sgi_4d35/clocked_vcd.h"

#include <fmt/format.h>

#include <cmath>

#include "models/machines/sgi_4d35/clocked_pipeline.h"

namespace dendro::sgi_4d35 {
namespace {

trace::VcdWindow window_of(const MachineOptions& options, double clock_hz) {
  const auto at = [&](std::int64_t clock) {
    const double ps = static_cast<double>(clock) * 1e12 / clock_hz;
    return ps > 9e18 ? INT64_MAX : clock_ps(clock_hz, static_cast<std::uint64_t>(clock));
  };
  trace::VcdWindow window;
  window.from = at(options.vcd_from);
  window.to = at(options.vcd_to);
  window.units = options.vcd_units;
  return window;
}

}  // namespace

std::int64_t clock_ps(double clock_hz, std::uint64_t n) {
  return static_cast<std::int64_t>(std::llround(static_cast<double>(n) * 1e12 / clock_hz));
}

ClockedVcd::ClockedVcd(const ClockedPipeline& pipeline, const MachineOptions& options, double clock_hz)
    : pipeline_(pipeline),
      from_(static_cast<std::uint64_t>(options.vcd_from)),
      to_(static_cast<std::uint64_t>(options.vcd_to)),
      clock_hz_(clock_hz),
      writer_(options.vcd_file, window_of(options, clock_hz)) {
  static const char* const kNames[kStages] = {"rd", "alu", "mem", "wb"};
  static const char* const kUnits[] = {"adder", "multiplier", "divider"};
  if_asks_ = writer_.add("pipeline", "if.asks", 1);
  if_pc_ = writer_.add("pipeline", "if.pc", 32);
  if_missing_ = writer_.add("pipeline", "if.missing", 1);
  for (unsigned i = 0; i < kStages; ++i) {
    live_[i] = writer_.add("pipeline", fmt::format("{}.live", kNames[i]), 1);
    pc_[i] = writer_.add("pipeline", fmt::format("{}.pc", kNames[i]), 32);
    word_[i] = writer_.add("pipeline", fmt::format("{}.word", kNames[i]), 32);
  }
  alu_result_ = writer_.add("pipeline", "alu.result", 32);
  mem_address_ = writer_.add("pipeline", "mem.address", 32);
  cause_ = writer_.add("pipeline", "cause", 4);
  for (unsigned i = 0; i < 32; ++i) r_[i] = writer_.add("registers", fmt::format("r{}", i), 32);
  hi_ = writer_.add("registers", "hi", 32);
  lo_ = writer_.add("registers", "lo", 32);
  status_ = writer_.add("registers", "status", 32);
  multiplier_ = writer_.add("registers", "multiplier_left", 7);
  for (unsigned i = 0; i < 32; ++i) fpr_[i] = writer_.add("fpu", fmt::format("f{}", i), 32);
  fpu_control_ = writer_.add("fpu", "control", 32);
  for (unsigned i = 0; i < 3; ++i) unit_[i] = writer_.add("fpu", fmt::format("{}_left", kUnits[i]), 7);
  memory_state_ = writer_.add("memory", "state", 2);
  memory_address_ = writer_.add("memory", "address", 32);
  entries_ = writer_.add("memory", "write_buffer_entries", 7);
  writer_.start("1 ps");
}

void ClockedVcd::during(std::uint64_t n) {
  writer_.at(clock_ps(clock_hz_, n));
  const ClockedFetch& fetch = pipeline_.fetch();
  writer_.set(if_asks_, fetch.begun);
  if (fetch.begun) writer_.set(if_pc_, fetch.pc);
  writer_.set(if_missing_, fetch.begun && pipeline_.caches().fetch_missing());
  const ClockedSlot* const stages[kStages] = {&pipeline_.rd(), &pipeline_.alu(), &pipeline_.mem(),
                                              &pipeline_.wb()};
  for (unsigned i = 0; i < kStages; ++i) {
    writer_.set(live_[i], stages[i]->live);
    writer_.set(pc_[i], stages[i]->pc);
    writer_.set(word_[i], stages[i]->word);
  }
  writer_.set(alu_result_, pipeline_.alu().result);
  writer_.set(mem_address_, pipeline_.mem().address);
  const r3000::State& s = pipeline_.state();
  for (unsigned i = 0; i < 32; ++i) writer_.set(r_[i], s.r[i]);
  for (unsigned i = 0; i < 32; ++i) writer_.set(fpr_[i], s.fpu.r[i]);
  writer_.set(hi_, s.hi);
  writer_.set(lo_, s.lo);
  writer_.set(status_, s.status);
  writer_.set(fpu_control_, s.fpu.control);
  writer_.set(multiplier_, pipeline_.multiplier_left());
  for (unsigned i = 0; i < 3; ++i) writer_.set(unit_[i], pipeline_.units().left(static_cast<r3010::Unit>(i)));
}

void ClockedVcd::after() {
  writer_.set(cause_, static_cast<std::uint64_t>(pipeline_.cause()));
  writer_.set(memory_state_, pipeline_.bus().state_number());
  writer_.set(memory_address_, pipeline_.bus().address());
  writer_.set(entries_, pipeline_.bus().entries());
}

}  // namespace dendro::sgi_4d35
