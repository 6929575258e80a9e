#include <algorithm>
#include <deque>

#include "models/machines/pixel_planes/clocked_array_side.h"
#include "models/machines/pixel_planes/clocked_front.h"
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
  explicit ClockedUnit(const Spec& spec)
      : spec_(spec), translator_(spec.setup_clocks), controller_(spec.tree.gap_clocks, spec.copy_words()), array_(spec), thieves_(spec) {}

  void begin(std::int64_t clock, const igc::ControllerState& controller, const std::vector<Plane>& memory) override {
    now_ = clock;
    thieves_.resume(clock);
    for (std::uint32_t n = 0; n < igc::kStoreWords; ++n) {
      controller_.set_half(2 * n, static_cast<std::uint32_t>(controller.store[n]));
      controller_.set_half(2 * n + 1, static_cast<std::uint32_t>(controller.store[n] >> 32));
    }
    for (unsigned n = 0; n < igc::kRegisters; ++n) controller_.set_register(n, controller.registers[n]);
    for (unsigned bit = 0; bit < memory.size(); ++bit)
      array_.planes().set_plane(igc::PixelPlane::kMemory, bit, memory[bit]);
  }
  std::int64_t offer(std::int64_t clock, std::uint32_t word) override {
    go_to(clock);
    while (landed_ == now_ || fifo_.size() >= static_cast<std::size_t>(spec_.fifo_words)) evaluate();
    before_ = fifo_.size();
    fifo_.land(word, now_);
    landed_ = now_;
    partial_.push_back(word);
    if (partial_.size() == igc::unpack_header(partial_.front()).words()) partial_.clear();
    return now_;
  }
  std::size_t words_before() const override { return before_; }
  void store(std::int64_t clock, std::uint32_t address, std::uint32_t value) override {
    go_to(clock);
    writes_.push_back({now_, address, value});
  }
  bool busy(std::int64_t clock) override {
    go_to(clock);
    return !idle();
  }
  bool lacks_words() const override { return !partial_.empty(); }
  std::int64_t idle_from(std::int64_t clock) override {
    go_to(clock);
    while (!idle()) evaluate();
    return now_;
  }
  void finish(std::size_t commands) override {
    while (done_.size() < commands) evaluate();
  }
  const std::vector<CommandTimes>& done() const override { return done_; }
  Plane plane(unsigned bit) override { return array_.planes().plane(igc::PixelPlane::kMemory, bit); }

 private:
  struct Write {
    std::int64_t clock = 0;
    std::uint32_t index = 0, value = 0;
  };

  bool idle() const {
    return fifo_.empty() && translator_.idle() && !controller_.running() && array_.words_on_their_way() == 0;
  }
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
    for (; !writes_.empty() && writes_.front().clock < now_; writes_.pop_front())
      controller_.set_half(writes_.front().index, writes_.front().value);
    const bool stolen = thieves_.steal(now_) != ClockedCause::kBusy;
    quiet_ = idle() && writes_.empty() ? quiet_ + 1 : 0;
    const bool ready = translator_.ready();
    translator_.clock(now_, fifo_);
    if (!stolen) send(ready);
    ++now_;
  }
  void send(bool ready) {
    if (!controller_.running() && ready) take();
    if (!controller_.running()) {
      controller_.pause();
      array_.clock(nullptr);
      return;
    }
    const ClockedController::Sent sent = controller_.send();
    const igc::Command& command = controller_.command();
    if (sent.starts_stream) array_.start(command.a, command.b, command.c);
    array_.clock(&sent.word);
    if (!controller_.running()) done_.push_back({taken_, now_ + 1});
  }
  void take() {
    const igc::Header header = translator_.command().header;
    const auto refuse = [&](const char* what) {
      throw UserError("the micro-program at word " + std::to_string(header.entry) + what);
    };
    if (!header.register_write && !header.copy && !controller_.has_end(header.entry)) refuse(" of the control store has no end");
    if (!controller_.take(translator_.command())) refuse(" sends nothing");
    translator_.taken();
    taken_ = now_;
  }

  Spec spec_;
  ClockedFifo fifo_;
  ClockedTranslator translator_;
  ClockedController controller_;
  ClockedArraySide array_;
  ClockedThieves thieves_;
  std::deque<Write> writes_;
  std::vector<std::uint32_t> partial_;  ///< words of a command that is not whole
  std::vector<CommandTimes> done_;
  std::int64_t now_ = 0, landed_ = -1, taken_ = 0, quiet_ = 0;
  std::size_t before_ = 0;
};

}  // namespace

std::unique_ptr<CommandUnit> make_command_unit(const Spec& spec, Level level) {
  if (level == Level::kClocked) return std::make_unique<ClockedUnit>(spec);
  return std::make_unique<CycleUnit>(spec);
}

}  // namespace dendro::pixel_planes
