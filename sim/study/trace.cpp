#include "sim/study/trace.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/study/exec_elf.h"
#include "sim/study/worker.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

const trace::Boundary* find_boundary(const MachineType& type, const std::string& name) {
  for (const trace::Boundary& boundary : type.boundaries)
    if (boundary.name == name) return &boundary;
  return nullptr;
}

std::string boundary_names(const MachineType& type) {
  std::string names;
  for (const trace::Boundary& boundary : type.boundaries) names += (names.empty() ? "" : ", ") + boundary.name;
  return names.empty() ? "none" : names;
}

/// Of a machine whose programs are ELF files its processor's.
double clock_of(const config::ParameterSet& parameters, const MachineType& type) {
  if (!type.exec) return type.make(parameters, Level::kFunction, {})->clock_hz();
  type.check(parameters, Level::kCycle);
  const config::Parameter* clock = parameters.find("processor.clock_hz");
  DENDRO_CHECK(clock != nullptr, "{} has no processor.clock_hz", type.name);
  const auto* real = std::get_if<double>(&clock->value);
  return real ? *real : static_cast<double>(std::get<std::int64_t>(clock->value));
}

trace::Header header_of(const config::Preset& preset, const MachineType& type, const RecordArguments& arguments) {
  trace::Header header;
  header.machine = preset.machine + ":" + preset.name;
  header.boundary = arguments.boundary;
  header.source = arguments.run.scene.empty() ? arguments.exec.program : arguments.run.scene;
  header.source = header.source.substr(header.source.rfind('/') + 1);
  header.clock_hz = clock_of(preset.parameters, type);
  header.from = arguments.from;
  for (const config::Parameter& parameter : preset.parameters.all())
    header.parameters.push_back({parameter.key, config::to_entry(parameter), 0});
  return header;
}

void apply(config::ParameterSet& parameters, const std::string& key, const std::string& text, const config::Where& where) {
  const config::Node value = config::parse_setting(text);
  if (value.kind != config::Node::Kind::kValue) throw UserError(where.file, where.line, key, "a parameter is one value");
  parameters.set(key, value.value, where);
}

/// What the command line sets.
void apply_all(config::ParameterSet& parameters, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    auto [key, text] = config::split_setting(setting);
    if (key.compare(0, 11, "parameters.") == 0) key = key.substr(11);
    apply(parameters, key, text, {"--set", 0});
  }
}

config::Parameter parameter_of(const trace::HeaderSetting& line, const std::string& file) {
  try {
    const config::Node root = config::parse_toml("entry = " + line.text + "\n", file);
    return config::read_parameter(line.key, *root.member("entry"));
  } catch (const UserError& error) {
    throw UserError(file, line.line, line.key, error.message());
  }
}

const MachineType& type_of(const Catalogue& catalogue, const trace::Reader& trace) {
  const trace::Header& header = trace.header();
  const std::string name = header.machine.substr(0, header.machine.find(':'));
  const MachineType* type = catalogue.machine(name);
  if (!type) throw UserError(trace.name(), header.machine_line, "machine", "there is no machine `" + name + "`");
  if (!find_boundary(*type, header.boundary))
    throw UserError(trace.name(), header.boundary_line, "boundary",
                    fmt::format("{} has no boundary `{}`: {}", name, header.boundary, boundary_names(*type)));
  return *type;
}

// The parameters that stand in the trace, or those of the preset it names; then its settings, then the caller's.
config::ParameterSet parameters_of(const Catalogue& catalogue, const trace::Reader& trace,
                                   const std::vector<std::string>& settings) {
  const trace::Header& header = trace.header();
  config::ParameterSet parameters;
  for (const trace::HeaderSetting& line : header.parameters) {
    config::Parameter parameter = parameter_of(line, trace.name());
    if (parameters.find(parameter.key)) throw UserError(trace.name(), line.line, line.key, "stands there twice");
    parameter.where = {trace.name(), line.line};
    parameters.add(std::move(parameter));
  }
  if (header.parameters.empty())
    parameters = config::load_preset(header.machine, catalogue.presets(), {trace.name(), header.machine_line}).parameters;
  for (const trace::HeaderSetting& line : header.settings) apply(parameters, line.key, line.text, {trace.name(), line.line});
  apply_all(parameters, settings);
  return parameters;
}

const MachineType& checked_type(const Catalogue& catalogue, const std::string& machine, const std::string& boundary) {
  const MachineType& type = *catalogue.machine(machine);
  if (!find_boundary(type, boundary))
    throw UserError("--boundary", 0, "", fmt::format("{} has no boundary `{}`: {}", machine, boundary, boundary_names(type)));
  return type;
}

}  // namespace

