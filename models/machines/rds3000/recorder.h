#pragma once

#include <cstdint>
#include <memory>

#include "models/machines/rds3000/devices.h"
#include "models/parts/dr64/dr64_timing.h"
#include "models/parts/video/video_timing.h"
#include "sim/trace/trace_file.h"

namespace dendro::rds3000 {

/// One access of either master, with its ticks.
struct SeenAccess {
  bool write = false;
  std::uint32_t address = 0;
  std::uint32_t data = 0;  ///< written or read
  unsigned function = 0;
  std::int64_t started = 0;  ///< the word's tick, or that of the host's request
  std::int64_t asked = 0;    ///< the access has the bus and asks its device
  std::int64_t granted = 0, done = 0;
};

/// The parts of a running engine as a recorder reads them.
struct Watched {
  const Spec& spec;
  const ProcessorState& processor;
  const Devices& devices;
  const dr64::Timing& timing;
  const video::Phase& raster;
};

/// Writes down what passes one boundary of the cycle engine, in the order of time, between begin() and end().
/// Calls outside of that are ignored.
class Recorder {
 public:
  explicit Recorder(trace::Writer& out, const Watched& engine) : out_(out), engine_(engine) {}
  virtual ~Recorder() = default;

  std::int64_t from() const { return out_.from(); }
  std::int64_t to() const { return out_.to(); }
  bool begun() const { return begun_; }

  /// Writes the state before tick `tick`, at which nothing holds the processor.
  void begin(std::int64_t tick) {
    begun_ = true;
    write_state(tick);
  }
  /// The window ends before tick `tick`.
  void end(std::int64_t tick) {
    if (active()) write_end(tick);
    ended_ = true;
  }

  virtual void processor_access(const SeenAccess&) {}
  virtual void host_access(const SeenAccess&) {}
  virtual void display_register(unsigned /*index*/, std::int64_t /*tick*/) {}
  virtual void raster_changed(std::int64_t /*tick*/) {}
  virtual void command(std::int64_t /*tick*/, bool /*run*/, bool /*reset*/) {}
  /// The program stopped: no word executes from `tick` on.
  virtual void halted(std::int64_t /*tick*/) {}

 protected:
  bool active() const { return begun_ && !ended_; }
  virtual void write_state(std::int64_t tick) = 0;
  virtual void write_end(std::int64_t tick) = 0;

  trace::Writer& out_;
  Watched engine_;

 private:
  bool begun_ = false, ended_ = false;
};

/// The recorder of the writer's boundary; nothing for one that lies outside of the engine.
std::unique_ptr<Recorder> make_recorder(trace::Writer& out, const Watched& engine);

/// Calls visit(name, reference) for every register of the processor that is not a memory.
template <class State, class Visit>
void for_each_register(State& p, const Visit& visit) {
  static constexpr const char* kRam[] = {"r0", "r1", "r2",  "r3",  "r4",  "r5",  "r6",  "r7",
                                         "r8", "r9", "r10", "r11", "r12", "r13", "r14", "r15"};
  static constexpr const char* kStack[] = {"stack0", "stack1", "stack2", "stack3", "stack4"};
  for (unsigned i = 0; i < 16; ++i) visit(kRam[i], p.ram[i]);
  visit("q", p.q);
  visit("z", p.z);
  visit("n", p.n);
  visit("c", p.c);
  visit("v", p.v);
  visit("divide_sign", p.divide_sign);
  visit("host_flag", p.host_flag);
  visit("pc", p.pc);
  visit("page", p.page);
  visit("counter", p.counter);
  for (unsigned i = 0; i < 5; ++i) visit(kStack[i], p.stack[i]);
  visit("depth", p.depth);
  visit("sar", p.sar);
  visit("bus_address", p.bus_address);
  visit("write_data", p.write_data);
  visit("read_data", p.read_data);
  visit("mul_x", p.mul_x);
  visit("mul_y", p.mul_y);
  visit("product", p.product);
  visit("pending_product", p.pending_product);
  visit("product_in", p.product_in);
  visit("restart_pc", p.restart_pc);
  visit("restart_page", p.restart_page);
  visit("running", p.running);
}

}  // namespace dendro::rds3000
