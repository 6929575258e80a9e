#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "models/machines/rds3000/clocked_processor.h"
#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/replay_processor.h"
#include "models/parts/bps32/bps32_execute.h"
#include "models/parts/bps32/bps32_timing.h"

namespace dendro::rds3000 {
namespace {

/// The raster as it was up to one tick, and as it is after it.
class DisplaySignals {
 public:
  void change(std::int64_t tick, const video::Phase& phase) {
    before_ = after_;
    after_ = phase;
    from_ = tick;
  }
  const video::Phase& at(std::int64_t tick) const { return tick > from_ ? after_ : before_; }

 private:
  video::Phase before_, after_;
  std::int64_t from_ = INT64_MIN;
};

class CycleUnit : public ProcessorUnit {
 public:
  explicit CycleUnit(const Spec& spec)
      : spec_(spec), decoded_(spec.processor.control_store_words), holds_(spec.processor) {}

  void load(const ProcessorState& state, std::int64_t tick) override {
    state_ = state;
    now_ = tick;
    decode_all();
  }
  Started run(std::int64_t end, const Answer* answer) override {
    started_ = {};
    answer_ = answer;
    while (state_.running && now_ < end && !started_.seen) word(end);
    return started_;
  }
  std::uint32_t host_access(std::int64_t tick, bool write, std::uint32_t address, std::uint32_t data) override {
    if (state_.running) holds_.steal(tick);
    if (!write) return read_processor_board(state_, address);
    const std::int64_t changed = write_processor_board(state_, address, data);
    if (changed >= 0) decoded_[static_cast<std::size_t>(changed)] = bps32::decode(state_.control[static_cast<std::size_t>(changed)]);
    return 0;
  }
  void command(std::int64_t tick, bool run, bool reset) override {
    if (reset || !run) state_.running = false;
    if (reset) rds3000::reset(state_);
    if (!run || reset || state_.running) return;
    state_.running = true;
    holds_.start();
    now_ = tick + 1;
  }
  void display(std::int64_t tick, const video::Phase& phase) override { display_.change(tick, phase); }
  const ProcessorState& state() const override { return state_; }
  std::int64_t now() const override { return now_; }

  // The processor's port.
  bool bus_busy() const { return holds_.bus_busy(now_); }
  bool data_ready() const { return holds_.data_ready(now_); }
  bool vertical_blank() const { return display_.at(now_).vertical_blank(now_ * spec_.processor.tick_ps); }
  bool field() const { return display_.at(now_).second_field(now_ * spec_.processor.tick_ps); }
  void start_read(std::uint32_t address, unsigned function) {
    start(false, address, 0, function);
    if (answer_) state_.read_data = answer_->data;
  }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) { start(true, address, data, function); }

 private:
  void decode_all() {
    for (std::size_t i = 0; i < decoded_.size(); ++i) decoded_[i] = bps32::decode(state_.control[i]);
  }
  void start(bool write, std::uint32_t address, std::uint32_t data, unsigned function) {
    started_ = {true, write, address, data, function, now_};
    if (answer_) holds_.access(write, now_ + answer_->takes);
  }
  // One word, or the ticks before `end` in which it is held.
  void word(std::int64_t end) {
    const bps32::Decoded& word = decoded_[bps32::page_base(state_) + state_.pc];
    for (bps32::Hold hold; (hold = holds_.at(word, now_)).cause != bps32::Cause::kNone;) {
      now_ = std::min(hold.until, end);
      if (now_ == end) return;
    }
    const std::uint16_t next = (state_.pc + 1) & am2910::kAddressMask;
    bps32::execute(state_, word, spec_.processor, *this);
    if (spec_.processor.taken_branch_ticks != 0 && state_.pc != next) holds_.branch(now_);
    ++now_;
  }

  Spec spec_;
  ProcessorState state_;
  std::vector<bps32::Decoded> decoded_;
  bps32::Holds holds_;
  DisplaySignals display_;
  std::int64_t now_ = 0;
  const Answer* answer_ = nullptr;
  Started started_;
};

class ClockedUnit : public ProcessorUnit {
 public:
  explicit ClockedUnit(const Spec& spec) : tick_ps_(spec.processor.tick_ps), processor_(spec.processor, marks_) {}

  void load(const ProcessorState& state, std::int64_t tick) override {
    processor_.load(state);
    now_ = tick;
  }
  Started run(std::int64_t end, const Answer* answer) override {
    while (processor_.state().running && now_ < end) {
      const Started started = tick(now_, answer);
      ++now_;
      if (started.seen) return started;
    }
    complete(end - 1);
    return {};
  }
  std::uint32_t host_access(std::int64_t tick, bool write, std::uint32_t address, std::uint32_t data) override {
    processor_.steal(tick);
    if (!write) return processor_.host_read(address);
    processor_.host_write(address, data);
    return 0;
  }
  void command(std::int64_t tick, bool run, bool reset) override {
    const bool running = processor_.state().running;
    if (reset || !run) processor_.halt();
    if (reset) processor_.reset();
    if (!run || reset || running) return;
    processor_.run();
    now_ = tick + 1;
  }
  void display(std::int64_t tick, const video::Phase& phase) override { display_.change(tick, phase); }
  const ProcessorState& state() const override { return processor_.state(); }
  std::int64_t now() const override { return now_; }

 private:
  Started tick(std::int64_t n, const Answer* answer) {
    complete(n);
    ClockedSignals in;
    in.access_in_flight = in_flight_;
    in.read_under_way = in_flight_ && reading_;
    in.vertical_blank = display_.at(n).vertical_blank(n * tick_ps_);
    in.field = display_.at(n).second_field(n * tick_ps_);
    if (processor_.tick(n, in) != ClockedCause::kBusy || !processor_.effects().request) return {};
    const ClockedRequest& request = processor_.effects().access;
    if (answer) {
      in_flight_ = true;
      reading_ = !request.write;
      data_ = answer->data;
      done_ = n + answer->takes;
    }
    return {true, request.write, request.address, request.data, request.function, n};
  }

  // The access, if its time has come by tick n; also while the processor stands still.
  void complete(std::int64_t n) {
    if (!in_flight_ || n < done_) return;
    in_flight_ = false;
    if (reading_) processor_.load_read_data(data_);
  }

  std::int64_t tick_ps_;
  std::map<std::uint32_t, std::string> marks_;
  ClockedProcessor processor_;
  DisplaySignals display_;
  std::int64_t now_ = 0, done_ = 0;
  bool in_flight_ = false, reading_ = false;
  std::uint32_t data_ = 0;
};

}  // namespace

std::unique_ptr<ProcessorUnit> make_cycle_unit(const Spec& spec) { return std::make_unique<CycleUnit>(spec); }
std::unique_ptr<ProcessorUnit> make_clocked_unit(const Spec& spec) { return std::make_unique<ClockedUnit>(spec); }

}  // namespace dendro::rds3000
