#include "models/machines/pixel_planes/recorder.h"

#include <algorithm>
#include <utility>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/cycle_array.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/check.h"
#include "sim/trace/digest.h"

namespace dendro::pixel_planes {
namespace {

using trace::decimal;
using trace::hex;
using trace::Record;
using trace::When;

Record record_at(std::int64_t tick, const char* op, std::vector<trace::Number> values = {}) {
  Record record;
  record.at = When::at(tick);
  record.op = op;
  record.values = std::move(values);
  return record;
}

// One record for each run of equal words that are not zero; `first`: values in front of a word's number.
template <class Words>
void write_runs(trace::Writer& out, std::int64_t tick, const char* op, const std::vector<trace::Number>& first,
                const Words& words) {
  for (std::size_t i = 0, end; i < words.size(); i = end) {
    for (end = i + 1; end < words.size() && words[end] == words[i]; ++end) {
    }
    if (words[i] == 0) continue;
    Record record = record_at(tick, op, first);
    record.values.push_back(decimal(static_cast<std::int64_t>(i)));
    record.values.push_back(hex(words[i]));
    if (end - i > 1) record.keys.emplace_back("count", decimal(static_cast<std::int64_t>(end - i)));
    out.add(record);
  }
}

void write_memory(trace::Writer& out, std::int64_t tick, const std::vector<Plane>& memory) {
  for (std::size_t bit = 0; bit < memory.size(); ++bit)
    write_runs(out, tick, "set_memory", {decimal(static_cast<std::int64_t>(bit))}, memory[bit]);
}

/// pixel_planes.commands: what the host writes, and what becomes of it.
class CommandRecorder : public Recorder {
 public:
  using Recorder::Recorder;

  void word(std::int64_t tick, std::uint32_t value, std::int64_t landed) override {
    if (active()) words_.push_back({tick, value, landed});
  }
  void command(const Device::Done&, const CommandTimes& times) override {
    if (!active()) return;
    Record record;
    std::vector<std::uint32_t> values;
    for (const Word& word : words_) values.push_back(word.value);
    const std::int64_t first = words_.front().offered;
    if (!apart_ && record_of(values, record)) {
      for (std::size_t k = 1; k < words_.size(); ++k)
        record.keys.emplace_back("at" + std::to_string(k), decimal(words_[k].offered - first));
    } else {
      write_words(words_.size() - 1);
      record = word_record(words_.back());
    }
    const std::int64_t at = words_.back().offered;
    record.at = When::at(record.op == "word" ? at : first);
    const std::int64_t origin = record.at.ticks;
    record.answer_at = When::after(times.free - origin);
    record.answer_keys = {{"landed", decimal(words_.back().landed - origin)},
                          {"fifo", decimal(static_cast<std::int64_t>(board_.timing().words_before_last()))},
                          {"taken", decimal(times.taken - origin)}};
    out_.add(record);
    words_.clear();
    apart_ = false;
  }
  void write(std::int64_t tick, std::uint32_t address, std::uint32_t value) override {
    if (!active() || address >= kControlStoreEnd) return;
    write_words(words_.size());
    out_.add(record_at(tick, "store", {decimal(address), hex(value)}));
  }

 protected:
  void write_state(std::int64_t tick) override {
    const igc::ControllerState& controller = board_.device().controller();
    write_runs(out_, tick, "set_control", {}, controller.store);
    for (unsigned n = 0; n < igc::kRegisters; ++n)
      if (controller.registers[n] != 0)
        out_.add(record_at(tick, "set_register", {decimal(n), decimal(controller.registers[n])}));
    write_memory(out_, tick, board_.device().engine().bits().memory);
  }
  void write_end(std::int64_t tick, bool) override { seen_wait(tick); }
  void seen_status(std::int64_t tick, std::uint32_t value) override {
    write_words(words_.size());
    Record record = record_at(tick, "status");
    record.answer = decimal(value);
    out_.add(record);
  }
  void seen_wait(std::int64_t tick) override {
    Record record = record_at(tick, "idle");
    record.answer_at = When::at(std::max(tick, board_.timing().idle_from()));
    record.answer_keys = {{"digest", hex(digest_of(board_.device().engine().bits().memory))}};
    out_.add(record);
  }

 private:
  struct Word {
    std::int64_t offered = 0;
    std::uint32_t value = 0;
    std::int64_t landed = 0;
    bool written = false;
  };

  static Record word_record(const Word& word) { return record_at(word.offered, "word", {hex(word.value)}); }