Recorded record_trace(const Catalogue& catalogue, const RecordArguments& arguments, Progress* progress) {
  if (arguments.from >= arguments.to) throw UserError("--to", 0, "", "the window ends before it begins");
  const bool scene = !arguments.run.scene.empty();
  RunRequest request;
  ExecArguments exec = arguments.exec;
  if (scene) {
    RunArguments run = arguments.run;
    run.level = "cycle";
    request = prepare_run(catalogue, run);
    request.with_picture = false;
  } else {
    exec.level = "cycle";
  }
  const config::Preset preset = scene ? request.preset : exec_preset(catalogue, exec);
  const MachineType& type = checked_type(catalogue, preset.machine, arguments.boundary);
  const trace::Header header = header_of(preset, type, arguments);
  const std::string reply = run_in_worker([&] {
    trace::Writer writer(arguments.boundary, arguments.from, arguments.to, arguments.as_text);
    if (scene) {
      request.options.recorder = &writer;
      execute(request, "", progress);
    } else {
      exec.options.recorder = &writer;
      if (type.exec)
        record_elf(catalogue, exec);
      else
        exec_here(catalogue, exec, progress);
    }
    const std::string file = writer.file(header);
    return fmt::format("{}\n", writer.records()) + file;
  });
  const std::size_t line = reply.find('\n');
  Recorded recorded{reply.substr(line + 1), std::stoll(reply.substr(0, line))};
  if (recorded.records == 0)
    throw UserError("", 0, "", fmt::format("nothing passes {} in this window of time", arguments.boundary));
  return recorded;
}

std::unique_ptr<trace::Reader> open_trace(const Catalogue& catalogue, const std::string& path) {
  auto reader = std::make_unique<trace::Reader>(config::read_text({false, path}, {}), path);
  const trace::Boundary* boundary = find_boundary(type_of(catalogue, *reader), reader->header().boundary);
  reader->expect(*boundary);
  trace::Record record;
  std::int64_t records = 0;
  while (reader->next(record)) ++records;
  if (records == 0) throw UserError(path, 0, "", "has no records");
  reader->rewind();
  return reader;
}

namespace {

constexpr const char* kMagic = "dendro-trace ";

const MachineType& plain_type(const Catalogue& catalogue, const std::string& boundary) {
  std::string known;
  for (const MachineType& type : catalogue.machines) {
    if (type.plain_boundary.empty()) continue;
    if (type.plain_boundary == boundary) return type;
    known += (known.empty() ? "" : ", ") + type.plain_boundary;
  }
  throw UserError("--boundary", 0, "",
                  fmt::format("`{}` takes no memory trace from elsewhere; those that do: {}", boundary, known));
}

Level replay_level(const std::string& name, const MachineType& type) {
  const Level level = level_of(name, type);
  if (level != Level::kCycle && level != Level::kClocked)
    throw UserError("--level", 0, "", "a trace says when things happen: replay it at cycle or clocked");
  return level;
}

ReplayOutput replay_plain(const Catalogue& catalogue, const ReplayArguments& arguments, std::string bytes) {
  const MachineType& type = plain_type(catalogue, arguments.boundary);
  const Level level = replay_level(arguments.level, type);
  config::Preset preset = config::load_preset(type.name, catalogue.presets(), {});
  apply_all(preset.parameters, arguments.settings);
  if (type.check) type.check(preset.parameters, level);
  trace::PlainReader reader(std::move(bytes), arguments.trace);
  const PlainReplay replay = type.replay_plain(preset.parameters, level, reader);
  ReplayOutput output{arguments.boundary, preset.machine + ":" + preset.name, arguments.level, {}, {}, {}};
  output.result.transactions = replay.accesses;
  output.result.cycles = replay.cycles;
  output.units = replay.units;
  output.summary = replay.summary;
  return output;
}

}  // namespace

ReplayOutput replay_trace(const Catalogue& catalogue, const ReplayArguments& arguments) {
  if (!arguments.boundary.empty()) {
    std::string bytes = config::read_text({false, arguments.trace}, {});
    if (bytes.rfind(kMagic, 0) == 0)
      throw UserError("--boundary", 0, "", arguments.trace + " is a trace of dendro, which says its boundary itself");
    return replay_plain(catalogue, arguments, std::move(bytes));
  }
  const auto trace = open_trace(catalogue, arguments.trace);
  const MachineType& type = type_of(catalogue, *trace);
  const Level level = replay_level(arguments.level, type);
  const config::ParameterSet parameters = parameters_of(catalogue, *trace, arguments.settings);
  if (type.check)
    type.check(parameters, level);
  else
    type.make(parameters, Level::kFunction, {});
  const Json json = Json::parse(run_in_worker([&] {
    const trace::ReplayResult result = type.replay(parameters, level, *trace);
    Json reply = {{"transactions", result.transactions}, {"cycles", result.cycles}};
    if (result.difference) reply["difference"] = *result.difference;
    return reply.dump();
  }));
  ReplayOutput output{trace->header().boundary, trace->header().machine, arguments.level, {}, {}, {}};
  output.result.transactions = json.at("transactions").get<std::int64_t>();
  output.result.cycles = json.at("cycles").get<std::int64_t>();
  if (json.contains("difference")) output.result.difference = json.at("difference").get<std::string>();
  return output;
}

scene::RgbImage trace_picture(const Catalogue& catalogue, const std::string& path) {
  const auto trace = open_trace(catalogue, path);
  return trace_picture(*trace, *find_boundary(type_of(catalogue, *trace), trace->header().boundary));
}

std::string replay_json(const ReplayOutput& output) {
  Json json = {{"schema", 1}, {"command", "replay"}, {"unit", output.unit}, {"machine", output.machine}, {"level", output.level}};
  json["transactions"] = output.result.transactions;
  json["differences"] = output.result.difference ? 1 : 0;
  json["first_difference"] = output.result.difference ? Json(*output.result.difference) : Json(nullptr);
  json["cycles"] = output.result.cycles;
  for (const UnitStats& unit : output.units)
    for (const auto& [name, value] : unit.values) json["units"][unit.unit][name] = value;
  return json.dump(1) + "\n";
}

}  // namespace dendro::study
