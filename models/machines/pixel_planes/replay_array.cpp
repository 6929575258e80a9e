#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/cycle_array.h"
#include "models/machines/pixel_planes/replay_planes.h"
#include "models/parts/igc/igc_disasm.h"
#include "sim/trace/digest.h"
#include "sim/trace/replay_unit.h"

namespace dendro::pixel_planes {
namespace {

using igc::PixelPlane;
using trace::Record;
using trace::Replayer;

constexpr std::pair<const char*, PixelPlane> kFlags[] = {
    {"enable", PixelPlane::kEnable}, {"carry", PixelPlane::kCarry}, {"data", PixelPlane::kData}};

/// Tree and pixels at one level. Clocks do not go back.
class ArrayUnit {
 public:
  virtual ~ArrayUnit() = default;
  /// Stands before clock `clock` with this state. First call.
  virtual void begin(std::int64_t clock, const ArrayState& state) = 0;
  virtual void start(std::int64_t a, std::int64_t b, std::int64_t c) = 0;
  /// False: the clock is stolen.
  virtual bool send(std::int64_t clock, const igc::ArrayWord& word) = 0;
  /// Clocks that are over by now, in which words took effect, in order: one for each word.
  virtual const std::vector<std::int64_t>& effects() const = 0;
  /// All words that were sent take effect.
  virtual void drain() = 0;
  /// Stands before clock `clock`.
  virtual void go_to(std::int64_t clock) = 0;
  virtual Plane plane(PixelPlane which, unsigned bit) = 0;
};

class CycleUnit : public ArrayUnit {
 public:
  explicit CycleUnit(const Spec& spec) : array_(spec) {}

  void begin(std::int64_t, const ArrayState& state) override { array_.state() = state; }
  void start(std::int64_t a, std::int64_t b, std::int64_t c) override { array_.start(a, b, c); }
  bool send(std::int64_t clock, const igc::ArrayWord& word) override {
    const auto visible = array_.send(clock, word);
    if (visible) effects_.push_back(*visible - 1);
    return visible.has_value();
  }
  const std::vector<std::int64_t>& effects() const override { return effects_; }
  void drain() override {}
  void go_to(std::int64_t clock) override { array_.go_to(clock); }
  Plane plane(PixelPlane which, unsigned bit) override {
    const ArrayState& state = array_.state();
    switch (which) {
      case PixelPlane::kEnable: return state.enable;
      case PixelPlane::kCarry: return state.carry;
      case PixelPlane::kData: return state.data;
      default: return state.memory.at(bit);
    }
  }

 private:
  CycleArray array_;
  std::vector<std::int64_t> effects_;
};

class ClockedUnit : public ArrayUnit {
 public:
  explicit ClockedUnit(const Spec& spec) : spec_(spec), thieves_(spec), array_(spec) {}

  void begin(std::int64_t clock, const ArrayState& state) override {
    now_ = clock;
    thieves_.resume(clock);
    igc::ClockedPlanes& planes = array_.planes();
    for (unsigned bit = 0; bit < state.memory.size(); ++bit) planes.set_plane(PixelPlane::kMemory, bit, state.memory[bit]);
    planes.set_plane(PixelPlane::kEnable, 0, state.enable);
    planes.set_plane(PixelPlane::kCarry, 0, state.carry);
    planes.set_plane(PixelPlane::kData, 0, state.data);
  }
  void start(std::int64_t a, std::int64_t b, std::int64_t c) override { stream_ = {{a, b, c}}; }
  bool send(std::int64_t clock, const igc::ArrayWord& word) override {
    go_to(clock);
    if (thieves_.steal(now_) != ClockedCause::kBusy) return false;
    if (stream_) array_.start((*stream_)[0], (*stream_)[1], (*stream_)[2]);
    stream_.reset();
    free_clock(&word);
    return true;
  }
  const std::vector<std::int64_t>& effects() const override { return effects_; }
  void drain() override {
    while (array_.words_on_their_way() > 0) go_to(now_ + 1);
  }
  void go_to(std::int64_t clock) override {
    while (now_ < clock) {
      if (quiet_ > kSettledClocks) {
        now_ = clock;
        thieves_.resume(clock);
      } else if (thieves_.steal(now_) != ClockedCause::kBusy) {
        ++now_;
      } else {
        free_clock(nullptr);
      }
    }
  }
  Plane plane(PixelPlane which, unsigned bit) override { return array_.planes().plane(which, bit); }

 private:
  void free_clock(const igc::ArrayWord* word) {
    quiet_ = word == nullptr && array_.words_on_their_way() == 0 ? quiet_ + 1 : 0;
    if (array_.clock(word)) effects_.push_back(now_);
    ++now_;
  }

  Spec spec_;
  ClockedThieves thieves_;
  ClockedArraySide array_;
  std::optional<std::array<std::int64_t, 3>> stream_;
  std::vector<std::int64_t> effects_;
  std::int64_t now_ = 0, quiet_ = 0;
};

class ArrayReplay : public trace::ReplayedUnit {
 public:
  ArrayReplay(const Spec& spec, Level level, Replayer& replayer)
      : spec_(spec), replayer_(replayer), planes_{spec_, replayer}, initial_(spec) {
    if (level == Level::kClocked)
      unit_ = std::make_unique<ClockedUnit>(spec);
    else
      unit_ = std::make_unique<CycleUnit>(spec);
  }

  void before(const Record& record) {
    if (record.at.kind != trace::When::Kind::kRelative) return;
    drain();
    replayer_.complete(after_word_ ? seen_.back().visible : now_);
  }

