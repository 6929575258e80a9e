#include "sim/study/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "firmware/half_space/stability/cases.h"
#include "firmware/lib/workstation_rig.h"
#include "firmware/zbuffer_views/stability/cases.h"
#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/config/preset.h"
#include "sim/scene/chart.h"
#include "sim/study/algorithms.h"
#include "sim/study/igc_programs.h"
#include "sim/study/run.h"
#include "sim/study/stability_tree.h"
#include "sim/study/worker.h"
#include "sim/study/workstation.h"

namespace dendro::study {
namespace {

using stability::Bound;
using stability::Curve;
using stability::Result;
using stability::Row;
using Json = nlohmann::json;

/// A catalogue machine with one preset's parameters.
class CatalogueRig : public stability::Rig, public stability::WorkstationRig {
 public:
  CatalogueRig(const Catalogue& catalogue, const StabilitySuite& suite)
      : preset_(config::load_preset(suite.machine, catalogue.presets(), {"--machine", 0})),
        type_(catalogue.machine(preset_.machine)) {
    DENDRO_CHECK(type_ != nullptr, "{}", suite.machine);
    set(suite.parameters);
  }

  std::unique_ptr<Rig> with(const std::map<std::string, std::int64_t>& parameters) const override {
    auto other = std::make_unique<CatalogueRig>(*this);
    other->set(parameters);
    return other;
  }

  lib::ProgramImage program(const std::string& path) const override {
    return program_image(path, preset_.parameters);
  }

  lib::IgcPrograms igc_programs(const std::vector<std::string>& paths) const override {
    tools::IgcOptions options;
    options.ports = static_cast<int>(integer_of(preset_.parameters, "array.ports"));
    options.memory_bits = static_cast<int>(integer_of(preset_.parameters, "array.memory_bits"));
    return study::igc_programs(paths, options);
  }

  std::vector<std::vector<std::int64_t>> tree(const stability::TreeDrive& drive,
                                              const std::vector<stability::TreeStream>& streams,
                                              const std::vector<stability::TreePixel>& pixels) const override {
    return drive_tree(static_cast<int>(integer_of(preset_.parameters, "array.width")),
                      static_cast<int>(integer_of(preset_.parameters, "array.height")), drive, streams, pixels);
  }

  void run(const std::function<void(HostPort&)>& host_program,
           const std::function<void(const MachineView&)>& inspect) const override {
    MachineOptions options;
    options.tick_limit = kDefaultTickLimit;
    const auto machine = type_->make(preset_.parameters, Level::kFunction, options);
    machine->run(host_program);
    const Picture picture = machine->picture();
    MachineView view;
    view.peek = [&](std::uint32_t address, unsigned function) { return machine->peek(address, function); };
    view.width = picture.width, view.height = picture.height;
    view.rgb = picture.rgb.data();
    inspect(view);
  }

  std::string program_bytes(const std::string& program) const override { return shipped_program(program); }

  std::string exec_bytes(const std::string& program, const std::string& bytes, const std::vector<std::string>& arguments,
                         stability::Files& files) const override {
    MemoryServices services(files);
    run_elf(*type_, preset_.parameters, Level::kFunction, {}, program, bytes, arguments, services);
    return services.output;
  }

 private:
  void set(const std::map<std::string, std::int64_t>& parameters) {
    for (const auto& [key, value] : parameters) preset_.parameters.set(key, value, {"stability", 0});
  }

