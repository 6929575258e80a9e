#include "models/machines/rds3000/cycle.h"

#include <algorithm>

#include "models/machines/rds3000/loop_finder.h"
#include "models/parts/bps32/bps32_execute.h"

namespace dendro::rds3000 {

using bps32::Decoded;

/// The processor's bus interface at this level.
struct CyclePort {
  CycleEngine& engine;

  bool bus_busy() const { return engine.holds_.bus_busy(engine.now_); }
  bool data_ready() const { return engine.holds_.data_ready(engine.now_); }
  const video::Phase& raster() const {
    return engine.now_ > engine.raster_from_ ? engine.raster_ : engine.raster_before_;
  }
  bool vertical_blank() const { return raster().vertical_blank(engine.now_ * engine.tick_ps()); }
  bool field() const { return raster().second_field(engine.now_ * engine.tick_ps()); }

  // A lores pixel of the first bank, which is what pixel loops access, without the detour over the device map.
  static bool is_plain_pixel(std::uint32_t address, unsigned function) {
    return function == bps32::kFnLores && address < 0x100000;
  }
  std::uint32_t& pixel(std::uint32_t address) const {
    return engine.devices_.memory.state().pixels[(address >> 11 << 9) | (address >> 1 & 0x1FF)];
  }

  void start_read(std::uint32_t address, unsigned function) {
    if (is_plain_pixel(address, function)) {
      engine.start_pixel_access(false, false);
      engine.processor_.read_data = pixel(address);
      return;
    }
    engine.start_access(false, address, function);
    engine.processor_.read_data = engine.devices_.read(address, function);
  }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) {
    if (is_plain_pixel(address, function)) {
      const std::uint32_t all = engine.spec_.memory.pixel_mask();
      const std::uint32_t mask = engine.devices_.memory.state().mask_lores & all;
      engine.start_pixel_access(true, mask != all);
      pixel(address) = (pixel(address) & ~mask) | (data & mask);
      return;
    }
    const std::int64_t granted = engine.start_access(true, address, function);
    engine.devices_.write(address, data, function);
    engine.change_video(address, granted);
  }
};

/// The same, telling a recorder; all accesses go the long way.
struct RecordingPort : CyclePort {
  void start_read(std::uint32_t address, unsigned function) {
    const std::int64_t asked = std::max(engine.now_ + engine.spec_.bus.arbitration_ticks, engine.bus_free_);
    const std::int64_t granted = engine.start_access(false, address, function);
    const std::uint32_t word = engine.devices_.read(address, function);
    engine.processor_.read_data = word;
    engine.recorder_->processor_access({false, address, word, function, engine.now_, asked, granted, engine.holds_.access_done()});
  }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) {
    const std::int64_t asked = std::max(engine.now_ + engine.spec_.bus.arbitration_ticks, engine.bus_free_);
    const std::int64_t granted = engine.start_access(true, address, function);
    engine.devices_.write(address, data, function);
    engine.recorder_->processor_access({true, address, data, function, engine.now_, asked, granted, engine.holds_.access_done()});
    engine.change_video(address, granted);
  }
};

/// The same with an account of which pixel is accessed when. A type of its own, so that runs without the account do
/// not ask for it at every access.
struct CostPort : CyclePort {
  void start_read(std::uint32_t address, unsigned function) {
    note(address, function, false);
    CyclePort::start_read(address, function);
  }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) {
    note(address, function, true);
    CyclePort::start_write(address, data, function);
  }

 private:
  void note(std::uint32_t address, unsigned function, bool write) {
    if ((address & kAddressMask) >= kImageEnd) return;
    const auto pixel = engine.devices_.memory.touched(address & kAddressMask, function, write);
    if (pixel) engine.cost_->access(*pixel, engine.now_);
  }
};

