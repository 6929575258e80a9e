#include "models/machines/rds3000/replay_processor.h"

#include <algorithm>
#include <memory>

#include "models/machines/rds3000/boundaries.h"
#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/recorder.h"
#include "models/parts/bps32/bps32.h"
#include "sim/trace/digest.h"
#include "sim/trace/replay_unit.h"

namespace dendro::rds3000 {
namespace {

using trace::Record;
using trace::Replayer;

/// Ticks without the access or halt that a trace without times waits for.
constexpr std::int64_t kPatience = std::int64_t{1} << 24;

std::string access_name(bool write, std::uint32_t address, unsigned function) {
  return fmt::format("{} of 0x{:x} with function {}", write ? "write" : "read", address, function);
}

class ProcessorReplay : public trace::ReplayedUnit {
 public:
  ProcessorReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec), replayer_(replayer), initial_(bps32::power_on(spec.processor)) {
    const video::Raster raster = video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
    unit_ = level == Level::kClocked ? make_clocked_unit(spec) : make_cycle_unit(spec);
    unit_->display(-1, {raster, -spec.video.phase_ps});
  }

  void take(const Record& record, std::int64_t at) {
    if (record.op.compare(0, 3, "set") == 0) {
      set(record, at);
      return;
    }
    begin(at);
    if (record.op == "read" || record.op == "write")
      access(record, at, record.op == "write");
    else if (record.op == "halted")
      halted(record, at);
    else if (record.op == "registers")
      registers(record, at);
    else if (record.op == "scratch")
      scratch(record, at);
    else if (record.op == "display")
      display(record, at);
    else
      host(record, at);
  }

 private:
  void set(const Record& record, std::int64_t at) {
    if (loaded_) replayer_.fail(record, fmt::format("`{}` comes before everything else", record.op));
    base_ = at;
    if (record.op == "set_control") {
      fill(record, initial_.control, static_cast<std::uint64_t>(record.value(1)));
    } else if (record.op == "set_scratch") {
      fill(record, initial_.scratch, static_cast<std::uint32_t>(record.value(1)));
    } else {
      for_each_register(initial_, [&](const char* name, auto& value) {
        if (record.has(name)) value = static_cast<std::decay_t<decltype(value)>>(record.key(name));
      });
      const bool fits = initial_.pc <= 0xFFF && initial_.page <= 7 && initial_.counter <= 0xFFF && initial_.depth <= 5 &&
                        initial_.sar <= 0x1FFF && initial_.bus_address <= kAddressMask;
      if (!fits) replayer_.fail(record, "a register does not fit its width (pc, page, counter, depth, sar, bus_address)");
    }
    replayer_.complete(at);
  }

  template <class Word>
  void fill(const Record& record, std::vector<Word>& words, Word word) {
    const auto size = static_cast<std::int64_t>(words.size());
    const std::int64_t index = replayer_.within(record, "address", record.value(0), 0, size - 1);
    const std::int64_t count = replayer_.within(record, "count", record.key("count", 1), 1, size - index);
    std::fill_n(words.begin() + index, count, word);
  }

  void begin(std::int64_t at) {
    if (loaded_) return;
    loaded_ = true;
    unit_->load(initial_, base_ >= 0 ? base_ : at);
  }

  // Lives through all ticks before `end`, in which the trace has no access.
  void run_quietly(const Record& record, std::int64_t end) {
    const Started started = unit_->run(end, nullptr);
    if (started.seen)
      replayer_.differ(record, fmt::format("the processor starts a {} at tick {}; the trace has no access before this `{}`",
                                           access_name(started.write, started.address, started.function), started.tick,
                                           record.op));
  }

