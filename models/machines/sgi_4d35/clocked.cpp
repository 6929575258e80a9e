#include "models/machines/sgi_4d35/clocked.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <systemc>
#include <utility>

#include "models/machines/sgi_4d35/clocked_log.h"
#include "models/machines/sgi_4d35/clocked_pipeline.h"
#include "models/machines/sgi_4d35/clocked_vcd.h"
#include "models/machines/sgi_4d35/debug.h"
#include "models/machines/sgi_4d35/marks.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint64_t kProgressClocks = std::uint64_t{1} << 20;

/// SystemC elaborates once per process: the engine stays, and drives one pipeline after the other.
class ClockedEngine : public sc_core::sc_module {
 public:
  static ClockedEngine& of_process() {
    static const bool picoseconds = (sc_core::sc_set_time_resolution(1, sc_core::SC_PS), true);
    static ClockedEngine engine("sgi_4d35", picoseconds);
    return engine;
  }

  void begin(ClockedPipeline& pipeline, MarkedServices& services, double clock_hz, const MachineOptions& options) {
    pipeline_ = &pipeline;
    services_ = &services;
    options_ = &options;
    period_ = sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(clock_ps(clock_hz, 1)));
    marks_.clear();
    if (!options.vcd_file.empty()) vcd_ = std::make_unique<ClockedVcd>(pipeline, options, clock_hz);
    if (!options.pipeline_file.empty()) log_ = std::make_unique<ClockedLog>(pipeline, options);
  }

  /// Until the pipeline has had so many words in all, or stops. Throws what a service, the waveform or the log throws.
  void advance(std::uint64_t words) {
    if (pipeline_->stopped() || pipeline_->words() >= words) return;
    words_ = words;
    go_on_.notify(sc_core::SC_ZERO_TIME);
    sc_core::sc_start();
    if (!given_up_) return;
    end();
    std::rethrow_exception(std::exchange(given_up_, nullptr));
  }

  /// Closes the files; returns the marks.
  std::vector<ProgramMark> end() {
    if (vcd_) vcd_->close();
    if (log_) log_->close();
    vcd_.reset();
    log_.reset();
    return std::move(marks_);
  }

 private:
  ClockedEngine(sc_core::sc_module_name name, bool) : sc_module(name) {
    SC_HAS_PROCESS(ClockedEngine);
    SC_METHOD(on_clock);
    sensitive << go_on_;
    dont_initialize();
  }

  /// The simulation ends when no clock follows; SystemC would make another error of what is thrown.
  void on_clock() {
    try {
      clock();
      if (!pipeline_->stopped() && pipeline_->words() < words_) next_trigger(period_);
    } catch (...) {
      given_up_ = std::current_exception();
    }
  }

  void clock() {
    const std::uint64_t n = pipeline_->clock(), words = pipeline_->state().instructions;
    pipeline_->look();
    if (auto mark = services_->take()) {
      mark->instructions = words;
      mark->cycles = static_cast<std::int64_t>(n);
      marks_.push_back(*mark);
    }
    if (vcd_ && vcd_->wants(n)) vcd_->during(n);
    if (log_) log_->during(n);
    pipeline_->move();
    if (vcd_ && vcd_->wants(n)) vcd_->after();
    if (n % kProgressClocks == 0 && options_->progress) options_->progress(static_cast<std::int64_t>(n));
  }

  sc_core::sc_event go_on_;
  std::uint64_t words_ = 0;
  sc_core::sc_time period_;
  ClockedPipeline* pipeline_ = nullptr;
  MarkedServices* services_ = nullptr;
  const MachineOptions* options_ = nullptr;
  std::vector<ProgramMark> marks_;
  std::unique_ptr<ClockedVcd> vcd_;
  std::unique_ptr<ClockedLog> log_;
  std::exception_ptr given_up_;
};

/// Lets a debugger, if there is one, look on. False: it gives the program up.
bool drive(Debugger* debugger, ClockedEngine& engine, ClockedPipeline& pipeline, Board& board, std::uint64_t limit) {
  if (debugger == nullptr) return true;
  r3000::State state = pipeline.state();
  pipeline.show(&state);
  const auto run = [&](std::uint64_t words) {
    const std::uint64_t before = pipeline.words();
    engine.advance(before + words);
    return words - std::min(words, pipeline.words() - before);
  };
  const bool goes_on = debugged(debugger, {state, run, nullptr, nullptr}, board, limit) != 0;
  pipeline.show(nullptr);
  return goes_on;
}

}  // namespace

ProgramResult run_clocked(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                          std::uint64_t limit, const RunOptions& options) {
  MarkedServices marked(services);
  Board board(spec.main_bytes, image, marked);
  ClockedPipeline pipeline(spec, board, image.start, limit);
  pipeline.keep(options.retired);
  ClockedEngine& engine = ClockedEngine::of_process();
  engine.begin(pipeline, marked, spec.clock_hz, options.machine);
  if (drive(options.machine.debugger, engine, pipeline, board, limit)) engine.advance(UINT64_MAX);
  std::vector<ProgramMark> marks = engine.end();
  const r3000::State& state = pipeline.state();
  if (options.final_state != nullptr) *options.final_state = state;
  ProgramResult result = result_of(state, board, spec);
  result.cycles = static_cast<std::int64_t>(pipeline.clock());
  result.marks = std::move(marks);
  result.units = units_of(pipeline.counters(), counters_of(state));
  return result;
}

}  // namespace dendro::sgi_4d35