CycleEngine::CycleEngine(const Spec& spec, const MachineOptions& options)
    : spec_(spec),
      options_(options),
      processor_(bps32::power_on(spec.processor)),
      devices_(spec),
      timing_(spec.memory, spec.processor.tick_ps),
      decoded_(spec.processor.control_store_words),
      holds_(spec.processor) {
  raster_ = {video::raster_of(devices_.video, spec.video, spec.memory.fetch_bits), -spec.video.phase_ps};
  raster_before_ = raster_;
  timing_.set_fetches({raster_.raster, raster_.origin_ps, 0, tick_ps()});
  if (options.recorder)
    recorder_ = make_recorder(*options.recorder, {spec_, processor_, devices_, timing_, raster_});
  if (recorder_ && recorder_->from() == 0) recorder_->begin(0);
  if (options.activity > 0) activity_ = std::make_unique<ActivityLog>(options.activity);
  if (options.cost) cost_ = std::make_unique<PixelCost>(std::size_t{dr64::kWidth} * dr64::kHeight);
}

std::int64_t CycleEngine::now_tick() const {
  const auto ps = static_cast<std::int64_t>(sc_core::sc_time_stamp().value());
  return (ps + tick_ps() - 1) / tick_ps();
}

void CycleEngine::wait_until(std::int64_t tick) {
  const auto target = sc_core::sc_time::from_value(static_cast<std::uint64_t>(tick * tick_ps()));
  if (target > sc_core::sc_time_stamp()) sc_core::wait(target - sc_core::sc_time_stamp());
}

void CycleEngine::decode(std::size_t word) {
  decoded_[word] = bps32::decode(processor_.control[word]);
  const bool marked = mark_names_.count(static_cast<std::uint32_t>(word)) != 0;
  decoded_[word].marked = marked;
  decoded_[word].holds |= marked;
}

// Image memory and device grants in one place, for the processor and for the host.
std::int64_t CycleEngine::grant(std::int64_t at, bool write, std::uint32_t address, unsigned function,
                                int& read_ticks) {
  read_ticks = spec_.bus.register_read_ticks;
  if ((address & kAddressMask) >= kImageEnd) return at;
  const dr64::Work work = devices_.memory.probe(address & kAddressMask, function, write);
  if (work.cards == 0) return at;
  read_ticks = spec_.memory.read_ticks;
  return timing_.grant(at, work, write);
}

inline void CycleEngine::start_pixel_access(bool write, bool masked) {
  const std::int64_t asked = std::max(now_ + spec_.bus.arbitration_ticks, bus_free_);
  const dr64::Work work{true, (1u << spec_.memory.cards_per_bank) - 1, masked};
  book_access(write, asked, timing_.grant(asked, work, write), spec_.memory.read_ticks);
}

std::int64_t CycleEngine::start_access(bool write, std::uint32_t address, unsigned function) {
  const std::int64_t asked = std::max(now_ + spec_.bus.arbitration_ticks, bus_free_);
  int read_ticks;
  const std::int64_t granted = grant(asked, write, address, function, read_ticks);
  book_access(write, asked, granted, read_ticks);
  return granted;
}

inline void CycleEngine::book_access(bool write, std::int64_t asked, std::int64_t granted, int read_ticks) {
  const int held = write ? spec_.bus.write_ticks : 1;
  bus_free_ = granted + held;
  holds_.access(write, granted + (write ? held : read_ticks));
  (write ? bus_counters_.processor_writes : bus_counters_.processor_reads) += 1;
  bus_counters_.busy += static_cast<std::uint64_t>(bus_free_ - asked);
}

void CycleEngine::change_video(std::uint32_t address, std::int64_t tick) {
  if (recorder_ && device_at(address) == Device::Fbc) recorder_->display_register((address & kAddressMask) - kFbc, tick);
  if (!sets_raster(address)) return;
  const video::Raster raster = video::raster_of(devices_.video, spec_.video, spec_.memory.fetch_bits);
  if (raster == raster_.raster) return;
  timing_.catch_up(tick + 1);
  raster_before_ = raster_;
  raster_from_ = tick;
  raster_ = {raster, tick * tick_ps()};
  timing_.set_fetches({raster_.raster, raster_.origin_ps, raster_.origin_ps, tick_ps()});
  if (recorder_) recorder_->raster_changed(tick);
}

