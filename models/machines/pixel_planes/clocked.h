#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/clocked_renderer.h"
#include "models/machines/pixel_planes/clocked_vcd.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"

namespace dendro::pixel_planes {

/// Level `clocked`: every clock is a SystemC event in which FIFO, translator, controller, tree and array move
/// on by one. Written from the data sheets alone, as the referee of `cycle`. SystemC's time resolution must
/// be 1 ps before it is made.
///
/// Clock n is worked out 1 ps before it ends, from the state at its beginning; what the host does carries its
/// clock, so it does not matter which of the two comes first in that picosecond.
class ClockedEngine : public sc_core::sc_module, public HostPort {
 public:
  /// A named stretch of the host's program, from the first clock on that begins at or behind its call.
  struct HostPhase {
    std::string name;
    std::int64_t from = 0;
  };
  /// Clocks [from, to) in which commands of one phase ran.
  struct Stretch {
    std::string name;
    std::int64_t from = 0, to = 0;
  };

  /// Throws UserError for a waveform file that cannot be written.
  ClockedEngine(sc_core::sc_module_name name, const Spec& spec, const MachineOptions& options);
  ~ClockedEngine() override;

  /// Simulates the host program and the machine until both have ended. Once. Throws what the program throws.
  void simulate(const std::function<void(HostPort&)>& program);

  // The host program's calls.
  std::uint32_t read(std::uint32_t address, unsigned function) override;
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override;
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override;
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                std::uint32_t step) override;
  void command(std::uint32_t bits) override;
  void wait_interrupt() override;
  void compute(const Work& work) override;
  void phase(std::string_view name) override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override;
  void program(std::string_view name, std::uint32_t first) override { options_.program_loaded(name, first); }

  std::int64_t clocks() const { return next_clock_; }
  std::int64_t host_busy_ps() const { return host_busy_ps_; }
  const std::deque<ClockedRenderer>& renderers() const { return renderers_; }
  const ControllerCounters& controller_counters() const { return renderers_.front().counters; }
  const FifoCounters& fifo_counters() const { return renderers_.front().fifo_counters; }
  const std::vector<HostPhase>& host_phases() const { return phases_; }
  const std::vector<Stretch>& machine_phases() const { return stretches_; }
  bool time_read() const { return time_read_; }  ///< the host has read the status
  const VideoState& video() const { return video_; }
  igc::ClockedPlanes& planes() { return renderers_.front().array().planes(); }
  std::uint32_t frame_word(std::uint32_t pixel, unsigned low) const { return frame_.peek(pixel, low); }

 private:
  friend class ClockedVcd;

  // clocked.cpp
  void on_clock();
  void evaluate(std::int64_t n);
  void book(std::int64_t n);
  void watch_limit();
  /// Ends the run with a UserError.
  void fail(const std::string& message);
  void after_clock();
  bool idle_now() const;  ///< at the beginning of clock next_clock_, if the host offers nothing more before
  bool cannot_become_idle() const;

  // clocked_host.cpp
  void host_thread();
  void own_time(std::int64_t ps);
  void wait_ps(std::int64_t ps);
  std::int64_t clock_now() const;
  bool idle_at(std::int64_t clock) const;
  void offer(ClockedRenderer& renderer, std::uint32_t word);
  void store(std::uint32_t address, std::uint32_t value);
  std::uint32_t load(std::uint32_t address);

  Spec spec_;
  MachineOptions options_;
  std::int64_t tick_ps_;

  mutable std::deque<ClockedRenderer> renderers_;  // reading works out clocks that wait
  Selection selection_;
  ClockedFrame frame_;
  ClockedThieves thieves_;
  VideoState video_;

  std::int64_t next_clock_ = 0;

  std::function<void(HostPort&)> program_;
  bool host_ended_ = false, host_waits_for_idle_ = false;
  const ClockedRenderer* host_waits_for_room_ = nullptr;
  std::int64_t host_end_ps_ = 0, host_busy_ps_ = 0;
  sc_core::sc_event idle_event_, room_event_;
  bool stopped_ = false, time_read_ = false;
  std::exception_ptr error_;

  std::vector<HostPhase> phases_;
  std::vector<Stretch> stretches_;
  std::unique_ptr<ClockedVcd> vcd_;
};

/// The machine at level `clocked`. One per process.
std::unique_ptr<Machine> make_clocked(const Spec& spec, const MachineOptions& options);

}  // namespace dendro::pixel_planes
