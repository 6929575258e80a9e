#include "models/machines/pixel_planes/replay_commands.h"

#include <algorithm>
#include <deque>
#include <optional>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "models/machines/pixel_planes/replay_planes.h"
#include "models/parts/igc/igc_disasm.h"
#include "sim/base/error.h"
#include "sim/trace/replay_unit.h"

namespace dendro::pixel_planes {
namespace {

using trace::Record;
using trace::Replayer;

class CommandReplay : public trace::ReplayedUnit {
 public:
  CommandReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec),
        replayer_(replayer),
        planes_{spec_, replayer},
        unit_(make_command_unit(spec, level)),
        memory_(ArrayState(spec).memory) {}

  void before(const Record& record) {
    if (record.at.kind != trace::When::Kind::kRelative) return;
    drain();
    replayer_.complete(after_command_ ? last_done_ : now_);
  }

  void take(const Record& record, std::int64_t at) {
    if (record.op.compare(0, 4, "set_") == 0) {
      set(record, at);
      return;
    }
    if (at < last_at_) replayer_.fail(record, fmt::format("tick {} lies before the record in front", at));
    last_at_ = at;
    if (!begun_) unit_->begin(at, controller_, memory_);
    begun_ = true;
    now_ = std::max(now_, at);
    after_command_ = false;
    refused(record, [&] { drive(record, at); });
    check_done();
  }

  void finish() {
    drain();
    replayer_.complete(std::max(now_, last_done_));
  }

 private:
  /// A command whose clocks are not checked yet.
  struct Pending {
    Record record;
    igc::Command command;
    std::int64_t at = 0;
  };

  void drain() {
    if (!pending_.empty()) refused(pending_.front().record, [&] { unit_->finish(checked_ + pending_.size()); });
    check_done();
  }

  // What the machine refuses is the trace's fault: of the line whose command it is.
  template <class Drive>
  void refused(const Record& record, const Drive& drive) {
    try {
      drive();
    } catch (const UserError& error) {
      if (!error.file().empty()) throw;
      check_done();
      replayer_.fail(pending_.empty() ? record : pending_.front().record, error.message());
    }
  }

  void set(const Record& record, std::int64_t at) {
    if (begun_) replayer_.fail(record, fmt::format("`{}` comes before everything else", record.op));
    const auto number = [&](const char* what, std::int64_t most) {
      return static_cast<std::size_t>(replayer_.within(record, what, record.value(0), 0, most));
    };
    if (record.op == "set_memory") {
      planes_.set(record, 1, memory_[planes_.bit_of(record)]);
    } else if (record.op == "set_register") {
      controller_.registers[number("register", igc::kRegisters - 1)] =
          static_cast<std::uint8_t>(replayer_.within(record, "value", record.value(1), 0, 255));
    } else {
      const std::size_t first = number("word", igc::kStoreWords - 1);
      const auto count = replayer_.within(record, "count", record.key("count", 1), 1, static_cast<std::int64_t>(igc::kStoreWords - first));
      std::fill_n(controller_.store.begin() + static_cast<std::ptrdiff_t>(first), count, record.values[1].value);
    }
    last_at_ = now_ = at;
  }

  // The host does one thing after another: what comes too early waits until the one in front is over.
  void drive(const Record& record, std::int64_t at) {
    if (record.op == "command" || record.op == "register") {
      if (unit_->lacks_words()) replayer_.fail(record, "the command in front lacks words");
      check_command(record);
      offer(record, fifo_words_of(record), at);
    } else if (record.op == "word") {
      offer(record, {static_cast<std::uint32_t>(replayer_.within(record, "word", record.value(0), 0, 0xFFFFFFFF))}, at);
    } else if (record.op == "store") {
      const auto address = replayer_.within(record, "address", record.value(0), 0, kControlStoreEnd - 1);
      const auto word = replayer_.within(record, "word", record.value(1), 0, 0xFFFFFFFF);
      unit_->store(now_, static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(word));
    } else if (record.op == "status") {
      replayer_.expect_data(record, unit_->busy(now_) ? 1 : 0, fmt::format("the status in clock {}", now_));
    } else {
      look(record, at);
    }
  }

