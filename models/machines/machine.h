#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/parts/host/host_port.h"
#include "models/parts/service_block/service_block.h"
#include "sim/config/parameters.h"
#include "sim/trace/plain_trace.h"
#include "sim/trace/trace_file.h"
#include "sim/trace/vcd.h"

namespace dendro {

class Debugger;

enum class Level { kFunction, kEstimate, kCycle, kClocked };

const char* level_name(Level level);

/// A stretch of time with one name; consecutive phases add up to the run.
struct Phase {
  std::string name;
  std::int64_t cycles = 0;
  bool on_host = false;
};

/// One unit's counters, in ticks unless the name says otherwise. The first is always `cycles`; `busy`, every
/// `stall_*` and `idle` add up to it.
struct UnitStats {
  std::string unit;  ///< "rds3000.processor"
  std::vector<std::pair<std::string, std::uint64_t>> values;
};

/// What the monitor shows: 8-bit RGB, rows top down.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// A marked word of the microprogram was executed. `phase_NAME` also begins the machine phase NAME.
struct MarkEvent {
  std::string name;
  std::int64_t tick = 0;
};

/// Where the machine's time went in the picture: per pixel of Picture the processor's ticks from an access of that pixel
/// to its next access of image memory, and its accesses. With `elsewhere` the ticks add up to machine_cycles().
struct PixelCosts {
  std::vector<float> ticks, visits;
  std::uint64_t elsewhere = 0;  ///< ticks before a start's first access, and those of pixels that are not shown
};

/// The counters of every unit before a tick of the run: what two samples differ by happened between them.
struct ActivitySample {
  std::int64_t tick = 0;
  std::vector<UnitStats> units;
};

/// How often a word left the pipeline, and the clocks from the word before it.
struct WordClocks {
  std::uint64_t times = 0, clocks = 0;
};

struct MachineOptions {
  /// Words to log, by word index (page x 4096 + address): symbols of the program that begin with mark_ or phase_.
  std::map<std::uint32_t, std::string> marks;
  /// The marks of programs that the host loads on the way, by their name (HostPort::program) and address in the page:
  /// they take the place of those that were in that page.
  std::map<std::string, std::map<std::uint32_t, std::string>> programs;
  std::int64_t tick_limit = 0;  ///< ticks the processor may run in one start before UserError; 0: no limit
  bool all_units = false;       ///< elaborate also the units that this run does not use
  std::string vcd_file;         ///< clocked only; empty: none
  std::int64_t vcd_from = 0, vcd_to = INT64_MAX;  ///< window in ticks
  std::vector<std::string> vcd_units;             ///< empty: all
  std::string pipeline_file;    ///< `clocked` of a machine with a pipeline: Kanata log; empty: none
  std::int64_t pipeline_from = 0, pipeline_to = INT64_MAX;  ///< window in clocks
  std::map<std::uint32_t, std::string> symbols;   ///< labels by word index, for messages only
  bool cost = false;                              ///< cycle only: keep account of ticks by pixel
  std::size_t activity = 0;                       ///< most samples of activity(), an even number; 0: none are taken
  std::map<std::uint32_t, std::string> counted;   ///< `function` only: microwords whose executions are counted
  std::function<void(std::int64_t tick)> progress;  ///< called now and then with the simulated time; may be empty
  Debugger* debugger = nullptr;  ///< all levels but `clocked` of a machine with `exec`
  std::map<std::uint32_t, WordClocks>* word_clocks = nullptr;  ///< `cycle` of a machine with `exec`: by address
  trace::Writer* recorder = nullptr;  ///< `cycle` only: gathers the records of one boundary

  /// A machine with one page of control store: the marks of this program from word `first` on take the place of all others.
  void program_loaded(std::string_view name, std::uint32_t first) {
    marks.clear();
    if (const auto known = programs.find(std::string(name)); known != programs.end())
      for (const auto& [at, mark] : known->second) marks[first + at] = mark;
  }
};

/// The window of the options' waveform in picoseconds, for a machine whose tick takes `tick_ps`.
trace::VcdWindow vcd_window(const MachineOptions& options, std::int64_t tick_ps);

/// One machine at one level of fidelity, for one run.
class Machine {
 public:
  virtual ~Machine() = default;

  /// Runs the host program to its end and the machine with it. Once. Throws UserError from the host program or the
  /// tick limit. At `cycle` and `clocked` this elaborates SystemC: one machine per process.
  virtual void run(const std::function<void(HostPort&)>& host_program) = 0;

