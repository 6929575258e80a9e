#include "models/machines/rds3000/host_recorder.h"

#include "models/parts/ik11b/ik11b_isa.h"

namespace dendro::rds3000 {
namespace {

using trace::decimal;
using trace::hex;
using trace::Record;
using trace::When;

std::int64_t now_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }

Record request_record(const char* op, std::vector<trace::Number> values, trace::Keys keys) {
  Record record;
  record.at = When::after(0);
  record.op = op;
  record.values = std::move(values);
  record.keys = std::move(keys);
  return record;
}

}  // namespace

class HostRecorder::Port : public HostPort {
 public:
  Port(HostPort& port, HostRecorder& recorder) : port_(port), recorder_(recorder) {}

  std::uint32_t read(std::uint32_t address, unsigned function) override {
    ask("read", {hex(address)}, {{"fn", decimal(function)}});
    return port_.read(address, function);
  }
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override {
    ask("write", {hex(address), hex(value)}, {{"fn", decimal(function)}});
    port_.write(address, value, function);
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    ask("dma_to", {hex(address)}, dma(count, function, step));
    port_.dma_to(address, words, count, function, step);
  }
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                std::uint32_t step) override {
    ask("dma_from", {hex(address)}, dma(count, function, step));
    port_.dma_from(address, words, count, function, step);
  }
  void command(std::uint32_t bits) override {
    recorder_.request();
    port_.command(bits);
  }
  void wait_interrupt() override {
    recorder_.request();
    port_.wait_interrupt();
  }
  void compute(const Work& work) override {
    trace::Keys keys;
    const auto add = [&](const char* key, std::uint64_t count) {
      if (count > 0) keys.emplace_back(key, decimal(static_cast<std::int64_t>(count)));
    };
    add("flops", work.flops);
    add("instructions", work.instructions);
    add("program_loads", work.program_loads);
    ask("compute", {}, std::move(keys));
    port_.compute(work);
  }
  void phase(std::string_view name) override { port_.phase(name); }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return port_.peek(address, function); }
  void program(std::string_view name, std::uint32_t first) override { port_.program(name, first); }

 private:
  static trace::Keys dma(std::size_t count, unsigned function, std::uint32_t step) {
    return {{"count", decimal(static_cast<std::int64_t>(count))}, {"fn", decimal(function)}, {"step", decimal(step)}};
  }
  void ask(const char* op, std::vector<trace::Number> values, trace::Keys keys) {
    recorder_.request();
    recorder_.add(request_record(op, std::move(values), std::move(keys)));
  }

  HostPort& port_;
  HostRecorder& recorder_;
};

void HostRecorder::run(HostPort& port, const std::function<void(HostPort&)>& program) {
  Port recorded(port, *this);
  program(recorded);
  end();
}

std::int64_t HostRecorder::edge() const { return (now_ps() + tick_ps_ - 1) / tick_ps_; }

void HostRecorder::request() {
  if (edge() >= out_.to()) end();
  if (begun_ || edge() < out_.from() || edge() >= out_.to()) return;
  begun_ = true;
  if (now_ps() > 0) add(request_record("start", {}, {{"ps", decimal(now_ps())}}));
}

void HostRecorder::end() {
  if (active()) {
    Record record = request_record("end", {}, {});
    record.answer_keys = {{"ps", decimal(now_ps())}};
    add(record);
  }
  ended_ = true;
}

std::uint32_t HostRecorder::transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) {
  const std::int64_t asked = edge();
  const std::uint32_t word = machine_.transfer(write, address, data, function);
  Record record;
  record.at = When::at(asked);
  record.op = write ? "bus_write" : "bus_read";
  record.values = {hex(address), hex(write ? data : word)};
  record.keys = {{"fn", decimal(function)}, {"takes", decimal(edge() - asked)}};
  record.answer_at = When::at(asked);
  add(record);
  return word;
}

void HostRecorder::command(bool run, bool reset) {
  Record record = request_record("command", {hex((run ? ik11b::kRun : 0) | (reset ? ik11b::kReset : 0))}, {});
  record.answer_at = When::at(edge());
  add(record);
  machine_.command(run, reset);
}

void HostRecorder::clear_interrupt() {
  add(request_record("wait_interrupt", {}, {{"at", decimal(now_ps() / tick_ps_)}}));
  machine_.clear_interrupt();
}

}  // namespace dendro::rds3000
