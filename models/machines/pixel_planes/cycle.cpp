#include "models/machines/pixel_planes/cycle.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {

CycleMachine::CycleMachine(const Spec& spec, const MachineOptions& options)
    : spec_(spec), options_(options), board_(spec) {
  if (options.recorder) recorder_ = make_recorder(*options.recorder, spec_, board_);
}

void CycleMachine::run(const std::function<void(HostPort&)>& host_program) {
  host_program(*this);
  if (board_.lacks_words()) throw Device::never_idle();
  end_ = std::max(clock_at(now_ps_), board_.timing().idle_from());
  if (recorder_) recorder_->end(end_);
  board_.timing().finish(end_);
}

std::uint32_t CycleMachine::read(std::uint32_t address, unsigned) {
  spend(spec_.host.word_ps);
  if (address != kStatus) return board_.device().read(address);
  time_read_ = true;
  const std::uint32_t status = board_.busy(now_ps_) ? 1 : 0;
  if (recorder_) recorder_->status(now_ps_ / spec_.tick_ps, status);
  return status;
}

void CycleMachine::write(std::uint32_t address, std::uint32_t value, unsigned) {
  spend(spec_.host.word_ps);
  const std::int64_t offered_ps = now_ps_;
  if (recorder_) recorder_->before(offered_ps / spec_.tick_ps);
  if (address != kFifo) {
    board_.write(offered_ps, address, value);
    if (recorder_) recorder_->write(offered_ps / spec_.tick_ps, address, value);
    return;
  }
  const CycleBoard::Offered offered = board_.offer(offered_ps, value);
  now_ps_ = offered.host_ps;
  if (recorder_) recorder_->word(offered_ps / spec_.tick_ps, value, now_ps_ / spec_.tick_ps);
  if (!offered.done) return;
  if (recorder_) recorder_->command(*offered.done, offered.times);
  const CommandTimes& times = offered.times;
  book(phase_of(offered.done->command.header), times);
  if (options_.progress) options_.progress(times.free);
  if (options_.tick_limit > 0 && times.free > options_.tick_limit)
    throw UserError(fmt::format("the machine has run for {} clocks: the limit is reached", options_.tick_limit));
}

void CycleMachine::dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
                          std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i)
    write(address == kFifo ? address : address + static_cast<std::uint32_t>(i) * step, words[i], function);
}

void CycleMachine::dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                            std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i) words[i] = read(address + static_cast<std::uint32_t>(i) * step, function);
}

void CycleMachine::wait_interrupt() {
  if (board_.lacks_words()) throw Device::never_idle();
  if (recorder_) recorder_->wait(now_ps_ / spec_.tick_ps);
  now_ps_ = std::max(now_ps_, board_.timing().idle_from() * spec_.tick_ps);
  spend(spec_.host.interrupt_ps);
}

void CycleMachine::compute(const Work& work) {
  spend(static_cast<std::int64_t>(work.flops) * spec_.host.flop_ps +
        static_cast<std::int64_t>(work.instructions) * spec_.host.instruction_ps +
        static_cast<std::int64_t>(work.program_loads) * spec_.host.program_load_ps);
}

void CycleMachine::phase(std::string_view name) { host_.push_back({std::string(name), clock_at(now_ps_), 0}); }

/// "phase_scan_planes.front_plane" at a program's entry is the phase scan_planes.
std::string CycleMachine::phase_of(const igc::Header& header) const {
  if (header.register_write) return "registers";
  const auto mark = options_.marks.find(header.entry);
  if (mark == options_.marks.end() || mark->second.rfind("phase_", 0) != 0) return "run";
  const std::string name = mark->second.substr(6);
  return name.substr(0, name.find('.'));
}

void CycleMachine::book(const std::string& name, const CommandTimes& times) {
  if (!machine_.empty() && machine_.back().name == name && machine_.back().to == times.taken)
    machine_.back().to = times.free;
  else
    machine_.push_back({name, times.taken, times.free});
}

std::int64_t CycleMachine::machine_cycles() const {
  return end_ - static_cast<std::int64_t>(board_.timing().controller().idle);
}

std::vector<Phase> CycleMachine::phases() const {
  std::vector<Phase> phases;
  const auto add = [&](const std::string& name, std::int64_t cycles, bool host) {
    if (cycles <= 0) return;
    if (!phases.empty() && phases.back().name == name && phases.back().on_host == host)
      phases.back().cycles += cycles;
    else
      phases.push_back({name, cycles, host});
  };
  std::size_t next = 0;
  std::string host = "host";
  const auto add_host = [&](std::int64_t from, std::int64_t to) {
    for (; next < host_.size() && host_[next].from < to; ++next) {
      add(host, std::max(from, host_[next].from) - from, true);
      from = std::max(from, host_[next].from);
      host = host_[next].name;
    }
    add(host, to - from, true);
  };
  std::int64_t at = 0;
  for (const Stretch& stretch : machine_) {
    if (stretch.from > at) add_host(at, stretch.from);
    add(stretch.name, stretch.to - stretch.from, false);
    at = stretch.to;
  }
  if (end_ > at) add_host(at, end_);
  return phases;
}

std::vector<UnitStats> CycleMachine::units() const {
  const auto total = static_cast<std::uint64_t>(end_);
  const ControllerCounters& c = board_.timing().controller();
  const FifoCounters& f = board_.timing().fifo();
  const WordCounters& w = board_.device().engine().counters();
  const std::uint64_t host_busy = std::min(total, static_cast<std::uint64_t>(busy_ps_ / spec_.tick_ps));
  return {{"pixel_planes.controller",
           {{"cycles", total}, {"busy", c.busy}, {"stall_refresh", c.stall_refresh}, {"stall_video", c.stall_video},
            {"stall_translator", c.stall_translator}, {"stall_drain", c.stall_drain}, {"idle", c.idle},
            {"commands", f.commands}}},
          {"pixel_planes.array",
           {{"cycles", total}, {"busy", c.busy}, {"idle", total - c.busy}, {"pixel_operations", w.pixel_operations},
            {"evaluated_pixel_operations", w.evaluated}, {"bitwise_commands", w.bitwise_commands}}},
          {"pixel_planes.host",
           {{"cycles", total}, {"busy", host_busy}, {"idle", total - host_busy}, {"fifo_words", f.words},
            {"fifo_full_clocks", f.full_clocks}}}};
}

}  // namespace dendro::pixel_planes
