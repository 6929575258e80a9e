#include "models/machines/pixel_planes/clocked.h"

#include <fmt/format.h>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {
namespace {

constexpr std::int64_t kProgressClocks = std::int64_t{1} << 20;

std::int64_t now_in_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }
sc_core::sc_time ps(std::int64_t t) { return sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(t)); }

}  // namespace

ClockedEngine::ClockedEngine(sc_core::sc_module_name name, const Spec& spec, const MachineOptions& options)
    : sc_module(name),
      spec_(spec),
      options_(options),
      tick_ps_(spec.tick_ps),
      translator_(spec.setup_clocks),
      controller_(spec.tree.gap_clocks),
      array_(spec),
      thieves_(spec) {
  DENDRO_CHECK(sc_core::sc_get_time_resolution() == sc_core::sc_time(1, sc_core::SC_PS),
               "SystemC's resolution is not 1 ps");
  DENDRO_CHECK(tick_ps_ >= 2, "tick of {} ps", tick_ps_);
  if (!options_.vcd_file.empty()) vcd_ = std::make_unique<ClockedVcd>(*this, options_);
  // sc_stop reports itself on standard output, where a program's own output belongs.
  sc_core::sc_report_handler::set_actions("/OSCI/SystemC", sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  SC_HAS_PROCESS(ClockedEngine);
  SC_METHOD(on_clock);
  SC_THREAD(host_thread);
  set_stack_size(1 << 20);
}

ClockedEngine::~ClockedEngine() = default;

void ClockedEngine::simulate(const std::function<void(HostPort&)>& program) {
  program_ = program;
  sc_core::sc_start();
  if (error_) std::rethrow_exception(error_);
  if (vcd_) vcd_->close();
}

void ClockedEngine::on_clock() {
  if (stopped_) return;
  const std::int64_t due_ps = (next_clock_ + 1) * tick_ps_ - 1;
  if (now_in_ps() < due_ps) {  // the call at the start of the simulation
    next_trigger(ps(due_ps - now_in_ps()));
    return;
  }
  evaluate(next_clock_++);
  after_clock();
  if (!stopped_) next_trigger(ps(tick_ps_));
}

void ClockedEngine::evaluate(std::int64_t n) {
  apply_writes(n);
  const ClockedCause thief = thieves_.steal(n);
  const bool stolen = thief != ClockedCause::kBusy;
  const ClockedCause cause = cause_of(thief);
  idle_before_ = !fifo_.has_word(n) && behind_fifo_idle();
  fifo_before_ = fifo_.size() - (last_landed_ == n ? 1 : 0);
  if (vcd_ && vcd_->wants(n)) vcd_->before(n);

  count(cause);
  if (controller_.running()) stretches_.back().to = n + 1;
  const bool ready = translator_.ready();
  translator_.clock(n, fifo_);
  if (!stolen) move_array(n, ready);
  if (vcd_ && vcd_->wants(n)) vcd_->after(cause);
  watch_limit();
  if (n % kProgressClocks == 0 && options_.progress) options_.progress(n);
}

ClockedCause ClockedEngine::cause_of(ClockedCause thief) const {
  if (controller_.running() || translator_.ready()) return thief;
  if (fifo_.has_word(next_clock_ - 1) || !translator_.idle()) return ClockedCause::kTranslator;
  return array_.words_on_their_way() > 0 ? ClockedCause::kDrain : ClockedCause::kIdle;
}

void ClockedEngine::count(ClockedCause cause) {
  switch (cause) {
    case ClockedCause::kBusy:
      ++counters_.busy;
      return;
    case ClockedCause::kRefresh:
      ++counters_.stall_refresh;
      return;
    case ClockedCause::kVideo:
      ++counters_.stall_video;
      return;
    case ClockedCause::kTranslator:
      ++counters_.stall_translator;
      return;
    case ClockedCause::kDrain:
      ++counters_.stall_drain;
      return;
    case ClockedCause::kIdle:
      ++counters_.idle;
      return;
  }
}

void ClockedEngine::move_array(std::int64_t n, bool ready) {
  if (!controller_.running() && ready) {
    const igc::Header header = translator_.command().header;
    if (!header.register_write && !controller_.has_end(header.entry)) {
      fail(fmt::format("the micro-program at word {} of the control store has no end", header.entry));
    } else if (!controller_.take(translator_.command())) {
      fail(fmt::format("the micro-program at word {} sends nothing", header.entry));
    }
    translator_.taken();
    ++fifo_counters_.commands;
    book(header, n);
  }
  if (controller_.running()) {
    const ClockedController::Sent sent = controller_.send();
    const igc::Command& command = controller_.command();
    if (sent.starts_stream) array_.start(command.a, command.b, command.c);
    array_.clock(&sent.word);
  } else {
    controller_.pause();
    array_.clock(nullptr);
  }
}

void ClockedEngine::book(const igc::Header& header, std::int64_t n) {
  std::string name = "run";
  const auto mark = options_.marks.find(header.entry);
  if (header.register_write) {
    name = "registers";
  } else if (mark != options_.marks.end() && mark->second.rfind("phase_", 0) == 0) {
    name = mark->second.substr(6, mark->second.find('.') - 6);
  }
  if (!stretches_.empty() && stretches_.back().name == name && stretches_.back().to == n) {
    stretches_.back().to = n + 1;
  } else {
    stretches_.push_back({name, n, n + 1});
  }
}

void ClockedEngine::watch_limit() {
  if (options_.tick_limit > 0 && !stretches_.empty() && stretches_.back().to > options_.tick_limit)
    fail(fmt::format("the machine has run for {} clocks: the limit is reached", options_.tick_limit));
}

void ClockedEngine::fail(const std::string& message) {
  if (!error_) error_ = std::make_exception_ptr(UserError(message));
}

void ClockedEngine::after_clock() {
  const bool idle = idle_now();
  if ((host_waits_for_idle_ || host_ended_) && cannot_become_idle())
    fail("pixel_planes: the last command lacks words, so the machine never becomes idle");
  const bool over = host_ended_ && idle && next_clock_ * tick_ps_ >= host_end_ps_;
  if (over || error_) {
    stopped_ = true;
    sc_core::sc_stop();
    return;
  }
  const sc_core::sc_time to_next = ps(next_clock_ * tick_ps_ - now_in_ps());
  if (host_waits_for_idle_ && idle) idle_event_.notify(to_next);
  if (host_waits_for_room_ && fifo_.size() < static_cast<std::size_t>(spec_.fifo_words))
    room_event_.notify(to_next);
}

bool ClockedEngine::idle_now() const { return fifo_.empty() && behind_fifo_idle(); }

bool ClockedEngine::behind_fifo_idle() const {
  return translator_.idle() && !controller_.running() && array_.words_on_their_way() == 0;
}

bool ClockedEngine::cannot_become_idle() const {
  return translator_.lacks_words() && fifo_.empty() && !controller_.running() && array_.words_on_their_way() == 0;
}

void ClockedEngine::apply_writes(std::int64_t n) {
  while (!writes_.empty() && writes_.front().clock < n) {
    controller_.set_half(writes_.front().index, writes_.front().value);
    writes_.pop_front();
  }
}

}  // namespace dendro::pixel_planes
