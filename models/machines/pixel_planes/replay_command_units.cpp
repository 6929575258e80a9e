#include <algorithm>
#include <utility>

#include "models/machines/pixel_planes/clocked_renderer.h"
#include "models/machines/pixel_planes/cycle_board.h"
#include "models/machines/pixel_planes/replay_commands.h"
#include "models/machines/pixel_planes/replay_planes.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {
namespace {

class CycleUnit : public CommandUnit {
 public:
  explicit CycleUnit(const Spec& spec) : tick_ps_(spec.tick_ps), board_(spec) {}

  void begin(std::int64_t, const igc::ControllerState& controller, const std::vector<Plane>& memory) override {
    for (std::uint32_t n = 0; n < igc::kStoreWords; ++n) {
      board_.device().write(2 * n, static_cast<std::uint32_t>(controller.store[n]));
      board_.device().write(2 * n + 1, static_cast<std::uint32_t>(controller.store[n] >> 32));
    }
    for (unsigned n = 0; n < igc::kRegisters; ++n) board_.device().set_register(n, controller.registers[n]);
    board_.device().engine().before_first().memory = memory;
  }
  std::int64_t offer(std::int64_t clock, std::uint32_t word) override {
    const CycleBoard::Offered offered = board_.offer(clock * tick_ps_, word);
    if (offered.done) done_.push_back(offered.times);
    return offered.host_ps / tick_ps_;
  }
  std::size_t words_before() const override { return board_.timing().words_before_last(); }
  void store(std::int64_t clock, std::uint32_t address, std::uint32_t value) override {
    board_.write(clock * tick_ps_, address, value);
  }
  bool busy(std::int64_t clock) override { return board_.busy(clock * tick_ps_); }
  bool lacks_words() const override { return board_.lacks_words(); }
  std::int64_t idle_from(std::int64_t clock) override { return std::max(clock, board_.timing().idle_from()); }
  void finish(std::size_t) override {}
  const std::vector<CommandTimes>& done() const override { return done_; }
  Plane plane(unsigned bit) override { return board_.device().engine().bits().memory.at(bit); }

 private:
  std::int64_t tick_ps_;
  CycleBoard board_;
  std::vector<CommandTimes> done_;
};

class ClockedUnit : public CommandUnit {
 public:
  explicit ClockedUnit(const Spec& spec) : renderer_(spec), thieves_(spec) {}

  void begin(std::int64_t clock, const igc::ControllerState& controller, const std::vector<Plane>& memory) override {
    now_ = clock;
    thieves_.resume(clock);
    for (std::uint32_t n = 0; n < igc::kStoreWords; ++n) {
      renderer_.controller().set_half(2 * n, static_cast<std::uint32_t>(controller.store[n]));
      renderer_.controller().set_half(2 * n + 1, static_cast<std::uint32_t>(controller.store[n] >> 32));
    }
    for (unsigned n = 0; n < igc::kRegisters; ++n) renderer_.controller().set_register(n, controller.registers[n]);
    for (unsigned bit = 0; bit < memory.size(); ++bit)
      renderer_.array().planes().set_plane(igc::PixelPlane::kMemory, bit, memory[bit]);
  }
  std::int64_t offer(std::int64_t clock, std::uint32_t word) override {
    go_to(clock);
    while (!renderer_.can_land_in(now_) || !renderer_.has_room()) evaluate();
    before_ = renderer_.fifo_words();
    renderer_.land(word, now_);
    partial_.push_back(word);
    if (partial_.size() == igc::unpack_header(partial_.front()).words()) partial_.clear();
    return now_;
  }
  std::size_t words_before() const override { return before_; }
  void store(std::int64_t clock, std::uint32_t address, std::uint32_t value) override {
    go_to(clock);
    renderer_.store(now_, address, value);
  }
  bool busy(std::int64_t clock) override {
    go_to(clock);
    return !renderer_.idle_now();
  }
  bool lacks_words() const override { return !partial_.empty(); }
  std::int64_t idle_from(std::int64_t clock) override {
    go_to(clock);
    while (!renderer_.idle_now()) evaluate();
    return now_;
  }
  void finish(std::size_t commands) override {
    while (done_.size() < commands) evaluate();
  }
  const std::vector<CommandTimes>& done() const override { return done_; }
  Plane plane(unsigned bit) override { return renderer_.array().planes().plane(igc::PixelPlane::kMemory, bit); }

 private:
  void go_to(std::int64_t clock) {
    while (now_ < clock) {
      if (quiet_ > kSettledClocks) {
        now_ = clock;
        thieves_.resume(clock);
        quiet_ = 0;
      } else {
        evaluate();
      }
    }
  }
  void evaluate() {
    const std::uint64_t taken_before = renderer_.fifo_counters.commands;
    renderer_.begin(now_);
    quiet_ = renderer_.idle_now() ? quiet_ + 1 : 0;
    renderer_.clock(now_, thieves_.steal(now_));
    if (!renderer_.error().empty()) throw UserError(renderer_.error());
    if (renderer_.fifo_counters.commands > taken_before) taken_ = now_;
    if (renderer_.at_work() != nullptr && !std::as_const(renderer_).controller().running()) done_.push_back({taken_, now_ + 1});
    ++now_;
  }

  ClockedRenderer renderer_;
  ClockedThieves thieves_;
  std::vector<std::uint32_t> partial_;  ///< words of a command that is not whole
  std::vector<CommandTimes> done_;
  std::int64_t now_ = 0, taken_ = 0, quiet_ = 0;
  std::size_t before_ = 0;
};

}  // namespace

std::unique_ptr<CommandUnit> make_command_unit(const Spec& spec, Level level) {
  if (level == Level::kClocked) return std::make_unique<ClockedUnit>(spec);
  return std::make_unique<CycleUnit>(spec);
}

}  // namespace dendro::pixel_planes
