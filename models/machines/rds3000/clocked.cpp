#include "models/machines/rds3000/clocked.h"

#include <algorithm>

#include "models/machines/rds3000/loop_finder.h"
#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::rds3000 {
namespace {

constexpr std::int64_t kLoopWords = 4096;
// A word may be held for long, but not for ever: the search for the loop ends also after this many ticks.
constexpr std::int64_t kLoopTicks = 64 * kLoopWords;
constexpr std::int64_t kProgressTicks = std::int64_t{1} << 20;

std::int64_t now_in_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }
sc_core::sc_time ps(std::int64_t t) { return sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(t)); }

}  // namespace

ClockedEngine::ClockedEngine(sc_core::sc_module_name name, const Spec& spec, const MachineOptions& options)
    : sc_module(name),
      spec_(spec),
      options_(options),
      tick_ps_(spec.processor.tick_ps),
      processor_(spec.processor, mark_names_),
      memory_(spec.memory),
      video_(video::power_on(spec.video.mode)),
      cards_(spec.memory),
      next_refresh_ps_(spec.memory.refresh_interval_ps > 0 ? spec.memory.refresh_interval_ps : INT64_MAX) {
  DENDRO_CHECK(sc_core::sc_get_time_resolution() == sc_core::sc_time(1, sc_core::SC_PS),
               "SystemC's resolution is not 1 ps");
  DENDRO_CHECK(tick_ps_ >= 2, "tick of {} ps", tick_ps_);
  display_.restart(video::raster_of(video_, spec_.video, spec_.memory.fetch_bits), -spec_.video.phase_ps, 0);
  if (options_.activity > 0) activity_ = std::make_unique<ActivityLog>(options_.activity);
  if (!options_.vcd_file.empty()) vcd_ = std::make_unique<ClockedVcd>(*this, options_);
  SC_HAS_PROCESS(ClockedEngine);
  SC_METHOD(on_edge);
}

ClockedEngine::~ClockedEngine() = default;

void ClockedEngine::on_edge() {
  if (finished_) return;
  const std::int64_t due_ps = (next_tick_ + 1) * tick_ps_ - 1;
  if (now_in_ps() < due_ps) {  // the call at the start of the simulation
    next_trigger(ps(due_ps - now_in_ps()));
    return;
  }
  evaluate(next_tick_++);
  next_trigger(ps(tick_ps_));
}

void ClockedEngine::evaluate(std::int64_t n) {
  if (activity_ && activity_->next() == n) activity_->take(processor_counters_, bus_counters_, memory_counters_);
  periodic_events(n);
  complete_accesses(n);
  if (vcd_ && vcd_->wants(n)) vcd_->before(n);

  ClockedSignals in;
  in.access_in_flight = own_.in_flight();
  in.read_under_way = own_.in_flight() && !own_.write;
  in.vertical_blank = display_.vertical_blank();
  in.field = display_.field();
  const ClockedCause cause = processor_.tick(n, in);
  count(cause);
  const bool was_running = cause != ClockedCause::kIdle;
  if (cause == ClockedCause::kBusy) after_word(n);

  arbitrate(n);
  if (vcd_ && vcd_->wants(n)) vcd_->after(n, cause);
  if (was_running && options_.tick_limit > 0) watch_for_loop(n, cause == ClockedCause::kBusy);
  if (!commands_.empty()) obey_commands(n);
  cards_.end_tick();
  if (n % kProgressTicks == 0 && options_.progress) options_.progress(n);
}

void ClockedEngine::count(ClockedCause cause) {
  ProcessorCounters& c = processor_counters_;
  switch (cause) {
    case ClockedCause::kBusy:
      ++c.busy;
      return;
    case ClockedCause::kHost:
      ++c.stall_host;
      return;
    case ClockedCause::kBranch:
      ++c.stall_branch;
      return;
    case ClockedCause::kData:
      ++c.stall_data;
      return;
    case ClockedCause::kBus:
      ++c.stall_bus;
      return;
    case ClockedCause::kScratch:
      ++c.stall_scratch;
      return;
    case ClockedCause::kIdle:
      ++c.idle;
      return;
  }
}