  void take(const Record& record, std::int64_t at) {
    if (record.op.compare(0, 4, "set_") == 0) {
      set(record, at);
      return;
    }
    if (at < now_) replayer_.fail(record, fmt::format("tick {} lies before the record in front", at));
    if (!begun_) unit_->begin(at, initial_);
    begun_ = true;
    now_ = at;
    if (record.op == "word")
      send(record, at);
    else if (record.op == "stream")
      unit_->start(record.value(0), record.value(1), record.value(2));
    else
      look(record, at);
    after_word_ = record.op == "word";
    check_effects();
  }

  void finish() {
    drain();
    replayer_.complete(seen_.empty() ? now_ : std::max(now_, seen_.back().visible));
  }

 private:
  struct Sent {
    Record record;
    std::int64_t at = 0, visible = 0;
  };

  void drain() {
    unit_->drain();
    check_effects();
  }

  void set(const Record& record, std::int64_t at) {
    if (begun_) replayer_.fail(record, fmt::format("`{}` comes before everything else", record.op));
    if (record.op == "set_memory")
      planes_.set(record, 1, initial_.memory[planes_.bit_of(record)]);
    else
      planes_.set(record, 0, record.op == "set_enable" ? initial_.enable : record.op == "set_carry" ? initial_.carry : initial_.data);
    now_ = at;
  }

  void send(const Record& record, std::int64_t at) {
    const igc::ArrayWord word = checked_word(record);
    if (sent_before_ && at <= last_sent_) replayer_.fail(record, "a clock has one word");
    if (!unit_->send(at, word)) replayer_.fail(record, fmt::format("clock {} is stolen by refresh or video: no word goes out", at));
    sent_.push_back({record, at, 0});
    sent_before_ = true;
    last_sent_ = at;
  }

  igc::ArrayWord checked_word(const Record& record) const {
    const auto named = [&](const char* key, auto count) {
      replayer_.within(record, key, record.key(key), 0, static_cast<std::int64_t>(count) - 1);
    };
    named("function", igc::Function::kCount), named("data", igc::DataOp::kCount), named("source", igc::Source::kCount);
    named("tree", 2);
    for (const char* key : {"read_a", "write_a", "read_b", "write_b"}) named(key, igc::kMostMemoryBits);
    for (const char* key : {"x", "y"}) {
      named(key, igc::Operand::kCount);
      if (record.key(key) == static_cast<std::int64_t>(igc::Operand::kConstant))
        replayer_.fail(record, fmt::format("{}: the controller sends a constant as 0 or 1", key));
    }
    for (const auto& [read, write] : {std::pair{"read_a", "write_a"}, std::pair{"read_b", "write_b"}})
      if (record.has(read) && record.has(write) && record.key(read) != record.key(write))
        replayer_.fail(record, fmt::format("{} and {}: a port takes one address a clock", read, write));
    return word_of(record);
  }

  void look(const Record& record, std::int64_t at) {
    unit_->go_to(at);
    check_effects();
    const auto memory = [this](unsigned bit) { return unit_->plane(PixelPlane::kMemory, bit); };
    if (record.op == "plane") {
      planes_.expect_plane(record, memory(planes_.bit_of(record)));
    } else if (record.op == "pixel") {
      planes_.expect_pixel(record, memory);
      const std::size_t pixel = planes_.pixel_of(record);
      for (const auto& [key, which] : kFlags)
        if (record.expected(key))
          replayer_.expect_key(record, key, bit_at(unit_->plane(which, 0), pixel), fmt::format("{} of pixel {} is", key, pixel));
    } else {
      const std::string when = fmt::format("before clock {}{}", at, behind());
      if (record.expected("enabled"))
        replayer_.expect_key(record, "enabled", ones_of(unit_->plane(PixelPlane::kEnable, 0)), "enabled pixels " + when + ":");
      for (const auto& [key, which] : kFlags)
        if (record.expected(key))
          planes_.expect_digest(record, key, trace::digest(unit_->plane(which, 0)), fmt::format("the digest of {} {}", key, when));
      if (record.expected("memory"))
        planes_.expect_digest(record, "memory", digest_of(memory_of(spec_, memory)), "the digest of the memory " + when);
    }
  }

  /// Which word took effect last.
  std::string behind() {
    while (seen_.size() > 1 && seen_[1].visible <= now_) seen_.pop_front();
    if (seen_.empty() || seen_.front().visible > now_) return "";
    const Record& word = seen_.front().record;
    return fmt::format(", behind `{}` of line {}", igc::text_of(word_of(word)), word.line);
  }

  void check_effects() {
    while (checked_ < unit_->effects().size()) {
      Sent sent = std::move(sent_.front());
      sent_.pop_front();
      sent.visible = unit_->effects()[checked_++] + 1;
      replayer_.expect_tick(sent.record, sent.at, sent.visible,
                            fmt::format("`{}`, sent in clock {}: its effect is seen", igc::text_of(word_of(sent.record)), sent.at));
      seen_.push_back(std::move(sent));
      while (seen_.size() > 1 && seen_[1].visible <= now_) seen_.pop_front();
    }
  }

  Spec spec_;
  Replayer& replayer_;
  PlaneRecords planes_;
  ArrayState initial_;
  std::unique_ptr<ArrayUnit> unit_;
  std::deque<Sent> sent_;  ///< words whose effect is not checked
  std::size_t checked_ = 0;
  std::deque<Sent> seen_;  ///< the last word whose effect is there, and those behind it
  std::int64_t now_ = 0, last_sent_ = 0;
  bool begun_ = false, sent_before_ = false, after_word_ = false;
};

}  // namespace

trace::ReplayResult replay_array(const Spec& spec, Level level, trace::Reader& trace) {
  return trace::replay_unit<ArrayReplay>(spec, spec.tick_ps, level, trace);
}

}  // namespace dendro::pixel_planes
