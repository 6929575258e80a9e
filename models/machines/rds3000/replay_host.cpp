#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "models/machines/rds3000/boundaries.h"
#include "models/machines/rds3000/rds3000_map.h"
#include "models/parts/ik11b/ik11b_isa.h"
#include "models/parts/ik11b/ik11b_shell.h"
#include "sim/trace/replayer.h"

namespace dendro::rds3000 {
namespace {

using trace::Record;
using trace::Replayer;

constexpr std::int64_t kMostWords = 1 << 24;  ///< of one transfer: twice the machine's address space

std::int64_t now_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }
sc_core::sc_time ps(std::int64_t time) { return sc_core::sc_time::from_value(static_cast<std::uint64_t>(time)); }

/// The machine's side of the interface, and the program on its other side, both out of one trace.
class HostReplay : public ik11b::Target {
 public:
  HostReplay(const Spec& spec, Replayer& replayer, trace::Reader& trace)
      : tick_ps_(spec.processor.tick_ps), replayer_(replayer), trace_(trace) {}

  /// The host program.
  trace::ReplayResult run(HostPort& port) {
    trace::ReplayResult result = replayer_.run([&](const Record& record) {
      if (done_) replayer_.fail(record, "nothing may follow `end`");
      take(port, record);
    });
    result.transactions += words_;
    result.cycles = edge() - first_;
    return result;
  }

  std::uint32_t transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) override;
  void command(bool, bool) override {
    replayer_.expect_tick(current_, at_, edge(), "the command takes effect");
  }
  sc_core::sc_event& interrupt_event() override { return event_; }
  bool interrupt() const override { return now_ps() >= interrupt_ps_; }
  void clear_interrupt() override {}
  bool running() const override { return true; }
  std::exception_ptr error() const override { return nullptr; }
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }
  void program(std::string_view, std::uint32_t) override {}

 private:
  std::int64_t edge() const { return (now_ps() + tick_ps_ - 1) / tick_ps_; }

  void take(HostPort& port, const Record& record);
  void gather(const Record& by, bool write, std::int64_t count);
  void wait_interrupt(HostPort& port, const Record& record);
  void compute(HostPort& port, const Record& record);
  void transfers(HostPort& port, const Record& record);
  void pause_until(std::int64_t time) {
    if (time > now_ps()) sc_core::wait(ps(time - now_ps()));
  }

  std::int64_t tick_ps_;
  Replayer& replayer_;
  trace::Reader& trace_;
  Record current_;
  std::int64_t at_ = 0, first_ = 0, words_ = 0;
  std::deque<Record> bus_;  ///< of the request under way
  std::int64_t interrupt_ps_ = INT64_MAX;
  sc_core::sc_event event_;
  bool done_ = false, begun_ = false;
};

std::uint32_t HostReplay::transfer(bool write, std::uint32_t address, std::uint32_t, unsigned function) {
  const Record record = bus_.front();
  bus_.pop_front();
  const std::int64_t asked = edge();
  const auto wanted = static_cast<std::uint32_t>(record.value(0));
  const std::int64_t wanted_function = record.key("fn");
  if (write != (record.op == "bus_write") || address != wanted || static_cast<std::int64_t>(function) != wanted_function)
    replayer_.differ(record, fmt::format("the interface asks for a {} of 0x{:x} with function {} at tick {}, the trace says a {} "
                                         "of 0x{:x} with function {}",
                                         write ? "write" : "read", address, function, asked,
                                         record.op == "bus_write" ? "write" : "read", wanted, wanted_function));
  replayer_.expect_tick(record, record.at.from(replayer_.completed()), asked,
                        fmt::format("the {} of 0x{:x} asks for the bus", write ? "write" : "read", address));
  const std::int64_t takes = replayer_.within(record, "takes", record.key("takes", 1), 1, 1 << 30);
  replayer_.complete(asked + takes);
  pause_until((asked + takes) * tick_ps_);
  ++words_;
  return static_cast<std::uint32_t>(record.value(1));
}

// The bus side of a request follows it in the trace.
void HostReplay::gather(const Record& by, bool write, std::int64_t count) {
  bus_.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    Record record;
    replayer_.need_next(record, by);
    if (record.op != (write ? "bus_write" : "bus_read"))
      replayer_.fail(record, fmt::format("`{}` where word {} of the {} of line {} should be", record.op, i, by.op, by.line));
    bus_.push_back(std::move(record));
  }
}