std::uint64_t& CycleEngine::counter(bps32::Cause cause) {
  switch (cause) {
    case bps32::Cause::kHost: return counters_.stall_host;
    case bps32::Cause::kBranch: return counters_.stall_branch;
    case bps32::Cause::kData: return counters_.stall_data;
    case bps32::Cause::kBus: return counters_.stall_bus;
    default: return counters_.stall_scratch;
  }
}

// Lives through the ticks in which the word cannot execute; false when `end` comes first.
bool CycleEngine::hold(const Decoded& word, std::int64_t end) {
  while (now_ < end) {
    const bps32::Hold hold = holds_.at(word, now_);
    if (hold.cause == bps32::Cause::kNone) return true;
    const std::int64_t to = std::min(hold.until, end);
    counter(hold.cause) += static_cast<std::uint64_t>(to - now_);
    now_ = to;
  }
  return false;
}

void CycleEngine::passed(const Decoded& word) {
  if (word.marked) marks_.push_back({mark_names_.at(static_cast<std::uint32_t>(bps32::page_base(processor_) + processor_.pc)), now_});
  time_dependent_ |= word.reads_time;
}

void CycleEngine::stride(std::int64_t end) {
  if (recorder_)
    stride_with(RecordingPort{{*this}}, end);
  else if (cost_)
    stride_with(CostPort{{*this}}, end);
  else
    stride_with(CyclePort{*this}, end);
}

template <class Port>
void CycleEngine::stride_with(Port port, std::int64_t end) {
  const Decoded* const words = decoded_.data() + bps32::page_base(processor_);
  const bool branches_cost = spec_.processor.taken_branch_ticks != 0;
  std::uint16_t pc = processor_.pc;
  while (now_ < end) {
    const Decoded& word = words[pc];
    if (word.holds || holds_.holds_any(now_)) {
      processor_.pc = pc;
      if (!holds_.clear(word, now_) && !hold(word, end)) return;
      if (word.marked || word.reads_time) passed(word);
    }
    const std::uint16_t next = (pc + 1) & am2910::kAddressMask;
    bps32::execute_fast(processor_, word, spec_.processor, port, pc);
    if (branches_cost && pc != next) holds_.branch(now_);
    ++now_;
    if (word.halt) {
      processor_.pc = pc;
      stopped(now_);
      if (recorder_) recorder_->halted(now_);
      return;
    }
  }
  processor_.pc = pc;
}

void CycleEngine::stopped(std::int64_t at) {
  processor_.running = false;
  if (cost_) cost_->stop(at);
  if (at > run_from_) runs_.push_back({run_from_, at});
}

void CycleEngine::find_loop() {
  LoopFinder finder;
  while (processor_.running) {
    const auto at = static_cast<std::uint32_t>(bps32::page_base(processor_) + processor_.pc);
    const std::int64_t before = now_;
    while (processor_.running && now_ == before) stride(now_ + 1);
    if (finder.see(at)) {
      error_ = std::make_exception_ptr(finder.error(options_.tick_limit, options_.symbols));
      stopped(now_);
    }
  }
}

// Nothing that happens before `end` comes later than this call, so samples before it are final.
void CycleEngine::run_until(std::int64_t end) {
  while (activity_ && activity_->next() < end) {
    const std::int64_t tick = activity_->next();
    run_to(tick);
    activity_->take(counters_before(tick), bus_counters_, timing_.counters_before(tick));
  }
  run_to(end);
}

void CycleEngine::run_to(std::int64_t end) {
  if (!processor_.running) return;
  const bool limited = options_.tick_limit > 0 && run_from_ + options_.tick_limit < end;
  const std::int64_t stop = limited ? run_from_ + options_.tick_limit : end;
  if (recorder_)
    run_recorded(stop);
  else
    stride(stop);
  if (limited && processor_.running) find_loop();
}

// Stops where the recorded window begins and ends. It begins at rest, so that a replay can do so, too.
void CycleEngine::run_recorded(std::int64_t end) {
  while (processor_.running && now_ < end) {
    reach(now_);
    const bool inside = now_ >= recorder_->from() && now_ < recorder_->to();
    const std::int64_t edge = now_ < recorder_->from() ? recorder_->from() : inside ? recorder_->to() : end;
    stride(recorder_->begun() || !inside ? std::min(edge, end) : now_ + 1);
  }
}

