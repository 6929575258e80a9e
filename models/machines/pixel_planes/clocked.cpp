#include "models/machines/pixel_planes/clocked.h"

#include <fmt/format.h>

#include <algorithm>

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
      frame_(spec),
      thieves_(spec) {
  for (int r = 0; r < spec.renderers.count; ++r) renderers_.emplace_back(spec);
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
  const ClockedCause thief = thieves_.steal(n);
  for (ClockedRenderer& renderer : renderers_) renderer.begin(n);
  if (vcd_ && vcd_->wants(n)) vcd_->before(n);
  ClockedCause first = ClockedCause::kIdle;
  for (ClockedRenderer& renderer : renderers_) {
    const ClockedCause cause = renderer.clock(n, thief);
    if (&renderer == &renderers_.front()) first = cause;
    if (!renderer.error().empty()) fail(renderer.error());
    if (renderer.copied() && spec_.frame.exists())
      frame_.copy(renderer.command().tile_x, renderer.command().tile_y, renderer.array().planes());
  }
  book(n);
  if (vcd_ && vcd_->wants(n)) vcd_->after(first);
  watch_limit();
  if (n % kProgressClocks == 0 && options_.progress) options_.progress(n);
}

/// The clock is of the command that the renderer with the lowest number of those at work has.
void ClockedEngine::book(std::int64_t n) {
  const igc::Header* header = nullptr;
  for (const ClockedRenderer& renderer : renderers_)
    if ((header = renderer.at_work()) != nullptr) break;
  if (header == nullptr) return;
  std::string name = "run";
  const auto mark = options_.marks.find(header->entry);
  if (header->register_write) {
    name = "registers";
  } else if (header->copy) {
    name = "copy";
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
  if (host_waits_for_room_ != nullptr && host_waits_for_room_->has_room())
    room_event_.notify(to_next);
}

bool ClockedEngine::idle_now() const {
  return std::all_of(renderers_.begin(), renderers_.end(), [](const ClockedRenderer& r) { return r.idle_now(); });
}

bool ClockedEngine::cannot_become_idle() const {
  return std::any_of(renderers_.begin(), renderers_.end(), [](const ClockedRenderer& r) { return r.cannot_become_idle(); });
}

}  // namespace dendro::pixel_planes
