#include "sim/study/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "sim/stats/run_object.h"

namespace dendro::study {
namespace {

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

Progress::Progress(const std::string& mode)
    : enabled_(mode == "on" || (mode == "auto" && ::isatty(STDERR_FILENO) != 0)),
      started_(std::chrono::steady_clock::now()),
      shown_(started_),
      runs_started_(started_) {}

void Progress::start_run(const std::string& name, double clock_hz) {
  name_ = name;
  clock_hz_ = clock_hz;
  started_ = std::chrono::steady_clock::now();
}

bool Progress::due() {
  if (!enabled_ || seconds_since(shown_) < 0.2) return false;
  shown_ = std::chrono::steady_clock::now();
  return true;
}

void Progress::show(const std::string& text) {
  std::fprintf(stderr, "\r%s\033[K", text.substr(0, 110).c_str());
  std::fflush(stderr);
}

void Progress::tick(std::int64_t tick, const std::function<std::string()>& machine_phase) {
  if (!due()) return;
  const std::string own = machine_phase && phase_ == kMachine ? machine_phase() : "";
  show(progress_line({name_, own.empty() ? phase_ : own, tick, expected_, clock_hz_, seconds_since(started_)}));
}

std::string progress_line(const RunProgress& run) {
  const auto tick = static_cast<double>(run.tick), all = static_cast<double>(run.expected);
  const double rate = run.host_seconds > 0 ? tick / run.host_seconds : 0;
  std::string line = run.name + ": " + run.phase;
  if (all > 0) line += fmt::format(", {:.0f} %", 100 * std::min(tick / all, 1.0));
  if (run.clock_hz > 0) line += fmt::format(", {} simulated", stats::readable_seconds(tick / run.clock_hz));
  line += fmt::format(", {:.3g} million ticks a second", rate / 1e6);
  if (all > 0 && rate > 0) line += fmt::format(", {:.0f} s left", std::max(all - tick, 0.0) / rate);
  return line;
}

void Progress::runs(const std::string& name, std::size_t done, std::size_t total) {
  if (done == 0) runs_started_ = std::chrono::steady_clock::now();
  if (!enabled_) return;
  const double spent = seconds_since(runs_started_);
  const std::string left = done == 0 ? ""
                                     : fmt::format(", {:.0f} s left", spent / static_cast<double>(done) *
                                                                          static_cast<double>(total - done));
  show(fmt::format("{}: {} of {} runs ({:.0f} %){}", name, done, total,
                   total == 0 ? 100.0 : 100.0 * static_cast<double>(done) / static_cast<double>(total),
                   left));
}

void Progress::clear() {
  if (enabled_) show("");
}

void ReportingPort::wait_interrupt() {
  if (progress_) progress_->machine_runs();
  port_.wait_interrupt();
}

void ReportingPort::phase(std::string_view name) {
  if (progress_) progress_->phase(std::string(name));
  port_.phase(name);
}

}  // namespace dendro::study