  void access(const Record& record, std::int64_t at, bool write) {
    const auto address = static_cast<std::uint32_t>(record.value(0)) & kAddressMask;
    const auto function = static_cast<unsigned>(replayer_.within(record, "fn", record.key("fn", bps32::kFnLores), 0, 15));
    Answer answer;
    answer.data = static_cast<std::uint32_t>(record.value(1));
    const bool image = address < kImageEnd;
    const int usual = write ? spec_.bus.write_ticks : image ? spec_.memory.read_ticks : spec_.bus.register_read_ticks;
    answer.takes = replayer_.within(record, "takes", record.key("takes", usual), 1, kPatience);
    const std::int64_t end = record.answer_at.given() ? replayer_.checked(record, record.answer_at.from(at)) + 1
                                                      : std::max(at, unit_->now()) + kPatience;
    const Started got = unit_->run(end, &answer);
    const std::string wanted = access_name(write, address, function);
    if (!got.seen)
      replayer_.differ(record, unit_->state().running
                                   ? fmt::format("the processor has started no access before tick {}; the trace says a {}", end, wanted)
                                   : fmt::format("the processor stands still and starts no access; the trace says a {}", wanted));
    if (got.write != write || got.address != address || got.function != function)
      replayer_.differ(record, fmt::format("the processor starts a {} at tick {}, the trace says a {}",
                                           access_name(got.write, got.address, got.function), got.tick, wanted));
    replayer_.complete(got.tick + answer.takes);
    if (write) replayer_.expect_data(record, got.data, fmt::format("the word of the {}", wanted));
    replayer_.expect_tick(record, at, got.tick, fmt::format("the {} starts", wanted));
  }

  void halted(const Record& record, std::int64_t at) {
    const std::int64_t end =
        record.answer_at.given() ? replayer_.checked(record, record.answer_at.from(at)) : std::max(at, unit_->now()) + kPatience;
    run_quietly(record, end);
    if (unit_->state().running) replayer_.differ(record, fmt::format("the processor still runs at tick {}", end));
    replayer_.complete(unit_->now());
    replayer_.expect_tick(record, at, unit_->now(), "the processor stands still");
  }

  void registers(const Record& record, std::int64_t at) {
    run_quietly(record, at);
    const ProcessorState& state = unit_->state();
    for_each_register(state, [&](const char* name, const auto& value) {
      replayer_.expect_word(record, name, static_cast<std::uint64_t>(value));
    });
    if (record.expected("scratch")) replayer_.expect_word(record, "scratch", trace::digest(state.scratch));
    replayer_.complete(at);
  }

  void scratch(const Record& record, std::int64_t at) {
    run_quietly(record, at);
    const auto size = static_cast<std::int64_t>(unit_->state().scratch.size());
    const auto index = static_cast<std::size_t>(replayer_.within(record, "address", record.value(0), 0, size - 1));
    replayer_.expect_data(record, unit_->state().scratch[index], fmt::format("scratch word 0x{:x}", index));
    replayer_.complete(at);
  }

  void display(const Record& record, std::int64_t at) {
    video::Phase phase;
    phase.origin_ps = record.key("origin_ps");
    phase.raster.line_ps = replayer_.within(record, "line_ps", record.key("line_ps"), 0, 1'000'000'000'000);
    phase.raster.field_lines = replayer_.within(record, "field_lines", record.key("field_lines"), 0, 1 << 16);
    phase.raster.blank_lines = replayer_.within(record, "blank_lines", record.key("blank_lines"), 0, 1 << 16);
    if (phase.raster.line_ps > 0 && phase.raster.field_lines == 0) replayer_.fail(record, "a field without lines");
    unit_->display(at, phase);
  }

  void host(const Record& record, std::int64_t at) {
    run_quietly(record, at + 1);
    replayer_.complete(at);
    if (record.op == "host_read" || record.op == "host_write") {
      const auto address = static_cast<std::uint32_t>(record.value(0)) & kAddressMask;
      if (!on_processor_board(address)) replayer_.fail(record, fmt::format("0x{:x} is not on the processor's board", address));
      const bool write = record.op == "host_write";
      const std::uint32_t word = unit_->host_access(at, write, address, static_cast<std::uint32_t>(record.value(1)));
      if (!write) replayer_.expect_data(record, word, fmt::format("the word at 0x{:x}", address));
      return;
    }
    unit_->command(at, record.op == "run", record.op == "reset");
  }

  Spec spec_;
  Replayer& replayer_;
  ProcessorState initial_;
  std::unique_ptr<ProcessorUnit> unit_;
  std::int64_t base_ = -1;
  bool loaded_ = false;
};

}  // namespace

trace::ReplayResult replay_processor(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<ProcessorReplay>(spec, spec.processor.tick_ps, level, trace);
}

}  // namespace dendro::rds3000
