#include <fmt/format.h>

#include "firmware/job.h"
#include "firmware/processor_figures/sgi_4d35/figures.h"
#include "sim/base/sha256.h"
#include "sim/study/table_mo95.h"
#include "sim/study/table_probe.h"
#include "sim/study/workstation.h"

namespace dendro::study {
namespace {

constexpr const char *kMachine = "sgi-4d35", *kNumbers = "processor_figures_numbers",
                     *kIntegers = "processor_figures_integers";

/// A shipped program alone on the workstation; it says itself whether its result is right.
class FiguresJob : public ProgramJob {
 public:
  FiguresJob(std::string program, std::vector<std::string> arguments)
      : program_(std::move(program)), arguments_(std::move(arguments)) {}

  void run_programs(Workstation& workstation) override { workstation.run(program_, arguments_, true); }
  std::string phase_name(std::uint32_t label) const override {
#define FIG_PHASE_NAME(name, number, text) \
  if (label == number) return text;
    FIG_PHASES(FIG_PHASE_NAME)
#undef FIG_PHASE_NAME
    return "";
  }
  int width() const override { return 0; }
  int height() const override { return 0; }
  const std::vector<std::uint8_t>& rgb() const override { return none_; }
  ErrorReport compare(const MachineView&) const override { return {}; }
  std::vector<Layer> layers(const MachineView&) const override { return {}; }
  std::vector<std::string> input_files() const override { return {}; }
  std::vector<FirmwareImage> firmware() const override {
    return {{program_, base::sha256(shipped_program(program_)), {}}};
  }
  std::vector<std::pair<std::string, double>> facts() const override { return {}; }

