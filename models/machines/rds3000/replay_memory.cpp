#include <algorithm>
#include <memory>

#include "models/machines/rds3000/boundaries.h"
#include "models/machines/rds3000/clocked_cards.h"
#include "models/machines/rds3000/clocked_display.h"
#include "models/machines/rds3000/devices.h"
#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/dr64/dr64_timing.h"
#include "sim/trace/digest.h"
#include "sim/trace/replay_unit.h"

namespace dendro::rds3000 {
namespace {

using trace::Record;
using trace::Replayer;

/// The cards with their refresh and the display's fetches, at one level.
class MemoryTime {
 public:
  virtual ~MemoryTime() = default;
  /// Starts at `tick` with this standing instead of power-on. First call, if made at all.
  virtual void resume(std::int64_t tick, const dr64::Timing::Standing& standing, const video::Raster& raster,
                      std::int64_t origin_ps) = 0;
  /// A card is busy until `free`. Right after resume().
  virtual void busy(unsigned card, std::int64_t free) = 0;
  /// The tick at which an access that asks at `tick` gets its cards. In order of time.
  virtual std::int64_t grant(std::int64_t tick, const dr64::Work& work, bool write) = 0;
  /// The raster restarts at the end of `tick`.
  virtual void restart(std::int64_t tick, const video::Raster& raster) = 0;
};

class CycleMemory : public MemoryTime {
 public:
  explicit CycleMemory(const Spec& spec)
      : tick_ps_(spec.processor.tick_ps), timing_(spec.memory, tick_ps_) {
    const video::Raster raster = video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
    timing_.set_fetches({raster, -spec.video.phase_ps, 0, tick_ps_});
  }
  void resume(std::int64_t, const dr64::Timing::Standing& standing, const video::Raster& raster,
              std::int64_t origin_ps) override {
    standing_ = standing;
    timing_.resume(standing_);
    timing_.set_fetches({raster, origin_ps, standing.next_fetch_ps, tick_ps_});
  }
  void busy(unsigned card, std::int64_t free) override {
    standing_.free_at[card] = free;
    timing_.resume(standing_);
  }
  std::int64_t grant(std::int64_t tick, const dr64::Work& work, bool write) override {
    return timing_.grant(tick, work, write);
  }
  void restart(std::int64_t tick, const video::Raster& raster) override {
    timing_.catch_up(tick + 1);
    timing_.set_fetches({raster, tick * tick_ps_, tick * tick_ps_, tick_ps_});
  }

 private:
  std::int64_t tick_ps_;
  dr64::Timing timing_;
  dr64::Timing::Standing standing_;
};

/// The clocked level's cards and display, tick by tick.
class ClockedMemory : public MemoryTime {
 public:
  explicit ClockedMemory(const Spec& spec)
      : spec_(spec), tick_ps_(spec.processor.tick_ps), cards_(spec.memory) {
    const std::int64_t interval = spec.memory.refresh_interval_ps;
    next_refresh_ps_ = interval > 0 ? interval : INT64_MAX;
    display_.restart(video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits),
                     -spec.video.phase_ps, 0);
  }
  void resume(std::int64_t tick, const dr64::Timing::Standing& standing, const video::Raster& raster,
              std::int64_t origin_ps) override {
    now_ = tick - 1;
    if (spec_.memory.refresh_interval_ps > 0) next_refresh_ps_ = standing.next_refresh_ps;
    display_.restart(raster, origin_ps, standing.next_fetch_ps);
  }
  void busy(unsigned card, std::int64_t free) override {
    // Counted from the tick before the first, which ends when the first begins.
    const std::int64_t ticks = free - now_;
    if (ticks > ClockedCards::kMostBusyTicks)
      throw UserError(fmt::format("level clocked: a memory card may be busy for at most {} ticks at a time, not {}",
                                  ClockedCards::kMostBusyTicks, ticks));
    if (ticks > 0) cards_.take(1u << card, static_cast<int>(ticks));
  }
  std::int64_t grant(std::int64_t tick, const dr64::Work& work, bool) override {
    go_to(tick);
    while (!cards_.free(work.cards)) go_to(now_ + 1);
    cards_.take(work.cards, spec_.memory.card_busy_ticks + (work.masked ? spec_.memory.masked_write_extra_ticks : 0));
    return now_;
  }
  void restart(std::int64_t tick, const video::Raster& raster) override {
    go_to(tick);
    display_.restart(raster, now_ * tick_ps_, now_ * tick_ps_);
    events();
  }

 private:
  void go_to(std::int64_t tick) {
    while (now_ < tick) {
      cards_.end_tick();
      ++now_;
      while (next_refresh_ps_ <= now_ * tick_ps_) {
        cards_.queue_refresh();
        next_refresh_ps_ += spec_.memory.refresh_interval_ps;
      }
      events();
    }
  }
  void events() {
    for (unsigned due = display_.step(now_ * tick_ps_); due > 0; --due) cards_.queue_fetch();
    cards_.serve(counters_);
  }

  Spec spec_;
  std::int64_t tick_ps_;
  ClockedCards cards_;
  ClockedDisplay display_;
  std::int64_t next_refresh_ps_, now_ = -1;
  dr64::Counters counters_;
};

class MemoryReplay : public trace::ReplayedUnit {
 public:
  MemoryReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec), replayer_(replayer), core_(spec.memory), video_(video::power_on(spec.video.mode)) {
    if (level == Level::kClocked)
      time_ = std::make_unique<ClockedMemory>(spec);
    else
      time_ = std::make_unique<CycleMemory>(spec);
  }