void ClockedEngine::after_word(std::int64_t n) {
  const ClockedProcessor::Effects& did = processor_.effects();
  if (did.request)
    start_access(own_, n + spec_.bus.arbitration_ticks, did.access.write, did.access.address, did.access.data,
                 did.access.function);
  if (did.reads_time) time_dependent_ = true;
  if (did.marked) marks_.push_back({mark_names_.at(did.word), n});
  if (did.halted) {
    stop_running(n + 1);
    processor_.set_interrupt(true);
    raise_interrupt(n);
  }
}

void ClockedEngine::watch_for_loop(std::int64_t n, bool executed) {
  if (++ran_ticks_ <= options_.tick_limit || error_) return;
  ++limit_ticks_;
  if (executed) {
    const std::uint32_t word = processor_.effects().word;
    loop_low_ = limit_words_ == 0 ? word : std::min(loop_low_, word);
    loop_high_ = limit_words_ == 0 ? word : std::max(loop_high_, word);
    ++limit_words_;
  }
  if (limit_words_ >= kLoopWords || limit_ticks_ >= kLoopTicks || !processor_.state().running) give_up(n);
}

void ClockedEngine::give_up(std::int64_t n) {
  error_ = std::make_exception_ptr(endless_program(options_.tick_limit, loop_low_, loop_high_, options_.symbols));
  if (processor_.state().running) stop_running(n + 1);
  processor_.halt();
  if (!finished_) interrupt_event_.notify(ps((n + 1) * tick_ps_ - now_in_ps()));
}

void ClockedEngine::obey_commands(std::int64_t n) {
  while (!commands_.empty() && commands_.front().tick <= n) {
    const Command c = commands_.front();
    commands_.pop_front();
    const bool running = processor_.state().running;
    if (c.reset || !c.run) {
      if (running) stop_running(n + 1);
      processor_.halt();
    }
    if (c.reset) {
      processor_.reset();
    } else if (c.run && !running && !error_) {
      processor_.run();
      runs_.push_back({n + 1, n + 1});
      ran_ticks_ = limit_words_ = limit_ticks_ = 0;
    }
  }
}

void ClockedEngine::stop_running(std::int64_t end) {
  runs_.back().to = end;
  if (runs_.back().from >= end) runs_.pop_back();
}

void ClockedEngine::raise_interrupt(std::int64_t n) {
  if (interrupt_tick_ >= 0) interrupt_up_ = true;
  interrupt_tick_ = n + 1;
  if (!finished_) interrupt_event_.notify(ps((n + 1) * tick_ps_ - now_in_ps()));
}

bool ClockedEngine::interrupt() const {
  return interrupt_up_ || (interrupt_tick_ >= 0 && now_in_ps() >= interrupt_tick_ * tick_ps_);
}

void ClockedEngine::clear_interrupt() {
  interrupt_up_ = false;
  // An interrupt that has yet to rise is not the one that the host saw.
  if (interrupt_tick_ < 0 || now_in_ps() < interrupt_tick_ * tick_ps_) return;
  interrupt_tick_ = -1;
  processor_.set_interrupt(false);
}

bool ClockedEngine::running() const {
  const bool will_run =
      std::any_of(commands_.begin(), commands_.end(), [](const Command& c) { return c.run && !c.reset; });
  return processor_.state().running || will_run || (interrupt_tick_ >= 0 && !interrupt());
}

std::int64_t ClockedEngine::edge_at_or_after_now() const { return (now_in_ps() + tick_ps_ - 1) / tick_ps_; }

std::uint32_t ClockedEngine::transfer(bool write, std::uint32_t address, std::uint32_t data,
                                      unsigned function) {
  DENDRO_CHECK(host_.phase == Phase::kNone || host_.phase == Phase::kGranted, "two host accesses at a time");
  start_access(host_, edge_at_or_after_now() + spec_.bus.arbitration_ticks, write, address, data, function);
  wait(host_done_);
  return host_.answer;
}

void ClockedEngine::command(bool run, bool reset) {
  commands_.push_back({edge_at_or_after_now(), run, reset});
}

void ClockedEngine::finish(std::int64_t end) {
  DENDRO_CHECK(!finished_ && next_tick_ <= end, "finish at tick {}, next is {}", end, next_tick_);
  finished_ = true;
  while (next_tick_ < end) evaluate(next_tick_++);
  if (processor_.state().running) stop_running(end);
  if (vcd_) vcd_->close();
}

}  // namespace dendro::rds3000
