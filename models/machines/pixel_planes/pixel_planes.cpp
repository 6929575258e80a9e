#include "models/machines/pixel_planes/pixel_planes.h"

#include <algorithm>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/cycle.h"
#include "models/machines/pixel_planes/device.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {
namespace {

/// Plain calls; counts the words that programs send.
class FunctionPort : public HostPort {
 public:
  explicit FunctionPort(Device& device) : device_(device) {}

  std::uint32_t read(std::uint32_t address, unsigned) override { return device_.read(address); }
  void write(std::uint32_t address, std::uint32_t value, unsigned) override {
    if (const auto done = device_.write(address, value)) words_ += done->words;
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) write(address + static_cast<std::uint32_t>(i) * step, words[i], function);
  }
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned, std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) words[i] = device_.read(address + static_cast<std::uint32_t>(i) * step);
  }
  void command(std::uint32_t) override {}
  void wait_interrupt() override {
    if (device_.lacks_words()) throw Device::never_idle();
  }
  void compute(const Work&) override {}
  void phase(std::string_view) override {}
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return device_.peek(address, function); }
  void program(std::string_view, std::uint32_t) override {}

  std::uint64_t words() const { return words_; }

 private:
  Device& device_;
  std::uint64_t words_ = 0;
};

class FunctionMachine : public Machine {
 public:
  explicit FunctionMachine(const Spec& spec) : spec_(spec), device_(spec, true), port_(device_) {}

  void run(const std::function<void(HostPort&)>& host_program) override {
    host_program(port_);
    if (device_.lacks_words()) throw Device::never_idle();
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
  Picture picture() const override { return device_.picture(); }
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return device_.peek(address, function); }

 private:
  Spec spec_;
  mutable Device device_;  // reading brings waiting tiles up to date
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