  virtual double clock_hz() const = 0;
  virtual std::int64_t cycles() const = 0;           ///< whole run, main clock; 0 at `function`
  virtual std::int64_t machine_cycles() const = 0;   ///< of these, with the processor running, stalls included
  virtual std::uint64_t instructions() const = 0;    ///< microinstructions executed
  virtual std::vector<Phase> phases() const = 0;
  virtual std::vector<UnitStats> units() const = 0;
  virtual std::vector<MarkEvent> marks() const = 0;
  /// Executions of the microwords of `MachineOptions::counted`, by name; empty at levels that do not count them.
  virtual std::vector<std::pair<std::string, std::uint64_t>> executions() const { return {}; }
  virtual std::vector<std::string> elaborated() const = 0;
  virtual bool time_dependent() const = 0;           ///< the program read time, so `function` may differ
  virtual Picture picture() const = 0;               ///< after the last tick
  /// With `MachineOptions::cost`, after the run; empty otherwise.
  virtual PixelCosts costs() const { return {}; }
  /// With `MachineOptions::activity`, after the run: samples at equal distances and one at its end; empty otherwise.
  virtual std::vector<ActivitySample> activity() const { return {}; }
  /// A word of the machine as a debugger would see it: no time passes.
  virtual std::uint32_t peek(std::uint32_t address, unsigned function) const = 0;
};

/// A program in memory, as a loader leaves it; the monitor, if the machine has one, among its chunks.
struct ProgramImage {
  struct Chunk {
    std::uint32_t physical = 0;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Chunk> chunks;
  std::uint32_t start = 0;  ///< first word executed
  service_block::Program program;
};

/// A call of the program that marks a point of its run (service_block_isa.h): `instructions` before the mark's store,
/// `cycles` before the clock in which it reaches the service block.
struct ProgramMark {
  std::uint32_t number = 0, label = 0;  ///< of the call (0x7000 up) and its argument
  std::uint64_t instructions = 0;
  std::int64_t cycles = 0;
};

struct ProgramResult {
  bool stopped = false;  ///< by a service; otherwise the limit was reached
  std::uint32_t pc = 0, return_address = 0, stack_pointer = 0;
  std::vector<std::uint8_t> stack;  ///< from the stack pointer on, at most so much as shows the callers
  std::uint64_t instructions = 0;
  std::int64_t cycles = 0;  ///< 0 at `function`
  double clock_hz = 0;
  std::vector<ProgramMark> marks;  ///< in the order of their calls; empty at `function`
  std::vector<UnitStats> units;
};

/// What a memory trace from elsewhere did.
struct PlainReplay {
  std::int64_t accesses = 0;
  std::int64_t cycles = 0;  ///< to the clock in which the last access went on
  std::vector<UnitStats> units;
  std::vector<std::string> summary;  ///< the same for people
};

/// One entry of the list of machines.
struct MachineType {
  std::string name;      ///< "rds3000"
  std::string summary;   ///< one line
  std::vector<std::string> presets;  ///< the first is the default
  std::vector<Level> levels;
  std::string folder;    ///< where its presets are embedded: "models/machines/rds3000"
  /// Checks the parameters (throws UserError) and builds the machine.
  std::function<std::unique_ptr<Machine>(const config::ParameterSet&, Level, const MachineOptions&)> make;
  /// Throws the UserError that make() would, and builds nothing. Empty: what make() refuses does not depend on the level.
  std::function<void(const config::ParameterSet&, Level)> check;
  /// A machine whose programs are ELF files: runs one without a host program, at most `limit` words, with waveform,
  /// pipeline log and progress as the options say. At `clocked` this elaborates SystemC. Empty elsewhere.
  std::function<ProgramResult(const config::ParameterSet&, Level, const ProgramImage&, service_block::Services&,
                              std::uint64_t limit, const MachineOptions&)> exec;
  std::vector<trace::Boundary> boundaries;  ///< where its units can be recorded and replayed
  /// Drives one unit alone with a trace, whose boundary is among those above. Levels are cycle and clocked. Throws
  /// UserError for a trace that is wrong in itself. May elaborate SystemC.
  std::function<trace::ReplayResult(const config::ParameterSet&, Level, trace::Reader&)> replay;
  /// The boundary that takes memory traces from elsewhere, and what drives it with one; empty: there is none.
  std::string plain_boundary;
  std::function<PlainReplay(const config::ParameterSet&, Level, trace::PlainReader&)> replay_plain;
};

}  // namespace dendro
