#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "models/parts/host/host_port.h"

namespace dendro::study {

/// One line on a terminal that says how far long work is; silent into a pipe.
class Progress {
 public:
  /// `mode` is auto, on or off.
  explicit Progress(const std::string& mode);

  bool enabled() const { return enabled_; }
  /// The clock of the run that is shown from here on.
  void start_run(const std::string& name, double clock_hz);
  void phase(const std::string& name) { phase_ = name; }
  /// The host waits: the machine's own phases are shown until the host begins one.
  void machine_runs() { phase_ = kMachine; }
  /// `machine_phase` is asked only when the line is due; what it answers stands for the phase while the host
  /// waits for its machine, unless it is empty.
  void tick(std::int64_t tick, const std::function<std::string()>& machine_phase = {});
  /// `done` of `total` runs are finished.
  void runs(const std::string& name, std::size_t done, std::size_t total);
  /// Removes the line.
  void clear();

 private:
  static constexpr const char* kMachine = "machine";

  bool due();
  void show(const std::string& text);

  bool enabled_ = false;
  std::string name_, phase_;
  double clock_hz_ = 0;
  std::chrono::steady_clock::time_point started_, shown_, runs_started_;
};

/// A host port that tells a progress line the phase; everything else goes through.
class ReportingPort : public HostPort {
 public:
  ReportingPort(HostPort& port, Progress* progress) : port_(port), progress_(progress) {}

  std::uint32_t read(std::uint32_t address, unsigned function) override {
    return port_.read(address, function);
  }
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override {
    port_.write(address, value, function);
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    port_.dma_to(address, words, count, function, step);
  }
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                std::uint32_t step) override {
    port_.dma_from(address, words, count, function, step);
  }
  void command(std::uint32_t bits) override { port_.command(bits); }
  void wait_interrupt() override;
  void compute(const Work& work) override { port_.compute(work); }
  void phase(std::string_view name) override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override {
    return port_.peek(address, function);
  }
  void program(std::string_view name, std::uint32_t first) override { port_.program(name, first); }

 private:
  HostPort& port_;
  Progress* progress_;
};

}  // namespace dendro::study