  // The first `count` words of a command in which the host does something else between two words.
  void write_words(std::size_t count) {
    apart_ = !words_.empty();
    for (std::size_t k = 0; k < count; ++k)
      if (!std::exchange(words_[k].written, true)) out_.add(word_record(words_[k]));
  }

  std::vector<Word> words_;  ///< of the command that is not whole yet
  bool apart_ = false;       ///< some of them are records of their own
};

/// pixel_planes.array: words and streams that the controller sends.
class ArrayRecorder : public Recorder {
 public:
  ArrayRecorder(trace::Writer& out, const Spec& spec, CycleBoard& board) : Recorder(out, spec, board), array_(spec) {}

  void command(const Device::Done& done, const CommandTimes& times) override {
    if (done.command.header.register_write) return;  // sends an idle word
    bool had_tree = false;
    std::int64_t clock = times.taken, visible = 0;
    for (const igc::ArrayWord& word : board_.device().words_of(done.command)) {
      clock = array_.first_free(clock);
      write_states(clock);
      if (word.tree && !had_tree) start(clock, done.command);
      had_tree = word.tree;
      visible = send(clock, word);
      ++clock;
    }
    DENDRO_CHECK(clock == times.free, "{} {}", clock, times.free);
    states_.push_back(visible);
  }

 protected:
  void write_state(std::int64_t tick) override {
    array_.go_to(tick);
    states_.clear();
    const ArrayState& state = array_.state();
    write_memory(out_, tick, state.memory);
    write_runs(out_, tick, "set_enable", {}, state.enable);
    write_runs(out_, tick, "set_carry", {}, state.carry);
    write_runs(out_, tick, "set_data", {}, state.data);
  }
  void write_end(std::int64_t tick, bool of_run) override {
    const std::int64_t at = of_run ? tick : std::max(tick, board_.timing().idle_from());
    write_states(at);
    if (!any_) return;
    Record record = state_record(at);
    record.answer_keys.emplace_back("memory", hex(digest_of(board_.device().engine().bits().memory)));
    out_.add(record);
  }

 private:
  void start(std::int64_t clock, const igc::Command& command) {
    array_.start(command.a, command.b, command.c);
    if (active()) out_.add(record_at(clock, "stream", {decimal(command.a), decimal(command.b), decimal(command.c)}));
  }
  std::int64_t send(std::int64_t clock, const igc::ArrayWord& word) {
    const auto visible = array_.send(clock, word);
    DENDRO_CHECK(visible, "clock {} is stolen", clock);
    if (!active()) return *visible;
    any_ = true;
    Record record = record_at(clock, "word");
    record.keys = keys_of(word);
    record.answer_at = When::after(*visible - clock);
    out_.add(record);
    return *visible;
  }
  Record state_record(std::int64_t clock) {
    array_.go_to(clock);
    const ArrayState& state = array_.state();
    Record record = record_at(clock, "state");
    record.answer_keys = {{"enable", hex(trace::digest(state.enable))}, {"enabled", decimal(ones_of(state.enable))}};
    return record;
  }
  // Those behind the commands whose last word has taken effect up to `clock`.
  void write_states(std::int64_t clock) {
    for (; !states_.empty() && states_.front() <= clock; states_.pop_front())
      if (active()) out_.add(state_record(states_.front()));
  }

  CycleArray array_;
  std::deque<std::int64_t> states_;  ///< clocks at which a command's last word has taken effect
  bool any_ = false;                 ///< words in the window
};

}  // namespace

void Recorder::before(std::int64_t tick) {
  if (board_.lacks_words()) return;
  if (!begun_ && tick >= out_.from() && tick < out_.to() && tick >= board_.timing().idle_from()) {
    if (tick > 0) write_state(tick);
    begun_ = true;
  }
  if (active() && tick >= out_.to()) {
    write_end(tick, false);
    ended_ = true;
  }
}

void Recorder::status(std::int64_t tick, std::uint32_t value) {
  before(tick);
  if (active()) seen_status(tick, value);
}

void Recorder::wait(std::int64_t tick) {
  before(tick);
  if (active()) seen_wait(tick);
}

void Recorder::end(std::int64_t tick) {
  before(tick);
  if (active()) write_end(tick, true);
  ended_ = true;
}

std::unique_ptr<Recorder> make_recorder(trace::Writer& out, const Spec& spec, CycleBoard& board) {
  if (out.boundary() == kCommandsBoundary) return std::make_unique<CommandRecorder>(out, spec, board);
  DENDRO_CHECK(out.boundary() == kArrayBoundary, "{}", out.boundary());
  return std::make_unique<ArrayRecorder>(out, spec, board);
}

}  // namespace dendro::pixel_planes
