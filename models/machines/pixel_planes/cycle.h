#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/cycle_board.h"
#include "models/machines/pixel_planes/recorder.h"
#include "models/machines/pixel_planes/renderers.h"

namespace dendro::pixel_planes {

/// Level `cycle`. One host writes to one queue, so the order of things is the host's program: its time and the machine's
/// clocks follow from each other without events, and there is no SystemC.
class CycleMachine : public Machine, private HostPort {
 public:
  CycleMachine(const Spec& spec, const MachineOptions& options);

  void run(const std::function<void(HostPort&)>& host_program) override;
  double clock_hz() const override { return 1e12 / static_cast<double>(spec_.tick_ps); }
  std::int64_t cycles() const override { return end_; }
  std::int64_t machine_cycles() const override;
  std::uint64_t instructions() const override;
  std::vector<Phase> phases() const override;
  std::vector<UnitStats> units() const override;
  std::vector<MarkEvent> marks() const override { return {}; }
  std::vector<std::string> elaborated() const override;
  bool time_dependent() const override { return time_read_; }
  Picture picture() const override;
  std::uint32_t peek(std::uint32_t address, unsigned function) const override { return group_.peek(address, function); }

 private:
  /// A named stretch of the host's program, or of the controller's.
  struct Stretch {
    std::string name;
    std::int64_t from = 0, to = 0;  ///< clocks; a host's stretch ends where the next begins
  };

  std::uint32_t read(std::uint32_t address, unsigned function) override;
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override;
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override;
  void dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                std::uint32_t step) override;
  void command(std::uint32_t) override {}
  void wait_interrupt() override;
  void compute(const Work& work) override;
  void phase(std::string_view name) override;
  void program(std::string_view name, std::uint32_t first) override { options_.program_loaded(name, first); }

  std::int64_t clock_at(std::int64_t ps) const { return (ps + spec_.tick_ps - 1) / spec_.tick_ps; }
  void spend(std::int64_t ps) { now_ps_ += ps, busy_ps_ += ps; }
  std::string phase_of(const igc::Header& header) const;
  void offer(std::size_t renderer, std::uint32_t word);
  void book(std::size_t renderer, const std::string& name, const CommandTimes& times);
  std::vector<Stretch> machine_stretches() const;
  std::int64_t idle_from() const;
  bool lacks_words() const;

  Spec spec_;
  MachineOptions options_;
  mutable std::deque<CycleBoard> boards_;  // one a renderer; reading brings waiting tiles up to date
  RendererGroup group_;
  mutable std::optional<Picture> shown_;  ///< made once: it takes as long as a run of the lazy array
  std::unique_ptr<Recorder> recorder_;
  std::int64_t now_ps_ = 0, busy_ps_ = 0;
  std::vector<Stretch> host_;
  std::vector<std::vector<Stretch>> machine_;  ///< by renderer
  std::int64_t end_ = 0;
  bool time_read_ = false;
};

}  // namespace dendro::pixel_planes
