#include "models/machines/rds3000/cycle.h"

#include <algorithm>

#include "models/machines/rds3000/loop_finder.h"
#include "models/parts/bps32/bps32_execute.h"

namespace dendro::rds3000 {

using bps32::Decoded;

/// The processor's bus interface at this level.
struct CyclePort {
  CycleEngine& engine;

  bool bus_busy() const { return engine.access_done_ > engine.now_; }
  bool data_ready() const { return engine.data_ready_ <= engine.now_; }
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

CycleEngine::CycleEngine(const Spec& spec, const MachineOptions& options)
    : spec_(spec),
      options_(options),
      processor_(bps32::power_on(spec.processor)),
      devices_(spec),
      timing_(spec.memory, spec.processor.tick_ps),
      decoded_(spec.processor.control_store_words) {
  raster_ = {video::raster_of(devices_.video, spec.video, spec.memory.fetch_bits), -spec.video.phase_ps};
  raster_before_ = raster_;
  timing_.set_fetches({raster_.raster, raster_.origin_ps, 0, tick_ps()});
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
  access_done_ = granted + (write ? held : read_ticks);
  if (!write) data_ready_ = access_done_;
  if (spec_.processor.accesses_in_flight == 0) hold_ = std::max(hold_, access_done_);
  (write ? bus_counters_.processor_writes : bus_counters_.processor_reads) += 1;
  bus_counters_.busy += static_cast<std::uint64_t>(bus_free_ - asked);
}

void CycleEngine::change_video(std::uint32_t address, std::int64_t tick) {
  if (!restarts_raster(address)) return;
  timing_.settle(tick + 1);
  raster_before_ = raster_;
  raster_from_ = tick;
  raster_ = {video::raster_of(devices_.video, spec_.video, spec_.memory.fetch_bits), tick * tick_ps()};
  timing_.set_fetches({raster_.raster, raster_.origin_ps, raster_.origin_ps, tick_ps()});
}

// The common case of hold(): nothing keeps the word from executing now.
inline bool CycleEngine::ready(const Decoded& word) const {
  return now_ >= hold_ && (!word.reads_bus || now_ >= data_ready_) && (!word.starts_access || now_ >= access_done_) &&
         (!word.touches_scratch || spec_.processor.scratch_ticks == 1);
}

// Lives through the ticks in which the word cannot execute; false when `end` comes first.
bool CycleEngine::hold(const Decoded& word, std::int64_t end) {
  const auto stall = [this, end](std::int64_t until, std::uint64_t& cause) {
    const std::int64_t to = std::min(until, end);
    cause += static_cast<std::uint64_t>(to - now_);
    now_ = to;
  };
  const bool needs_bus = word.starts_access || spec_.processor.accesses_in_flight == 0;
  const int scratch_wait = word.touches_scratch ? spec_.processor.scratch_ticks - 1 : 0;
  while (now_ < end) {
    if (now_ < host_hold_) {
      stall(host_hold_, counters_.stall_host);
    } else if (now_ < branch_hold_) {
      stall(branch_hold_, counters_.stall_branch);
    } else if (word.reads_bus && now_ < data_ready_) {
      stall(data_ready_, counters_.stall_data);
    } else if (needs_bus && now_ < access_done_) {
      stall(access_done_, counters_.stall_bus);
    } else {
      if (scratch_wait > 0 && scratch_until_ < 0) scratch_until_ = now_ + scratch_wait;
      if (now_ >= scratch_until_) {
        scratch_until_ = -1;
        return true;
      }
      stall(scratch_until_, counters_.stall_scratch);
    }
  }
  return false;
}

void CycleEngine::passed(const Decoded& word) {
  if (word.marked) marks_.push_back({mark_names_.at(static_cast<std::uint32_t>(bps32::page_base(processor_) + processor_.pc)), now_});
  time_dependent_ |= word.reads_time;
}

// Words that only compute or jump are done here with time and address in registers; all else goes through execute().
void CycleEngine::stride(std::int64_t end) {
  CyclePort port{*this};
  const Decoded* const words = decoded_.data() + bps32::page_base(processor_);
  const int branch_ticks = spec_.processor.taken_branch_ticks;
  std::int64_t now = now_;
  std::uint16_t pc = processor_.pc;
  while (now < end) {
    const Decoded& word = words[pc];
    const std::uint16_t next = (pc + 1) & am2910::kAddressMask;
    if (!word.holds && now >= hold_ && processor_.product_in == 0 && word.kind != Decoded::kGeneric) {
      if (word.kind == Decoded::kAlu) {
        word.alu(processor_, word);
        pc = next;
      } else {
        pc = bps32::condition(processor_, word.cond, port) != word.pol ? word.imm : next;
      }
      ++now;
    } else {
      now_ = now;
      processor_.pc = pc;
      if (word.holds || now < hold_) {
        if (!ready(word) && !hold(word, end)) return;
        if (word.marked || word.reads_time) passed(word);
      }
      bps32::execute(processor_, word, spec_.processor, port);
      now = ++now_;
      pc = processor_.pc;
      if (word.halt) {
        stopped(now);
        return;
      }
    }
    if (branch_ticks != 0 && pc != next) {
      branch_hold_ = now + branch_ticks;
      hold_ = std::max(hold_, branch_hold_);
    }
  }
  now_ = now;
  processor_.pc = pc;
}

void CycleEngine::stopped(std::int64_t at) {
  processor_.running = false;
  if (at > run_from_) runs_.push_back({run_from_, at});
}

void CycleEngine::find_loop() {
  LoopFinder finder;
  while (processor_.running) {
    const auto at = static_cast<std::uint32_t>(bps32::page_base(processor_) + processor_.pc);
    const std::int64_t before = now_;
    while (processor_.running && now_ == before) stride(now_ + 1);
    if (finder.see(at)) {
      error_ = std::make_exception_ptr(finder.error(options_.tick_limit, mark_names_));
      stopped(now_);
    }
  }
}

void CycleEngine::run_until(std::int64_t end) {
  if (!processor_.running) return;
  const bool limited = options_.tick_limit > 0 && run_from_ + options_.tick_limit < end;
  stride(limited ? run_from_ + options_.tick_limit : end);
  if (limited && processor_.running) find_loop();
}

std::uint32_t CycleEngine::transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) {
  const std::int64_t arbitration = spec_.bus.arbitration_ticks;
  std::int64_t asked = now_tick() + arbitration;
  for (;;) {
    run_until(asked - arbitration + 1);
    if (bus_free_ <= asked) break;
    asked = bus_free_;
  }
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
    if (processor_.running) {
      host_hold_ = granted + 1 + spec_.processor.steal_ticks;
      hold_ = std::max(hold_, host_hold_);
    }
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
  wait_until(granted + (write ? held : read_ticks));
  return word;
}

void CycleEngine::command(bool run, bool reset) {
  const std::int64_t tick = now_tick();
  run_until(tick + 1);
  if ((reset || !run) && processor_.running) stopped(tick + 1);
  if (reset) rds3000::reset(processor_);
  if (run && !reset && !processor_.running) {
    for (std::size_t word = 0; word < decoded_.size(); ++word) decode(word);
    processor_.running = true;
    scratch_until_ = -1;
    now_ = run_from_ = tick + 1;
  }
}

void CycleEngine::host_sleeps() {
  constexpr std::int64_t kSlice = 1 << 24;
  while (processor_.running) {
    run_until(now_ + kSlice);
    if (options_.progress) options_.progress(now_);
  }
  wait_until(now_);
}

void CycleEngine::finish(std::int64_t end) {
  run_until(end);
  if (processor_.running) stopped(end);
  timing_.settle(end);
  std::int64_t ran = 0;
  for (const RunInterval& run : runs_) ran += run.to - run.from;
  const std::uint64_t stalls = counters_.stall_host + counters_.stall_data + counters_.stall_bus +
                               counters_.stall_scratch + counters_.stall_branch;
  counters_.busy = static_cast<std::uint64_t>(ran) - stalls;
  counters_.idle = static_cast<std::uint64_t>(end - ran);
}

}  // namespace dendro::rds3000