  void check_command(const Record& record) const {
    const auto within = [&](const char* key, std::int64_t most) { replayer_.within(record, key, record.key(key), 0, most); };
    if (record.op == "register") {
      replayer_.within(record, "register", record.value(0), 0, igc::kRegisters - 1);
      replayer_.within(record, "value", record.value(1), 0, 255);
      return;
    }
    within("entry", igc::kStoreWords - 1), within("fraction", 63), within("guard", 63);
    for (const char* key : {"a", "b", "c", "constant", "high"}) within(key, 0xFFFFFFFF);
    for (const auto& [key, number] : record.keys)
      if (key.size() == 1 && !number.single && !number.hex)
        replayer_.fail(record, fmt::format("{}: a coefficient has a point, as 1.0, or is its 32 bits in hexadecimal", key));
  }

  // The words of a command, or one that stands for itself.
  void offer(const Record& record, const std::vector<std::uint32_t>& words, std::int64_t at) {
    for (std::size_t k = words.size(); k < 6; ++k)
      if (record.has("at" + std::to_string(k)))
        replayer_.fail(record, fmt::format("at{}: the command has {} words", k, words.size()));
    std::int64_t landed = now_;
    for (std::size_t k = 0; k < words.size(); ++k) {
      std::int64_t clock = landed;
      if (k > 0) {
        const std::string key = "at" + std::to_string(k);
        clock = std::max(landed, at + replayer_.within(record, key.c_str(), record.key(key), 0, 1 << 30));
      }
      landed = unit_->offer(clock, words[k]);
      words_.push_back(words[k]);
    }
    now_ = landed;
    replayer_.expect_key(record, "landed", landed - at, fmt::format("clocks from tick {} until the last word is in the FIFO:", at));
    if (unit_->lacks_words()) {
      if (record.answer_at.given() || record.expected("fifo") || record.expected("taken"))
        replayer_.fail(record, "it is not the last word of a command");
      return;
    }
    replayer_.expect_key(record, "fifo", static_cast<std::int64_t>(unit_->words_before()),
                         fmt::format("words in the FIFO when the last lands in clock {}:", landed));
    pending_.push_back({record, decoded(), at});
    words_.clear();
    after_command_ = true;
  }

  igc::Command decoded() const {
    CommandDecoder decoder;
    std::optional<igc::Command> command;
    for (const std::uint32_t word : words_) command = decoder.add(word);
    return command.value();
  }

  void look(const Record& record, std::int64_t at) {
    if (unit_->lacks_words()) replayer_.fail(record, "the last command lacks words, so the machine never becomes idle");
    const std::int64_t idle = unit_->idle_from(now_);
    check_done();
    now_ = idle;
    const auto memory = [this](unsigned bit) { return unit_->plane(bit); };
    if (record.op == "pixel") {
      planes_.expect_pixel(record, memory);
    } else if (record.op == "plane") {
      planes_.expect_plane(record, memory(planes_.bit_of(record)));
    } else {
      replayer_.expect_tick(record, at, idle, "the machine is idle");
      if (record.expected("digest"))
        planes_.expect_digest(record, "digest", digest_of(memory_of(spec_, memory)),
                              fmt::format("the digest of the memory, idle from tick {}{},", idle, behind()));
    }
  }

  std::string behind() const {
    if (!last_checked_) return "";
    return fmt::format(", behind `{}` of line {}", igc::text_of(last_checked_->command), last_checked_->record.line);
  }

  void check_done() {
    for (; checked_ < unit_->done().size(); ++checked_) {
      const CommandTimes& times = unit_->done()[checked_];
      const Pending p = pending_.front();
      pending_.pop_front();
      last_done_ = times.free;
      last_checked_ = p;
      const std::string which = fmt::format("`{}`", igc::text_of(p.command));
      replayer_.expect_key(p.record, "taken", times.taken - p.at,
                           fmt::format("{}, offered from tick {} on: clocks until the controller takes it:", which, p.at));
      replayer_.expect_tick(p.record, p.at, times.free, fmt::format("{}, taken at tick {}: done", which, times.taken));
    }
  }

  Spec spec_;
  Replayer& replayer_;
  PlaneRecords planes_;
  std::unique_ptr<CommandUnit> unit_;
  igc::ControllerState controller_;
  std::vector<Plane> memory_;           ///< before the first record that is no `set_...`
  std::vector<std::uint32_t> words_;    ///< of the command that is not whole yet
  std::deque<Pending> pending_;
  std::optional<Pending> last_checked_;
  std::size_t checked_ = 0;
  std::int64_t last_at_ = 0, now_ = 0, last_done_ = 0;
  bool begun_ = false, after_command_ = false;
};

}  // namespace

trace::ReplayResult replay_commands(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<CommandReplay>(spec, spec.tick_ps, level, trace);
}

}  // namespace dendro::pixel_planes
