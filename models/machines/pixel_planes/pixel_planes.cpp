#include "models/machines/pixel_planes/pixel_planes.h"

#include <algorithm>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/cycle.h"
#include "models/machines/pixel_planes/renderers.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {
namespace {

/// Plain calls; counts the words that programs send.
class FunctionPort : public HostPort {
 public:
  explicit FunctionPort(const Spec& spec) : group_(spec, [this](std::size_t r) -> Device& { return devices_[r]; }) {
    for (std::size_t r = 0; r < group_.count(); ++r) devices_.emplace_back(spec, true);
  }

  std::uint32_t read(std::uint32_t address, unsigned) override { return group_.read(address); }
  void write(std::uint32_t address, std::uint32_t value, unsigned) override {
    if (group_.write(address, value)) return;
    const Selection& to = group_.selection();
    for (std::size_t r = to.first(group_.count()); r < to.end(group_.count()); ++r)
      if (const auto done = devices_[r].write(address, value)) {
        words_ += done->words;
        group_.done(r, done->command, ++commands_);
      }
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) write(address + static_cast<std::uint32_t>(i) * step, words[i], function);
  }
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned, std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) words[i] = group_.read(address + static_cast<std::uint32_t>(i) * step);
  }
  void command(std::uint32_t) override {}
  void wait_interrupt() override {
    for (const Device& device : devices_)
      if (device.lacks_words()) throw Device::never_idle();
  }
  void compute(const Work&) override {}
  void phase(std::string_view) override {}
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return group_.peek(address, function); }
  void program(std::string_view, std::uint32_t) override {}

  std::uint64_t words() const { return words_; }
  Picture picture() const { return group_.picture(); }

 private:
  std::deque<Device> devices_;  // they change when something is read: waiting tiles are brought up to date
  RendererGroup group_;
  std::int64_t commands_ = 0;
  std::uint64_t words_ = 0;
};

class FunctionMachine : public Machine {
 public:
  explicit FunctionMachine(const Spec& spec) : spec_(spec), port_(spec) {}

  void run(const std::function<void(HostPort&)>& host_program) override {
    host_program(port_);
    port_.wait_interrupt();
  }
  double clock_hz() const override { return 1e12 / static_cast<double>(spec_.tick_ps); }
  std::int64_t cycles() const override { return 0; }
  std::int64_t machine_cycles() const override { return 0; }
  std::uint64_t instructions() const override { return port_.words(); }
  std::vector<Phase> phases() const override { return {}; }
  std::vector<UnitStats> units() const override { return {}; }
  std::vector<MarkEvent> marks() const override { return {}; }
  std::vector<std::string> elaborated() const override { return {"pixel_planes.array"}; }
  bool time_dependent() const override { return false; }
  Picture picture() const override { return port_.picture(); }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return port_.peek(address, function); }

 private:
  Spec spec_;
  FunctionPort port_;
};

/// Word arithmetic has no streams that run into each other: only `clocked` takes any gap.
void check(const config::ParameterSet& parameters, Level level) {
  const Spec spec = resolve(parameters);
  if (level == Level::kClocked || spec.tree.masked || spec.tree.gap_clocks >= spec.least_gap()) return;
  const config::Parameter* gap = parameters.find("tree.gap_clocks");
  throw UserError(gap->where.file, gap->where.line, "tree.gap_clocks",
                  "without masks an expression runs into the next unless " + std::to_string(spec.least_gap()) +
                      " clocks or more lie between: this shows at level clocked only");
}

std::unique_ptr<Machine> make(const config::ParameterSet& parameters, Level level, const MachineOptions& options) {
  check(parameters, level);
  const Spec spec = resolve(parameters);
  if (options.cost)
    throw UserError("--cost", 0, "", "in a pixel array every clock is every pixel's: there is no cost by pixel");
  if (options.recorder && spec.frame.exists())
    throw UserError("--boundary", 0, "", "records are made of a machine that shows its one array, without a frame buffer");
  if (level == Level::kFunction) return std::make_unique<FunctionMachine>(spec);
  if (level == Level::kClocked) return make_clocked(spec, options);
  return std::make_unique<CycleMachine>(spec, options);
}

}  // namespace

MachineType pixel_planes_type() {
  MachineType type;
  type.name = "pixel-planes";
  type.summary = "Pixel-Planes: 512x512 one-bit processors that evaluate Ax + By + C (FG86's proposal)";
  type.presets = {"pxpl4", "pxpl4-8mhz", "pxpl5"};
  type.levels = {Level::kFunction, Level::kCycle, Level::kClocked};
  type.folder = "models/machines/pixel_planes";
  type.make = make;
  type.check = check;
  type.boundaries = boundaries();
  type.replay = [](const config::ParameterSet& parameters, Level level, trace::Reader& trace) {
    return replay(resolve(parameters), level, trace);
  };
  return type;
}

}  // namespace dendro::pixel_planes