  void take(const Record& record, std::int64_t at) {
    if (record.op == "read" || record.op == "write")
      access(record, at, record.op == "write");
    else if (record.op == "display")
      display(record, at);
    else if (record.op == "contents")
      replayer_.expect_word(record, "digest", trace::digest(core_.state().pixels));
    else if (record.op == "pixel")
      replayer_.expect_data(record, core_.state().pixels[pixel_index(record)], "the pixel");
    else
      set(record, at);
  }

 private:
  // The bus gives the cards one access at a time: one that asks earlier waits for its turn.
  void access(const Record& record, std::int64_t at, bool write) {
    moving_ = true;
    const auto address = static_cast<std::uint32_t>(record.value(0)) & kAddressMask;
    const auto function = static_cast<unsigned>(replayer_.within(record, "fn", record.key("fn", bps32::kFnLores), 0, 15));
    if (address >= kImageEnd) replayer_.fail(record, fmt::format("0x{:x} is no address of image memory", address));
    const dr64::Work work = core_.probe(address, function, write);
    const std::int64_t turn = std::max(at, turn_);
    const std::int64_t granted = work.cards == 0 ? turn : time_->grant(turn, work, write);
    turn_ = granted + 1;
    std::int64_t done = granted + spec_.bus.write_ticks;
    if (write) {
      core_.write(address, static_cast<std::uint32_t>(record.value(1)), function);
    } else {
      done = granted + (work.cards != 0 ? spec_.memory.read_ticks : spec_.bus.register_read_ticks);
      replayer_.expect_data(record, core_.read(address, function), fmt::format("the word at 0x{:x}", address));
    }
    replayer_.complete(done);
    const std::string who = fmt::format("the {} of 0x{:x} that asked at tick {}", record.op, address, at);
    replayer_.expect_key(record, "wait", granted - at, who + ": ticks it waited for its cards:");
    replayer_.expect_tick(record, at, done, fmt::format("{}, granted at tick {}: complete", who, granted));
  }

  void display(const Record& record, std::int64_t at) {
    moving_ = true;
    const auto index = static_cast<std::size_t>(replayer_.within(record, "register", record.value(0), 0, 7));
    const std::int64_t tick = std::max(at, turn_ - 1);
    const video::Raster before = raster();
    video_.fbc[index] = static_cast<std::uint32_t>(record.value(1));
    if (raster() != before) time_->restart(tick, raster());
    replayer_.complete(tick);
  }

  void set(const Record& record, std::int64_t at) {
    if (moving_) replayer_.fail(record, fmt::format("`{}` comes before everything else", record.op));
    const auto word = static_cast<std::uint32_t>(record.value(1));
    if (record.op == "set_pixel") {
      const std::size_t index = pixel_index(record), room = core_.state().pixels.size() - index;
      const auto count = replayer_.within(record, "count", record.key("count", 1), 1, static_cast<std::int64_t>(room));
      std::fill_n(core_.state().pixels.begin() + static_cast<std::ptrdiff_t>(index), count, word & spec_.memory.pixel_mask());
    } else if (record.op == "set_mask") {
      const std::int64_t kind = replayer_.within(record, "function", record.value(0), bps32::kFnMaskWord, bps32::kFnMaskHires);
      core_.write(0, word, static_cast<unsigned>(kind));
    } else if (record.op == "set_display") {
      video_.fbc[static_cast<std::size_t>(replayer_.within(record, "register", record.value(0), 0, 7))] = word;
    } else if (record.op == "set_card") {
      const auto card = replayer_.within(record, "card", record.value(0), 0, spec_.memory.cards() - 1);
      time_->busy(static_cast<unsigned>(card), replayer_.checked(record, record.key("free")));
    } else {
      dr64::Timing::Standing standing;
      standing.next_refresh_ps = record.key("refresh_ps");
      standing.next_fetch_ps = record.key("fetch_ps");
      check_events(record, at, standing);
      time_->resume(at, standing, raster(), record.key("origin_ps"));
    }
    replayer_.complete(at);
  }

  // Events further back than a field would be caught up with one by one.
  void check_events(const Record& record, std::int64_t at, const dr64::Timing::Standing& standing) const {
    const std::int64_t now_ps = at * spec_.processor.tick_ps, near = 1'000'000'000'000;
    const bool refreshes = spec_.memory.refresh_interval_ps > 0, displays = raster().fetches_per_line > 0;
    const auto far = [&](std::int64_t ps) { return ps < now_ps - near || ps > now_ps + near; };
    if ((refreshes && far(standing.next_refresh_ps)) || (displays && far(standing.next_fetch_ps)) ||
        record.key("origin_ps") > now_ps || record.key("origin_ps") < -near * 1000)
      replayer_.fail(record, "an event of this standing is more than a second from its tick");
  }

  video::Raster raster() const { return video::raster_of(video_, spec_.video, spec_.memory.fetch_bits); }
  std::size_t pixel_index(const Record& record) const {
    return static_cast<std::size_t>(replayer_.within(record, "pixel", record.value(0), 0,
                                                     static_cast<std::int64_t>(core_.state().pixels.size()) - 1));
  }

  Spec spec_;
  Replayer& replayer_;
  dr64::Core core_;
  video::State video_;
  std::unique_ptr<MemoryTime> time_;
  std::int64_t turn_ = 0;
  bool moving_ = false;
};

}  // namespace

trace::ReplayResult replay_memory(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<MemoryReplay>(spec, spec.processor.tick_ps, level, trace);
}

}  // namespace dendro::rds3000