void CycleEngine::reach(std::int64_t tick) {
  const bool rests = holds_.rests(tick) && tick > raster_from_;
  if (!recorder_->begun() && tick >= recorder_->from() && tick < recorder_->to() && rests) recorder_->begin(tick);
  if (tick >= recorder_->to()) recorder_->end(recorder_->to());
}

std::uint32_t CycleEngine::transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) {
  const std::int64_t arbitration = spec_.bus.arbitration_ticks;
  std::int64_t asked = now_tick() + arbitration;
  for (;;) {
    run_until(asked - arbitration + 1);
    if (bus_free_ <= asked) break;
    asked = bus_free_;
  }
  if (recorder_ && !processor_.running) reach(asked);
  const bool board = on_processor_board(address);
  int read_ticks = spec_.bus.register_read_ticks;
  const std::int64_t granted = board ? asked : grant(asked, write, address, function, read_ticks);
  const int held = write ? spec_.bus.write_ticks : 1;
  bus_free_ = granted + held;
  (write ? bus_counters_.host_writes : bus_counters_.host_reads) += 1;
  bus_counters_.busy += static_cast<std::uint64_t>(bus_free_ - asked);
  std::uint32_t word = 0;
  if (board) {
    run_until(granted + 1);
    if (processor_.running) holds_.steal(granted);
    if (write) {
      const std::int64_t changed = write_processor_board(processor_, address, data);
      if (changed >= 0) decode(static_cast<std::size_t>(changed));
    } else {
      word = read_processor_board(processor_, address);
    }
  } else if (write) {
    devices_.write(address, data, function);
    change_video(address, granted);
  } else {
    word = devices_.read(address, function);
  }
  if (recorder_)
    recorder_->host_access({write, address, write ? data : word, function, asked, asked, granted, granted + (write ? held : read_ticks)});
  wait_until(granted + (write ? held : read_ticks));
  return word;
}

void CycleEngine::command(bool run, bool reset) {
  const std::int64_t tick = now_tick();
  run_until(tick + 1);
  if (recorder_) {
    if (!processor_.running) reach(tick);
    recorder_->command(tick, run, reset);
  }
  if ((reset || !run) && processor_.running) stopped(tick + 1);
  if (reset) rds3000::reset(processor_);
  if (run && !reset && !processor_.running) {
    for (std::size_t word = 0; word < decoded_.size(); ++word) decode(word);
    processor_.running = true;
    holds_.start();
    now_ = run_from_ = tick + 1;
    if (cost_) cost_->start(now_);
  }
}

void CycleEngine::host_sleeps() {
  constexpr std::int64_t kSlice = 1 << 24;
  while (processor_.running) {
    // What comes after a halt is not known here, so no sample is passed in one step.
    const std::int64_t sample = activity_ ? std::max(activity_->next(), now_ + 1) : INT64_MAX;
    run_until(std::min(now_ + kSlice, sample));
    if (options_.progress) options_.progress(now_);
  }
  wait_until(now_);
}

void CycleEngine::finish(std::int64_t end) {
  run_until(end);
  if (recorder_) recorder_->end(end);
  if (processor_.running) stopped(end);
  timing_.settle(end);
  counters_ = counters_before(end);
}

// Stalls are counted as they come; the rest follows from how long the processor ran.
ProcessorCounters CycleEngine::counters_before(std::int64_t tick) const {
  std::int64_t ran = processor_.running ? tick - run_from_ : 0;
  for (const RunInterval& run : runs_) ran += run.to - run.from;
  ProcessorCounters counters = counters_;
  const std::uint64_t stalls = counters.stall_host + counters.stall_data + counters.stall_bus +
                               counters.stall_scratch + counters.stall_branch;
  counters.busy = static_cast<std::uint64_t>(ran) - stalls;
  counters.idle = static_cast<std::uint64_t>(tick - ran);
  return counters;
}

}  // namespace dendro::rds3000
