#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "models/machines/rds3000/clocked.h"
#include "tests/support/in_child.h"
#include "tests/support/systemc_main.h"

/// What the tests of the clocked RDS-3000 share: words by field, a host, one simulation per child process.
namespace dendro::rds3000 {

using Settings = std::vector<std::pair<bps32::Field, unsigned>>;

/// A control word: one that does nothing, with these fields set.
inline std::uint64_t word(const Settings& fields) {
  std::uint64_t w = bps32::nop();
  for (const auto& [field, value] : fields) w = bps32::put(w, field, value);
  return w;
}
/// Fields that pass the immediate to the Y bus.
inline Settings immediate(unsigned imm, unsigned ydst, Settings more = {}) {
  more.insert(more.end(), {{bps32::kImm, imm},
                           {bps32::kDsrc, bps32::kDImm},
                           {bps32::kEa, 1},
                           {bps32::kFunc, bps32::kPassR},
                           {bps32::kYdst, ydst}});
  return more;
}

class Host : public sc_core::sc_module {
 public:
  Host(sc_core::sc_module_name name, std::function<void(Host&)> body)
      : sc_module(name), body_(std::move(body)) {
    SC_HAS_PROCESS(Host);
    SC_THREAD(go);
  }
  void sleep_until_ps(std::int64_t t) {
    const auto now = static_cast<std::int64_t>(sc_core::sc_time_stamp().value());
    if (t > now) wait(sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(t - now)));
  }
  void wait_for(const sc_core::sc_event& event) { wait(event); }

 private:
  void go() {
    body_(*this);
    sc_core::sc_stop();
  }
  std::function<void(Host&)> body_;
};

inline std::int64_t now_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }

/// One machine, whose program's words are all marked, and one host.
class Rig {
 public:
  explicit Rig(const Spec& s, const MachineOptions& options = {}) : spec(s) {
    sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
    engine = std::make_unique<ClockedEngine>("machine", spec, options);
  }
  static Spec quiet() {
    Spec s;
    s.video.mode = video::DisplayMode::kBlanked;
    return s;
  }

  std::int64_t tick() const { return spec.processor.tick_ps; }
  void at_tick(std::int64_t n, std::int64_t offset_ps = 0) { host->sleep_until_ps(n * tick() + offset_ps); }

  void load(const std::vector<std::uint64_t>& program) {
    for (std::uint32_t i = 0; i < program.size(); ++i) {
      engine->transfer(true, kControlStore + 2 * i, static_cast<std::uint32_t>(program[i]), 0);
      engine->transfer(true, kControlStore + 2 * i + 1, static_cast<std::uint32_t>(program[i] >> 32), 0);
    }
  }
  /// Loads and runs from `start` (the first word's tick) to the halt and `settle` ticks beyond.
  void run(const std::vector<std::uint64_t>& program, std::int64_t start, std::int64_t settle = 20) {
    load(program);
    ASSERT_LE(now_ps(), (start - 1) * tick());
    at_tick(start - 1);
    origin = start;
    engine->command(true, false);
    while (!engine->interrupt()) host->wait_for(engine->interrupt_event());
    at_tick(now_ps() / tick() + settle);
  }
  /// Simulates the host program and finishes at the tick edge at or after its end.
  void simulate(std::function<void()> body, std::int64_t end = -1) {
    std::map<std::uint32_t, std::string> names;
    for (std::uint32_t i = 0; i < 64; ++i) names[i] = std::to_string(i);
    engine->set_marks(names);
    host = std::make_unique<Host>("host", [&](Host&) { body(); });
    sc_core::sc_start();
    engine->finish(end >= 0 ? end : (now_ps() + tick() - 1) / tick());
  }
  /// Ticks in which the word executed, from the first word's tick.
  std::vector<std::int64_t> ticks_of(unsigned address) const {
    std::vector<std::int64_t> ticks;
    for (const MarkEvent& m : engine->marks())
      if (m.name == std::to_string(address)) ticks.push_back(m.tick - origin);
    return ticks;
  }
  /// Ticks of all executed words, in order.
  std::vector<std::int64_t> ticks() const {
    std::vector<std::int64_t> all;
    for (const MarkEvent& m : engine->marks()) all.push_back(m.tick - origin);
    return all;
  }

  Spec spec;
  std::unique_ptr<ClockedEngine> engine;
  std::unique_ptr<Host> host;
  std::int64_t origin = 0;
};

}  // namespace dendro::rds3000
