#include "models/machines/sgi_4d35/cycle.h"

#include <algorithm>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/debug.h"
#include "models/machines/sgi_4d35/marks.h"
#include "models/machines/sgi_4d35/pipeline.h"
#include "models/parts/r3000/r3000.h"

namespace dendro::sgi_4d35 {
namespace {

using TimedCore = r3000::Core<Board, Pipeline>;

/// Keeps what RunOptions and MachineOptions ask for of every word.
class Log : public Pipeline::Listener {
 public:
  explicit Log(const RunOptions& options) : options_(options) {}
  bool wanted() const { return options_.retired != nullptr || options_.machine.word_clocks != nullptr; }
  void left_memory(const Retired& word, std::uint64_t then) override {
    if (options_.retired != nullptr) options_.retired->push_back(word);
    if (options_.machine.word_clocks == nullptr) return;
    WordClocks& clocks = (*options_.machine.word_clocks)[word.pc];
    clocks.times += !word.killed;
    clocks.clocks += word.clock + 1 - then;
  }

 private:
  const RunOptions& options_;
};

/// The core with the marks of its program.
class MarkedCore {
 public:
  MarkedCore(TimedCore& core, MarkedServices& services) : core_(core), services_(services) {}

  /// Executes up to so many words and returns how many are left, more than 0 also behind one that reached a device.
  std::uint64_t run(std::uint64_t words) {
    // Whether a mark whose step is put off waits in MEM is known behind the next word.
    const std::uint64_t now = words != 0 && waiting_ ? 1 : words;
    const std::uint64_t left = words - now + core_.run_to_service(now);
    keep_waiting();
    if (auto mark = services_.take()) {
      mark->instructions = core_.state().instructions - 1;
      mark->cycles = static_cast<std::int64_t>(core_.time().bias);
      marks_.push_back(*mark);
      waiting_ = core_.puts_off();
    }
    return left;
  }

  /// Behind settle().
  std::vector<ProgramMark> take_marks() {
    keep_waiting();
    return std::move(marks_);
  }

 private:
  void keep_waiting() {
    if (waiting_) marks_.back().cycles = static_cast<std::int64_t>(core_.time().put_off_until());
    waiting_ = false;
  }

  TimedCore& core_;
  MarkedServices& services_;
  std::vector<ProgramMark> marks_;
  bool waiting_ = false;  ///< the last mark's step is put off
};

}  // namespace

ProgramResult run_cycle(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                        std::uint64_t limit, const RunOptions& options) {
  MarkedServices marked(services);
  Board port(spec.main_bytes, image, marked);
  TimedCore core(spec.processor, port, spec);
  start(core.state(), image);
  Log log(options);
  if (log.wanted()) core.time().listen(&log);
  MarkedCore words(core, marked);
  const auto run = [&words](std::uint64_t budget) { return words.run(budget); };
  std::uint64_t left = debugged(options.machine.debugger, core, run, port, limit);
  while (left != 0 && !port.stopped()) {
    const std::uint64_t now = std::min(left, kProgressWords);
    left -= now - words.run(now);
    if (options.machine.progress) options.machine.progress(static_cast<std::int64_t>(core.time().bias));
  }
  const r3000::State& state = core.state();
  ProgramResult result = result_of(state, port, spec);
  Counters counters;
  if (limit != 0) {  // else no clock passes
    core.settle();
    counters = core.time().counters(state.instructions, core.time().bias);
  }
  result.cycles = static_cast<std::int64_t>(counters.cycles);
  result.marks = words.take_marks();
  result.units = units_of(counters, r3000::counters_of(state));
  if (options.final_state != nullptr) {
    *options.final_state = state;
    r3000::finish_load(*options.final_state);
  }
  return result;
}

}  // namespace dendro::sgi_4d35
