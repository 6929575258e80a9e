#include "models/machines/pixel_planes/cycle.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {

CycleMachine::CycleMachine(const Spec& spec, const MachineOptions& options)
    : spec_(spec), options_(options), device_(spec, true), timing_(spec) {}

void CycleMachine::run(const std::function<void(HostPort&)>& host_program) {
  host_program(*this);
  if (device_.lacks_words()) throw Device::never_idle();
  end_ = std::max(clock_at(now_ps_), timing_.idle_from());
  timing_.finish(end_);
}

std::uint32_t CycleMachine::read(std::uint32_t address, unsigned) {
  spend(spec_.host.word_ps);
  if (address != kStatus) return device_.read(address);
  time_read_ = true;
  return command_words_ > 0 || now_ps_ / spec_.tick_ps < timing_.idle_from() ? 1 : 0;
}

void CycleMachine::write(std::uint32_t address, std::uint32_t value, unsigned) {
  spend(spec_.host.word_ps);
  if (address == kFifo) {
    now_ps_ = timing_.offer_word(now_ps_);
    ++command_words_;
  } else if (address < kControlStoreEnd) {
    check_not_in_use(address);
  }
  const auto done = device_.write(address, value);
  if (!done) return;
  const igc::Header& header = done->command.header;
  const CommandTimes times = timing_.command(command_words_, header.expression && !header.register_write, done->words);
  command_words_ = 0;
  book(phase_of(header), times);
  if (done->program_words > 0) in_use_.push_back({header.entry, done->program_words, times.free});
  if (options_.progress) options_.progress(times.free);
  if (options_.tick_limit > 0 && times.free > options_.tick_limit)
    throw UserError(fmt::format("the machine has run for {} clocks: the limit is reached", options_.tick_limit));
}

// A command is carried out when its last word is offered, with the program as it is then.
void CycleMachine::check_not_in_use(std::uint32_t address) {
  const std::int64_t now = now_ps_ / spec_.tick_ps;
  const unsigned word = address / 2;
  // What is written in a clock is seen from the next.
  while (!in_use_.empty() && in_use_.front().free <= now + 1) in_use_.pop_front();
  for (const InUse& use : in_use_)
    if ((word - use.entry) % igc::kStoreWords < use.words)
      throw UserError(fmt::format("word {} of the control store is written while a command that runs it is not done: what comes "
                                  "out shows at level clocked only",
                                  word));
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
  if (device_.lacks_words()) throw Device::never_idle();
  now_ps_ = std::max(now_ps_, timing_.idle_from() * spec_.tick_ps);
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
  return end_ - static_cast<std::int64_t>(timing_.controller().idle);
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
  const ControllerCounters& c = timing_.controller();
  const FifoCounters& f = timing_.fifo();
  const WordCounters& w = device_.engine().counters();
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
