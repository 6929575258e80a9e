#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <systemc>

#include "models/machines/rds3000/clocked_cards.h"
#include "models/machines/rds3000/clocked_display.h"
#include "models/machines/rds3000/clocked_processor.h"
#include "models/machines/rds3000/clocked_vcd.h"
#include "models/machines/rds3000/engine.h"
#include "models/machines/rds3000/rds3000_map.h"

namespace dendro::rds3000 {

/// Level `clocked`: every tick is a SystemC event in which all units move on by one, and can be watched in a
/// waveform. It is written from the data sheets alone, as the referee of `cycle`. SystemC's time resolution
/// must be 1 ps before it is made.
///
/// Tick n is worked out 1 ps before time (n + 1) x tick_ps, when all that the host did up to the tick's edge
/// is known; requests carry the tick they belong to, so what the host does between the edge and then waits
/// for the next tick.
class ClockedEngine : public sc_core::sc_module, public Engine {
 public:
  /// Throws UserError for a waveform file that cannot be written and for parameters this level cannot count.
  ClockedEngine(sc_core::sc_module_name name, const Spec& spec, const MachineOptions& options);
  ~ClockedEngine() override;

  std::uint32_t transfer(bool write, std::uint32_t address, std::uint32_t data, unsigned function) override;
  void command(bool run, bool reset) override;
  sc_core::sc_event& interrupt_event() override { return interrupt_event_; }
  bool interrupt() const override;
  void clear_interrupt() override;
  bool running() const override;
  void finish(std::int64_t end) override;

  const ProcessorState& processor() const override { return processor_.state(); }
  const ProcessorCounters& processor_counters() const override { return processor_counters_; }
  const BusCounters& bus_counters() const override { return bus_counters_; }
  const MemoryCounters& memory_counters() const override { return memory_counters_; }
  const dr64::Core& memory() const override { return memory_; }
  const video::State& video() const override { return video_; }

 private:
  friend class ClockedVcd;

  enum class Phase : std::uint8_t { kNone, kAsking, kOnBus, kGranted };
  enum class Owner : std::uint8_t { Nobody, Processor, Host };

  /// One access, of either master, from its request to its completion.
  struct Access {
    Phase phase = Phase::kNone;
    bool write = false, masked = false;
    Device device = Device::None;
    std::uint32_t address = 0, data = 0, cards = 0;
    unsigned function = 0;
    std::int64_t asks_at = 0, got_at = 0, complete_at = 0;
    std::uint32_t answer = 0;

    bool in_flight() const { return phase != Phase::kNone; }
  };

  struct Command {
    std::int64_t tick = 0;
    bool run = false, reset = false;
  };

  // clocked.cpp
  void on_edge();
  void evaluate(std::int64_t n);
  void count(ClockedCause cause);
  void after_word(std::int64_t n);
  void watch_for_loop(std::int64_t n, bool executed);
  void give_up(std::int64_t n);
  void obey_commands(std::int64_t n);
  void stop_running(std::int64_t end);
  void raise_interrupt(std::int64_t n);
  std::int64_t edge_at_or_after_now() const;

  // clocked_bus.cpp
  void periodic_events(std::int64_t n);
  void complete_accesses(std::int64_t n);
  void start_access(Access& access, std::int64_t asks_at, bool write, std::uint32_t address,
                    std::uint32_t data, unsigned function);
  void arbitrate(std::int64_t n);
  void grant(Access& access, std::int64_t n);
  void take_cards(const Access& access, std::int64_t n);
  std::uint32_t read_device(const Access& access, bool from_host) const;
  void write_device(const Access& access, bool from_host, std::int64_t n);
  void restart_display(std::int64_t n);

  Spec spec_;
  MachineOptions options_;
  std::int64_t tick_ps_;

  ClockedProcessor processor_;
  dr64::Core memory_;
  video::State video_;
  ClockedDisplay display_;
  ClockedCards cards_;
  std::int64_t next_refresh_ps_;

  Access own_, host_;  ///< the processor's access and the host's
  Owner owner_ = Owner::Nobody;
  bool owner_waits_ = false;      ///< for its device
  std::int64_t released_at_ = 0;  ///< tick from which the bus is free again
  std::int64_t granted_at_ = -1;

  std::deque<Command> commands_;
  sc_core::sc_event host_done_, interrupt_event_;
  bool interrupt_up_ = false;         ///< an interrupt was up already when the last one was raised
  std::int64_t interrupt_tick_ = -1;  ///< the tick at which the last one rises; -1: it has been cleared

  ProcessorCounters processor_counters_;
  BusCounters bus_counters_;
  MemoryCounters memory_counters_;

  std::int64_t next_tick_ = 0;
  std::int64_t ran_ticks_ = 0;    ///< in this start
  std::int64_t limit_words_ = 0;  ///< words watched since the limit was passed
  std::int64_t limit_ticks_ = 0;
  std::uint32_t loop_low_ = 0, loop_high_ = 0;
  bool finished_ = false;
  std::unique_ptr<ClockedVcd> vcd_;
};

}  // namespace dendro::rds3000
