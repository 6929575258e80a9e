#include "models/machines/pixel_planes/cycle.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "models/machines/pixel_planes/units.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {

CycleMachine::CycleMachine(const Spec& spec, const MachineOptions& options)
    : spec_(spec), options_(options), group_(spec, [this](std::size_t r) -> Device& { return boards_[r].device(); }) {
  for (std::size_t r = 0; r < group_.count(); ++r) boards_.emplace_back(spec);
  machine_.resize(group_.count());
  if (options.recorder) recorder_ = make_recorder(*options.recorder, spec_, boards_.front());
}

void CycleMachine::run(const std::function<void(HostPort&)>& host_program) {
  host_program(*this);
  if (lacks_words()) throw Device::never_idle();
  end_ = std::max(clock_at(now_ps_), idle_from());
  if (recorder_) recorder_->end(end_);
  for (CycleBoard& board : boards_) board.timing().finish(end_);
}

bool CycleMachine::lacks_words() const {
  return std::any_of(boards_.begin(), boards_.end(), [](const CycleBoard& board) { return board.lacks_words(); });
}

std::int64_t CycleMachine::idle_from() const {
  std::int64_t from = 0;
  for (const CycleBoard& board : boards_) from = std::max(from, board.timing().idle_from());
  return from;
}

std::uint32_t CycleMachine::read(std::uint32_t address, unsigned) {
  spend(spec_.host.word_ps);
  if (address != kStatus) return group_.read(address);
  time_read_ = true;
  const bool busy = std::any_of(boards_.begin(), boards_.end(), [&](const CycleBoard& board) { return board.busy(now_ps_); });
  if (recorder_) recorder_->status(now_ps_ / spec_.tick_ps, busy);
  return busy;
}

void CycleMachine::write(std::uint32_t address, std::uint32_t value, unsigned) {
  spend(spec_.host.word_ps);
  const std::int64_t offered_ps = now_ps_;
  if (recorder_) recorder_->before(offered_ps / spec_.tick_ps);
  if (address != kFifo) {
    if (!group_.write(address, value))
      for (std::size_t r = group_.selection().first(group_.count()); r < group_.selection().end(group_.count()); ++r)
        boards_[r].write(offered_ps, address, value);
    if (recorder_) recorder_->write(offered_ps / spec_.tick_ps, address, value);
    return;
  }
  for (std::size_t r = group_.selection().first(group_.count()); r < group_.selection().end(group_.count()); ++r) offer(r, value);
}

void CycleMachine::offer(std::size_t renderer, std::uint32_t word) {
  const std::int64_t offered_ps = now_ps_;
  const CycleBoard::Offered offered = boards_[renderer].offer(offered_ps, word);
  now_ps_ = offered.host_ps;
  if (recorder_) recorder_->word(offered_ps / spec_.tick_ps, word, now_ps_ / spec_.tick_ps);
  if (!offered.done) return;
  if (recorder_) recorder_->command(*offered.done, offered.times);
  group_.done(renderer, offered.done->command, offered.times.free);
  const CommandTimes& times = offered.times;
  book(renderer, phase_of(offered.done->command.header), times);
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
  if (lacks_words()) throw Device::never_idle();
  if (recorder_) recorder_->wait(now_ps_ / spec_.tick_ps);
  now_ps_ = std::max(now_ps_, idle_from() * spec_.tick_ps);
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
  if (header.copy) return "copy";
  const auto mark = options_.marks.find(header.entry);
  if (mark == options_.marks.end() || mark->second.rfind("phase_", 0) != 0) return "run";
  const std::string name = mark->second.substr(6);
  return name.substr(0, name.find('.'));
}

void CycleMachine::book(std::size_t renderer, const std::string& name, const CommandTimes& times) {
  std::vector<Stretch>& stretches = machine_[renderer];
  if (!stretches.empty() && stretches.back().name == name && stretches.back().to == times.taken)
    stretches.back().to = times.free;
  else
    stretches.push_back({name, times.taken, times.free});
}

/// A clock in which several renderers work is of the one with the lowest number.
std::vector<CycleMachine::Stretch> CycleMachine::machine_stretches() const {
  std::vector<Stretch> all = machine_.front();
  for (std::size_t r = 1; r < machine_.size(); ++r) {
    std::vector<Stretch> merged;
    std::size_t next = 0;
    for (Stretch stretch : machine_[r]) {
      while (stretch.from < stretch.to) {
        while (next < all.size() && all[next].to <= stretch.from) merged.push_back(all[next++]);
        const std::int64_t taken = next < all.size() ? all[next].from : INT64_MAX;
        if (taken > stretch.from) merged.push_back({stretch.name, stretch.from, std::min(stretch.to, taken)});
        stretch.from = next < all.size() ? std::max(stretch.from, std::min(stretch.to, all[next].to)) : stretch.to;
      }
    }
    merged.insert(merged.end(), all.begin() + static_cast<std::ptrdiff_t>(next), all.end());
    all = std::move(merged);
  }
  return all;
}

/// Of the renderer that is idle least.
std::int64_t CycleMachine::machine_cycles() const {
  std::uint64_t idle = static_cast<std::uint64_t>(end_);
  for (const CycleBoard& board : boards_) idle = std::min(idle, board.timing().controller().idle);
  return end_ - static_cast<std::int64_t>(idle);
}

std::uint64_t CycleMachine::instructions() const {
  std::uint64_t words = 0;
  for (const CycleBoard& board : boards_) words += board.timing().controller().busy;
  return words;
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
  for (const Stretch& stretch : machine_stretches()) {
    if (stretch.from > at) add_host(at, stretch.from);
    add(stretch.name, stretch.to - stretch.from, false);
    at = stretch.to;
  }
  if (end_ > at) add_host(at, end_);
  return phases;
}

std::vector<std::string> CycleMachine::elaborated() const { return unit_names(boards_.size()); }

Picture CycleMachine::picture() const {
  if (!shown_) shown_ = group_.picture();
  return *shown_;
}

std::vector<UnitStats> CycleMachine::units() const {
  picture();  // so that what it needs is among the evaluated operations, whoever asks first
  const auto total = static_cast<std::uint64_t>(end_);
  const std::vector<std::string> names = unit_names(boards_.size());
  std::vector<UnitStats> units;
  FifoCounters fifo;
  for (std::size_t r = 0; r < boards_.size(); ++r) {
    const Timing& timing = boards_[r].timing();
    const WordCounters& w = boards_[r].device().engine().counters();
    add_units(names[2 * r], names[2 * r + 1], total, timing.controller(), timing.fifo().commands, units);
    auto& array = units.back().values;
    array.insert(array.end(), {{"pixel_operations", w.pixel_operations}, {"evaluated_pixel_operations", w.evaluated},
                               {"bitwise_commands", w.bitwise_commands}});
    fifo.words += timing.fifo().words, fifo.full_clocks += timing.fifo().full_clocks;
  }
  units.push_back(host_unit(total, std::min(total, static_cast<std::uint64_t>(busy_ps_ / spec_.tick_ps)), fifo));
  return units;
}

}  // namespace dendro::pixel_planes