 private:
  const std::string program_;
  const std::vector<std::string> arguments_;
  const std::vector<std::uint8_t> none_;
};

/// The program as a run of the table; requests made from it must not outlive it.
std::unique_ptr<ProbeRequest> program_request(const TableContext& context, const std::string& program,
                                              const std::vector<std::string>& arguments = {}) {
  const std::string name = fmt::format("{}{}", program, arguments.empty() ? "" : " " + arguments.front());
  return std::make_unique<ProbeRequest>(context, name, kMachine, [=](const config::ParameterSet&) {
    return std::make_unique<FiguresJob>(program, arguments);
  });
}

double phase_cycles(const stats::RunObject& run, const std::string& name) {
  return phase_seconds(run, std::string(kNumbers) + "." + name) * run.clock_hz;
}

double mflops(const stats::RunObject& run, double operations, double cycles) {
  return operations / (cycles / run.clock_hz) / 1e6;
}

/// 2/3 n^3 + 2 n^2 operations, as the benchmark counts them.
double linpack(const stats::RunObject& run) {
  constexpr double n = kFigOrder;
  return mflops(run, 2 * n * n * n / 3 + 2 * n * n, phase_cycles(run, "factor") + phase_cycles(run, "solve"));
}

double near_cycles(const stats::RunObject& run) {
  return phase_cycles(run, "daxpy_near") / (kFigNear * kFigNearPasses);
}

double far_mflops(const stats::RunObject& run) {
  constexpr double elements = double{kFigFar} * kFigFarPasses;
  return mflops(run, 2 * elements, phase_cycles(run, "daxpy_far"));
}

double read_cycles(const stats::RunObject& run) { return phase_cycles(run, "read_words") / kFigWords; }

std::vector<stats::RunObject> run_all(const TableContext& context, const std::vector<RunRequest>& requests) {
  std::vector<stats::RunObject> objects;
  for (const Outcome& outcome :
       worker_runs(context.options.jobs, context.progress, "MO95 processor", &context.cache)(requests))
    objects.push_back(from_bytes(outcome.value()).object);
  return objects;
}

void fill_numbers(const TableContext& context, std::vector<TableRow>& rows) {
  check_level(context);
  const auto numbers = program_request(context, kNumbers),
             plain = program_request(context, kNumbers, {"plain"});
  const std::vector<Metric> metrics = {
      {"linpack", linpack}, {"near", near_cycles}, {"far", far_mflops}, {"read", read_cycles}};
  const Propagated p = propagate_request(context, numbers->request(), metrics, "MO95 processor");
  const Assignment indigo = {{"processor.clock_hz", 33e6},
                             {"instruction_cache.size_bytes", std::int64_t{32768}},
                             {"data_cache.size_bytes", std::int64_t{32768}}};
  const std::vector<stats::RunObject> made =
      run_all(context, {plain->request(), with_values(numbers->request(), indigo)});
  for (const std::size_t i : {0, 1, 2}) set_metric(rows[i], p, metrics, 0);
  scale_to(rows[1], linpack(p.nominal) * 25e6 / p.nominal.clock_hz);
  scale_to(rows[2], linpack(made[1]));
  for (std::size_t i = 1; i < metrics.size(); ++i) set_metric(rows[2 + i], p, metrics, i);
  for (const std::size_t i : {1, 2}) rows[i].widened_by.clear();
  rows[0].note = fmt::format("{}; {:.2f} with plain loops instead of sums in fours", beside(rows[0], 4, 6),
                             linpack(made[0]));
  rows[1].note = beside(rows[1], 3.6, 3.9) +
                 "; memory takes as many clocks here at 25 MHz as at 36, an M/2000's is not known";
  rows[2].note = "the Indigo's memory is taken for the 4D/35's; ends in proportion to P7a's";
  rows[3].note = beside(rows[3], 10, 11) +
                 fmt::format(
                     " clocks, {:.2f} MFLOPS; {:.2f} clocks with plain loops; the sheet counts a lower "
                     "bound: loads, stores, product and sum, of which some overlap; GCC lets elements wait "
                     "for each other",
                     2 * p.nominal.clock_hz / near_cycles(p.nominal) / 1e6, near_cycles(made[0]));
  rows[4].note = beside(rows[4], 3, 4) +
                 "; every line that is read holds two doubles, and every sum is written to memory";
  rows[5].note = "what is above 4.5 are the loop and pages";
}

void fill_integers(const TableContext& context, std::vector<TableRow>& rows) {
  check_level(context);
  const auto integers = program_request(context, kIntegers);
  const std::vector<Metric> metrics = {{"cpi", mo95_cycles_an_instruction}};
  const Propagated p = propagate_request(context, integers->request(), metrics, "MO95 processor");
  set_metric(rows[0], p, metrics, 0);
  rows[0].note =
      beside(rows[0], 1.1, 1.2) +
      fmt::format("; {:.1f} million instructions a second; {}",
                  p.nominal.clock_hz / mo95_cycles_an_instruction(p.nominal) / 1e6, mo95_stalls(p.nominal));
}

void add_ratings(RowGroup& group) {
  const auto add = [&group](const char* id, const char* what, const char* unit, double published,
                            const char* why) {
    group.rows.push_back(claim(id, what, unit, published));
    group.rows.back().note = std::string("no figure: ") + why;
  };
  const char* vax =
      "a ratio to a VAX-11/780 over programs that its vendor chose and does not name; P8 has the rate of "
      "instructions of a loop";
  const char* spec = "the suite is licensed, its programs need an operating system";
  add("MO95-P1", "the vendor's rating of a 4D/35", "MIPS", 33, vax);
  add("MO95-P2", "the vendor's floating-point rating of a 4D/35 (5 to 6)", "MFLOPS", 5.5,
      "the program is not named; P7a and P9 are what can be measured");
  add("MO95-P3", "SPECmark89 of a 4D/35", "1", 31, spec);
  add("MO95-P4a", "rating of an Indigo at 33 MHz, 32+32 KB", "MIPS", 30, vax);
  add("MO95-P4c", "SPECmark89 of an Indigo (24 to 26)", "1", 25, spec);
  add("MO95-P4d", "SPECint92 of an Indigo", "1", 22.4, spec);
  add("MO95-P4e", "SPECfp92 of an Indigo", "1", 24.2, spec);
  add("MO95-P5a", "rating of an M/2000 at 25 MHz", "MIPS", 20, vax);
  add("MO95-P5b", "the same scaled to 36 MHz", "MIPS", 29, vax);
}

}  // namespace

std::vector<RowGroup> mo95_processor_groups() {
  const char* middle = "n = 100, double precision, sums in fours, -O2, mapped; the middle of what is printed";
  RowGroup ratings{"", {}, [](const TableContext&, std::vector<TableRow>&) {}};
  add_ratings(ratings);
  return {{"loops of floating point, at every assumption",
           {claim("MO95-P7a", "LINPACK on a 4D/35", "MFLOPS", 5, middle),
            claim("MO95-P7b", "LINPACK on an M/2000 at 25 MHz", "MFLOPS", 3.75, middle),
            claim("MO95-P4b", "LINPACK on an Indigo at 33 MHz, 32+32 KB", "MFLOPS", 4.2,
                  "the figure is taken for LINPACK's; n = 100, double precision"),
            claim("MO95-P9a", "cycles an element, daxpy in the cache", "1", 10.5,
                  "10 to 11 by the sheet's count, the middle shown"),
            claim("MO95-P9b", "daxpy out of the cache", "MFLOPS", 3.5,
                  "3 to 4 expected by the sheet, the middle shown"),
            claim("MO95-P10", "cycles a word, reading 1 MB", "1", 4.5,
                  "circular: a penalty of 14 and four loads, over four words")},
           fill_numbers},
          {"a loop of records, names and calls, at every assumption",
           {claim("MO95-P8", "cycles an instruction, integers in the caches", "1", 1.15,
                  "1.1 to 1.2 expected by the sheet of a loop like Dhrystone's, the middle shown; a program "
                  "of our own")},
           fill_integers},
          ratings};
}

}  // namespace dendro::study
