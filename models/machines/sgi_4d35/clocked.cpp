#include "models/machines/sgi_4d35/clocked.h"

#include <cmath>
#include <exception>
#include <memory>
#include <systemc>

#include "models/machines/sgi_4d35/clocked_log.h"
#include "models/machines/sgi_4d35/clocked_pipeline.h"
#include "models/machines/sgi_4d35/clocked_vcd.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint64_t kProgressClocks = std::uint64_t{1} << 20;

class ClockedEngine : public sc_core::sc_module {
 public:
  ClockedEngine(sc_core::sc_module_name name, ClockedPipeline& pipeline, double clock_hz,
                const MachineOptions& options)
      : sc_module(name),
        pipeline_(pipeline),
        options_(options),
        period_(sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(clock_ps(clock_hz, 1)))) {
    if (!options.vcd_file.empty()) vcd_ = std::make_unique<ClockedVcd>(pipeline, options, clock_hz);
    if (!options.pipeline_file.empty()) log_ = std::make_unique<ClockedLog>(pipeline, options);
    SC_HAS_PROCESS(ClockedEngine);
    SC_METHOD(on_clock);
  }

  /// What ended the run before the program did: SystemC would make another error of it.
  void rethrow() const {
    if (given_up_) std::rethrow_exception(given_up_);
  }

  void close() {
    if (vcd_) vcd_->close();
    if (log_) log_->close();
  }

 private:
  void on_clock() {
    try {
      clock();
    } catch (...) {
      given_up_ = std::current_exception();
    }
    if (pipeline_.stopped() || given_up_)
      sc_core::sc_stop();
    else
      next_trigger(period_);
  }

  void clock() {
    const std::uint64_t n = pipeline_.clock();
    pipeline_.look();
    if (vcd_ && vcd_->wants(n)) vcd_->during(n);
    if (log_) log_->during(n);
    pipeline_.move();
    if (vcd_ && vcd_->wants(n)) vcd_->after();
    if (n % kProgressClocks == 0 && options_.progress) options_.progress(static_cast<std::int64_t>(n));
  }

  ClockedPipeline& pipeline_;
  const MachineOptions& options_;
  sc_core::sc_time period_;
  std::unique_ptr<ClockedVcd> vcd_;
  std::unique_ptr<ClockedLog> log_;
  std::exception_ptr given_up_;
};

}  // namespace

ProgramResult run_clocked(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                          std::uint64_t limit, const RunOptions& options) {
  Board board(spec.main_bytes, image, services);
  ClockedPipeline pipeline(spec, board, image.start, limit);
  pipeline.keep(options.retired);
  sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
  // sc_stop reports itself on standard output, where a program's own output belongs.
  sc_core::sc_report_handler::set_actions("/OSCI/SystemC", sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  ClockedEngine engine("sgi_4d35", pipeline, spec.clock_hz, options.machine);
  if (!pipeline.stopped()) sc_core::sc_start();
  engine.close();
  engine.rethrow();
  const r3000::State& state = pipeline.state();
  if (options.final_state != nullptr) *options.final_state = state;
  ProgramResult result = result_of(state, board, spec);
  result.cycles = static_cast<std::int64_t>(pipeline.clock());
  result.units = units_of(pipeline.counters(), counters_of(state));
  return result;
}

}  // namespace dendro::sgi_4d35