  config::Preset preset_;
  const MachineType* type_;
};

struct Chosen {
  const StabilitySuite* suite;
  const stability::Case* one;
};

std::vector<Chosen> choose(const std::vector<StabilitySuite>& suites, const std::vector<std::string>& ids) {
  std::vector<Chosen> all, chosen;
  std::string known;
  for (const StabilitySuite& suite : suites)
    for (const stability::Case& one : suite.cases) {
      all.push_back({&suite, &one});
      known += (known.empty() ? "" : ", ") + one.id;
    }
  for (const std::string& id : ids)
    if (std::none_of(all.begin(), all.end(), [&](const Chosen& c) { return c.one->id == id; }))
      throw UserError("case", 0, id, "there is no such case; known are " + known);
  for (const Chosen& c : all)
    if (ids.empty() || std::find(ids.begin(), ids.end(), c.one->id) != ids.end()) chosen.push_back(c);
  return chosen;
}

std::string number(double value) {
  return value == std::floor(value) && std::abs(value) < 1e15 ? fmt::format("{:.0f}", value)
                                                              : fmt::format("{:.4g}", value);
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

const char* relation(const Row& row) { return row.kind == Bound::kAtMost ? "at most" : "more than"; }

/// Without what JSON cannot say.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const Row& row) {
  return {{"case", row.case_id},        {"measured", finite(row.measured)},
          {"bound", finite(row.bound)}, {"relation", relation(row)},
          {"unit", row.unit},           {"pass", row.pass()},
          {"reference", row.reference}, {"what", row.what},
          {"where", row.where}};
}

}  // namespace

std::string stability_list(const std::vector<StabilitySuite>& suites) {
  std::string text;
  for (const StabilitySuite& suite : suites)
    for (const stability::Case& one : suite.cases)
      text += fmt::format("{:6} {:14} {:20} {}\n", one.id, suite.algorithm, suite.machine, one.what);
  return text;
}

const std::vector<StabilitySuite>& stability_suites() {
  static const std::vector<StabilitySuite> list = {
      {"half_space", "rds3000:fg86", {}, half_space::stability_cases()},
      {"half_space", "pixel-planes:pxpl4", {}, half_space::planes_stability_cases()},
      // The least memory: hundreds of fresh machines, each of which clears it.
      {"zbuffer_views", "sgi-4d35", {{"memory.main_bytes", 32 << 20}}, zbuffer_views::stability_cases()}};
  return list;
}

std::vector<Result> run_stability(const Catalogue& catalogue, const std::vector<StabilitySuite>& suites,
                                  const StabilityOptions& options, Progress* progress) {
  const std::vector<Chosen> chosen = choose(suites, options.cases);
  std::vector<std::function<std::string()>> tasks;
  for (const Chosen& c : chosen)
    tasks.emplace_back([&catalogue, c, seed = options.seed] {
      return to_bytes(c.one->run(CatalogueRig(catalogue, *c.suite), seed));
    });
  std::size_t done = 0;
  if (progress) progress->runs("stability", 0, tasks.size());
  const auto outcomes = run_in_workers(tasks, options.jobs, [&](std::size_t, const Outcome&) {
    if (progress) progress->runs("stability", ++done, tasks.size());
  });
  if (progress) progress->clear();
  std::vector<Result> results;
  for (const Outcome& outcome : outcomes) results.push_back(result_from_bytes(outcome.value()));
  return results;
}

bool all_pass(const std::vector<Result>& results) {
  for (const Result& result : results)
    for (const Row& row : result.rows)
      if (!row.pass()) return false;
  return true;
}

std::string stability_json(const std::vector<Result>& results) {
  Json rows = Json::array();
  for (const Result& result : results)
    for (const Row& row : result.rows) rows.push_back(to_json(row));
  return Json{{"schema", 1}, {"command", "stability"}, {"rows", rows}}.dump(1) + "\n";
}

std::string stability_text(const std::vector<Result>& results) {
  std::string text =
      fmt::format("{:6} {:4} {:>10} {:>13}  {:16} {}\n", "case", "", "measured", "bound", "unit", "what");
  std::size_t rows = 0, failed = 0;
  for (const Result& result : results)
    for (const Row& row : result.rows) {
      ++rows, failed += !row.pass();
      text +=
          fmt::format("{:6} {:4} {:>10} {:>13}  {:16} {} [{}]\n", row.case_id, row.pass() ? "ok" : "FAIL",
                      number(row.measured), (row.kind == Bound::kAtMost ? "<= " : "> ") + number(row.bound),
                      row.unit, row.what, row.reference);
      if (!row.pass() && !row.where.empty()) text += fmt::format("            first: {}\n", row.where);
    }
  return text + fmt::format("{} of {} bounds hold\n", rows - failed, rows);
}

std::string stability_csv(const std::vector<Result>& results) {
  std::string text = "case,pass,measured,relation,bound,unit,reference,what,where\n";
  for (const Result& result : results)
    for (const Row& row : result.rows)
      text += fmt::format("{},{},{:.10g},{},{:.10g},{},{},{},{}\n", row.case_id, row.pass() ? 1 : 0,
                          row.measured, relation(row), row.bound, quoted(row.unit), quoted(row.reference),
                          quoted(row.what), quoted(row.where));
  return text;
}

std::string curve_csv(const Curve& curve) {
  std::string text;
  for (const std::string& column : curve.columns) text += (text.empty() ? "" : ",") + quoted(column);
  text += "\n";
  for (const auto& row : curve.rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      text +=
          (std::isfinite(row[i]) ? fmt::format("{:.10g}", row[i]) : "") + (i + 1 < row.size() ? "," : "\n");
  return text;
}

void write_curve_picture(const Curve& curve, const std::string& path) {
  scene::LineChart chart;
  chart.title = curve.title;
  chart.x.label = curve.columns.front();
  chart.y.label = curve.y_label;
  chart.y.logarithmic = curve.logarithmic;
  for (std::size_t c = 1; c < curve.columns.size(); ++c) {
    scene::ChartSeries series{curve.columns[c], {}, {}};
    for (const auto& row : curve.rows) {
      // A logarithm has no place for what is not lost any more.
      if (curve.logarithmic && !(row[c] > 0)) continue;
      series.x.push_back(row[0]);
      series.y.push_back(row[c]);
    }
    chart.series.push_back(std::move(series));
  }
  scene::write_png(path, scene::draw(chart));
}

std::string to_bytes(const Result& result) {
  Json json = {{"rows", Json::array()}, {"curves", Json::array()}};
  for (const Row& r : result.rows)
    json["rows"].push_back(
        {r.case_id, r.what, r.measured, r.bound, r.unit, r.reference, static_cast<int>(r.kind), r.where});
  for (const Curve& c : result.curves)
    json["curves"].push_back({c.name, c.title, c.columns, c.rows, c.logarithmic, c.y_label});
  const auto cbor = Json::to_cbor(json);
  return std::string(cbor.begin(), cbor.end());
}

Result result_from_bytes(const std::string& bytes) {
  const Json json = Json::from_cbor(bytes);
  Result result;
  for (const Json& r : json.at("rows"))
    result.rows.push_back({r[0].get<std::string>(), r[1].get<std::string>(), r[2].get<double>(),
                           r[3].get<double>(), r[4].get<std::string>(), r[5].get<std::string>(),
                           static_cast<Bound>(r[6].get<int>()), r[7].get<std::string>()});
  for (const Json& c : json.at("curves"))
    result.curves.push_back(
        {c[0].get<std::string>(), c[1].get<std::string>(), c[2].get<std::vector<std::string>>(),
         c[3].get<std::vector<std::vector<double>>>(), c[4].get<bool>(), c[5].get<std::string>()});
  return result;
}

}  // namespace dendro::study