void HostReplay::transfers(HostPort& port, const Record& record) {
  const auto address = static_cast<std::uint32_t>(record.value(0));
  const auto function = static_cast<unsigned>(replayer_.within(record, "fn", record.key("fn"), 0, 15));
  const bool one = record.op == "read" || record.op == "write", write = record.op == "write" || record.op == "dma_to";
  const std::int64_t count = one ? 1 : replayer_.within(record, "count", record.key("count"), 1, kMostWords);
  const auto step = static_cast<std::uint32_t>(replayer_.within(record, "step", record.key("step", 1), 0, kAddressMask));
  gather(record, write, count);
  std::vector<std::uint32_t> words;
  for (const Record& word : bus_) words.push_back(write ? static_cast<std::uint32_t>(word.value(1)) : 0);
  if (record.op == "read") {
    replayer_.expect_data(record, port.read(address, function), fmt::format("the word at 0x{:x}", address));
  } else if (record.op == "write") {
    const auto value = static_cast<std::uint32_t>(record.value(1));
    if (value != words[0]) replayer_.differ(record, fmt::format("0x{:x} is written, the bus carries 0x{:x}", value, words[0]));
    port.write(address, value, function);
  } else if (write) {
    port.dma_to(address, words.data(), words.size(), function, step);
  } else {
    port.dma_from(address, words.data(), words.size(), function, step);
  }
}

void HostReplay::compute(HostPort& port, const Record& record) {
  const auto count = [&](const char* key, std::int64_t most) {
    return static_cast<std::uint64_t>(replayer_.within(record, key, record.key(key), 0, most));
  };
  Work work;
  work.flops = count("flops", 1'000'000'000);
  work.instructions = count("instructions", 1'000'000'000);
  work.program_loads = count("program_loads", 1000);
  port.compute(work);
}

void HostReplay::wait_interrupt(HostPort& port, const Record& record) {
  const std::int64_t tick = record.has("at") ? record.key("at") : edge() + replayer_.within(record, "takes", record.key("takes"), 0, 1 << 30);
  replayer_.checked(record, tick);
  interrupt_ps_ = tick * tick_ps_;
  if (interrupt_ps_ > now_ps()) event_.notify(ps(interrupt_ps_ - now_ps()));
  port.wait_interrupt();
  interrupt_ps_ = INT64_MAX;
}

void HostReplay::take(HostPort& port, const Record& record) {
  if (record.op == "start") {
    if (begun_) replayer_.fail(record, "`start` comes before everything else");
    const std::int64_t time = replayer_.within(record, "ps", record.key("ps"), 0, INT64_MAX / 16);
    first_ = (time + tick_ps_ - 1) / tick_ps_;
    pause_until(time);
  }
  begun_ = true;
  current_ = record;
  at_ = replayer_.tick_of(record);
  // A request may wait for its time; without, it comes when the one before is done.
  if (record.at.ticks > 0) pause_until(at_ * tick_ps_);
  if (record.op == "compute")
    compute(port, record);
  else if (record.op == "command")
    port.command(static_cast<std::uint32_t>(replayer_.within(record, "command", record.value(0), 0, 0xFFFF)));
  else if (record.op == "wait_interrupt")
    wait_interrupt(port, record);
  else if (record.op == "bus_read" || record.op == "bus_write")
    replayer_.fail(record, fmt::format("`{}` without a request of the program before it", record.op));
  else if (record.op == "end") {
    replayer_.expect_key(record, "ps", now_ps(), "the program ends at ps");
    replayer_.expect_tick(record, at_, edge(), "the program ends");
    done_ = true;
  } else if (record.op != "start")
    transfers(port, record);
  replayer_.complete(edge());
}

}  // namespace

trace::ReplayResult replay_host(const Spec& spec, trace::Reader& trace) {
  sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
  Replayer replayer(trace, INT64_MAX / 16 / spec.processor.tick_ps);
  HostReplay unit(spec, replayer, trace);
  trace::ReplayResult result;
  ik11b::Shell shell("host", spec.host, unit, [&](HostPort& port) { result = unit.run(port); });
  sc_core::sc_start();
  if (shell.error()) std::rethrow_exception(shell.error());
  return result;
}

}  // namespace dendro::rds3000
