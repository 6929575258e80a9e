#include "models/machines/rds3000/timeline.h"

#include <algorithm>

namespace dendro::rds3000 {
namespace {

constexpr const char* kPhasePrefix = "phase_";

class Builder {
 public:
  void add(const std::string& name, std::int64_t from, std::int64_t to, bool on_host) {
    if (to <= from) return;
    if (!phases_.empty() && phases_.back().name == name && phases_.back().on_host == on_host) {
      phases_.back().cycles += to - from;
    } else {
      phases_.push_back({name, to - from, on_host});
    }
  }
  std::vector<Phase> take() { return std::move(phases_); }

 private:
  std::vector<Phase> phases_;
};

std::int64_t tick_of(const ik11b::HostPhase& phase, std::int64_t tick_ps) {
  return (phase.from_ps + tick_ps - 1) / tick_ps;
}

void add_host(Builder& out, const std::vector<ik11b::HostPhase>& host, std::int64_t tick_ps, std::int64_t from,
              std::int64_t to) {
  std::string name = "host";
  std::int64_t at = from;
  for (const ik11b::HostPhase& phase : host) {
    const std::int64_t tick = std::clamp(tick_of(phase, tick_ps), at, to);
    out.add(name, at, tick, true);
    at = tick;
    name = phase.name;
  }
  out.add(name, at, to, true);
}

void add_machine(Builder& out, const std::vector<MarkEvent>& marks, const RunInterval& run) {
  std::string name = "run";
  std::int64_t at = run.from;
  for (const MarkEvent& mark : marks) {
    if (mark.tick < run.from || mark.tick >= run.to || mark.name.rfind(kPhasePrefix, 0) != 0) continue;
    out.add(name, at, mark.tick, false);
    at = mark.tick;
    name = mark.name.substr(std::char_traits<char>::length(kPhasePrefix));
  }
  out.add(name, at, run.to, false);
}

}  // namespace

std::vector<Phase> timeline(const std::vector<ik11b::HostPhase>& host, std::int64_t tick_ps,
                            const std::vector<RunInterval>& runs, const std::vector<MarkEvent>& marks,
                            std::int64_t end) {
  Builder out;
  std::int64_t at = 0;
  for (const RunInterval& run : runs) {
    add_host(out, host, tick_ps, at, run.from);
    add_machine(out, marks, run);
    at = run.to;
  }
  add_host(out, host, tick_ps, at, end);
  return out.take();
}

}  // namespace dendro::rds3000
