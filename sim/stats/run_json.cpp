#include <nlohmann/json.hpp>

#include "sim/stats/run_object.h"

namespace dendro::stats {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// A figure of time; at a level without time there is none.
template <class T>
Json timed(const RunObject& run, T value) {
  return run.has_time() ? Json(value) : Json(nullptr);
}

template <class T>
T or_zero(const Json& value) {
  return value.is_null() ? T{} : value.get<T>();
}

std::optional<double> optional_real(const Json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

template <class T>
Json object_of(const std::vector<std::pair<std::string, T>>& pairs) {
  Json out = Json::object();
  for (const auto& [name, value] : pairs) out[name] = value;
  return out;
}

template <class T>
std::vector<std::pair<std::string, T>> pairs_of(const Json& object) {
  std::vector<std::pair<std::string, T>> out;
  for (const auto& [name, value] : object.items()) out.emplace_back(name, value.template get<T>());
  return out;
}

Json phases_json(const RunObject& run) {
  Json out = Json::array();
  for (const PhaseRow& p : run.phases)
    out.push_back({{"name", p.name},
                   {"cycles", p.cycles},
                   {"seconds", p.seconds},
                   {"where", p.on_host ? "host" : "machine"}});
  return out;
}

Json contributions_json(const RunObject& run) {
  Json out = Json::array();
  for (const Contribution& c : run.contributions)
    out.push_back({{"key", c.key}, {"seconds_low", c.low}, {"seconds_high", c.high}, {"source", c.source}});
  return out;
}

Json error_json(const ErrorInfo& error) {
  Json out = {{"reference", error.reference},
              {"psnr_db", or_null(error.psnr_db)},
              {"max_depth_error", error.max_depth_error},
              {"wrong_pixels", error.wrong_pixels},
              {"covered_pixels", error.covered_pixels}};
  for (const auto& [name, value] : error.extra) out[name] = value;
  return out;
}

Json marks_json(const RunObject& run) {
  Json out = Json::array();
  for (const auto& [name, tick] : run.marks) out.push_back({{"name", name}, {"tick", tick}});
  return out;
}

ErrorInfo error_from(const Json& in) {
  ErrorInfo error;
  for (const auto& [name, value] : in.items()) {
    if (name == "reference")
      error.reference = value.get<std::string>();
    else if (name == "psnr_db")
      error.psnr_db = optional_real(value);
    else if (name == "max_depth_error")
      error.max_depth_error = value.get<double>();
    else if (name == "wrong_pixels")
      error.wrong_pixels = value.get<std::int64_t>();
    else if (name == "covered_pixels")
      error.covered_pixels = value.get<std::int64_t>();
    else
      error.extra.emplace_back(name, value.get<double>());
  }
  return error;
}

}  // namespace

std::string to_json(const RunObject& run) {
  Json units = Json::object();
  for (const UnitRow& unit : run.units) units[unit.unit] = object_of(unit.values);
  Json busiest;
  if (const auto unit = busiest_unit(run)) busiest = {{"unit", unit->first}, {"busy", unit->second}};
  const Json out = {{"schema", 1},
                    {"command", "run"},
                    {"scene", run.scene},
                    {"algorithm", run.algorithm},
                    {"machine", run.machine},
                    {"preset", run.preset},
                    {"level", run.level},
                    {"seed", run.seed},
                    {"cycles", timed(run, run.cycles)},
                    {"clock_hz", run.clock_hz},
                    {"seconds", timed(run, run.seconds)},
                    {"seconds_low", or_null(run.seconds_low)},
                    {"seconds_high", or_null(run.seconds_high)},
                    {"contributions", contributions_json(run)},
                    {"interval_notes", run.interval_notes},
                    {"phases", phases_json(run)},
                    {"units", units},
                    {"busiest", busiest},
                    {"image",
                     {{"path", run.image.path},
                      {"width", run.image.width},
                      {"height", run.image.height},
                      {"sha256", run.image.sha256}}},
                    {"error", error_json(run.error)},
                    {"host",
                     {{"seconds", run.host.seconds},
                      {"simulated_hz", run.host.simulated_hz},
                      {"real_time_factor", run.host.real_time_factor},
                      {"peak_rss_bytes", run.host.peak_rss_bytes}}},
                    {"elaborated", run.elaborated},
                    {"assumptions", run.assumptions},
                    {"notes", run.notes},
                    {"machine_cycles", timed(run, run.machine_cycles)},
                    {"instructions", run.instructions},
                    {"time_dependent", run.time_dependent},
                    {"facts", object_of(run.facts)},
                    {"marks", marks_json(run)},
                    {"executions", object_of(run.executions)}};
  return out.dump(1);
}

RunObject from_json(const std::string& text) {
  const Json in = Json::parse(text);
  RunObject run;
  run.scene = in.at("scene").get<std::string>();
  run.algorithm = in.at("algorithm").get<std::string>();
  run.machine = in.at("machine").get<std::string>();
  run.preset = in.at("preset").get<std::string>();
  run.level = in.at("level").get<std::string>();
  run.seed = in.at("seed").get<std::uint64_t>();
  run.cycles = or_zero<std::int64_t>(in.at("cycles"));
  run.clock_hz = in.at("clock_hz").get<double>();
  run.seconds = or_zero<double>(in.at("seconds"));
  run.seconds_low = optional_real(in.at("seconds_low"));
  run.seconds_high = optional_real(in.at("seconds_high"));
  for (const Json& c : in.at("contributions"))
    run.contributions.push_back({c.at("key").get<std::string>(), c.at("seconds_low").get<double>(),
                                 c.at("seconds_high").get<double>(), c.at("source").get<std::string>()});
  run.interval_notes = in.at("interval_notes").get<std::vector<std::string>>();
  for (const Json& p : in.at("phases"))
    run.phases.push_back({p.at("name").get<std::string>(), p.at("cycles").get<std::int64_t>(),
                          p.at("seconds").get<double>(), p.at("where").get<std::string>() == "host"});
  for (const auto& [name, values] : in.at("units").items())
    run.units.push_back({name, pairs_of<std::uint64_t>(values)});
  const Json& image = in.at("image");
  run.image = {image.at("path").get<std::string>(), image.at("width").get<int>(),
               image.at("height").get<int>(), image.at("sha256").get<std::string>()};
  run.error = error_from(in.at("error"));
  const Json& host = in.at("host");
  run.host = {host.at("seconds").get<double>(), host.at("simulated_hz").get<double>(),
              host.at("real_time_factor").get<double>(), host.at("peak_rss_bytes").get<std::int64_t>()};
  run.elaborated = in.at("elaborated").get<std::vector<std::string>>();
  run.assumptions = in.at("assumptions").get<std::vector<std::string>>();
  run.machine_cycles = or_zero<std::int64_t>(in.at("machine_cycles"));
  run.notes = in.at("notes").get<std::vector<std::string>>();
  run.instructions = in.at("instructions").get<std::uint64_t>();
  run.time_dependent = in.at("time_dependent").get<bool>();
  run.facts = pairs_of<double>(in.at("facts"));
  for (const Json& m : in.at("marks"))
    run.marks.emplace_back(m.at("name").get<std::string>(), m.at("tick").get<std::int64_t>());
  run.executions = pairs_of<std::uint64_t>(in.at("executions"));
  return run;
}

}  // namespace dendro::stats
