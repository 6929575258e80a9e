#include "sim/study/run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"
#include "sim/scene/chart.h"
#include "sim/scene/image_io.h"
#include "sim/study/worker.h"
#include "sim/study/workstation.h"

namespace dendro::study {
namespace {

using Json = nlohmann::json;

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// Whole entries first: a plain value is meant to stand above the entry that a resolved scene has for the
/// same key.
void apply_parameters(const SceneFile& file, config::ParameterSet& parameters) {
  for (const auto& [key, node] : file.parameters)
    if (node.kind == config::Node::Kind::kTable)
      config::replace(parameters, config::read_parameter(key, node));
  const auto set_values = [&](bool only_unknown) {
    for (const auto& [key, node] : file.parameters)
      if (node.kind == config::Node::Kind::kValue && (!only_unknown || parameters.find(key) == nullptr))
        parameters.set(key, node.value, node.where);
  };
  // A misspelt parameter is found before values are looked at.
  set_values(true);
  set_values(false);
}

/// The node that a key of an error message names, or nullptr.
const config::Node* named_node(const config::Node& document, const std::string& key) {
  const config::Node* at = &document;
  for (std::size_t from = 0; at != nullptr && from <= key.size();) {
    const std::size_t dot = std::min(key.find('.', from), key.size());
    at = at->member(key.substr(from, dot - from));
    from = dot + 1;
  }
  return at;
}

/// What a job says is wrong, blamed on the line or the --set that said it; a mesh that is wrong is named with
/// the place that asked for it.
[[noreturn]] void blame(const UserError& error, const SceneFile& file) {
  if (const config::Node* node = named_node(file.document, error.key()); node && !error.key().empty())
    throw UserError(node->where.file, node->where.line, error.key(), error.message());
  for (const scene::Object& object : file.scene.objects) {
    if (object.mesh.empty() || error.file() != object.mesh) continue;
    const scene::Where& at = object.source_where;
    throw UserError(error.file(), error.line(), error.key(),
                    fmt::format("{} (the mesh of {}{})", error.message(), at.file,
                                at.line > 0 ? fmt::format(":{}", at.line) : ""));
  }
  throw;
}

void check_inputs(const std::vector<PinnedDigest>& inputs) {
  for (const PinnedDigest& input : inputs) {
    const std::string now = base::sha256_file(input.name);
    if (now != input.sha256)
      throw UserError(
          input.where.file, input.where.line, "input",
          fmt::format("{} has changed: its SHA-256 is {}, not {}", input.name, now, input.sha256));
  }
}

void check_firmware(const std::vector<PinnedDigest>& pins, const Job& job) {
  for (const PinnedDigest& pin : pins) {
    const auto images = job.firmware();
    const bool same = std::any_of(images.begin(), images.end(), [&](const FirmwareImage& image) {
      return image.name == pin.name && image.sha256 == pin.sha256;
    });
    if (!same)
      throw UserError(pin.where.file, pin.where.line, "firmware",
                      pin.name +
                          " is not the firmware of this run any more; without this table the scene runs with "
                          "what this dendro has");
  }
}

std::unique_ptr<Job> make_job(const RunRequest& request) {
  // The machine checks its parameters before a program is assembled for it, so that the parameter is blamed.
  if (request.type->check) {
    request.type->check(request.preset.parameters, request.level);
  } else {
    request.type->make(request.preset.parameters, Level::kFunction, {});
  }
  try {
    auto job = request.algorithm->make(request.file.scene, *request.type, request.preset.parameters);
    check_firmware(request.file.firmware, *job);
    return job;
  } catch (const UserError& error) {
    blame(error, request.file);
  }
}

/// The machine's own phase: the one of the last mark passed.
std::string phase_of(const Machine& machine) {
  const std::vector<MarkEvent> marks = machine.marks();
  for (auto mark = marks.rbegin(); mark != marks.rend(); ++mark)
    if (starts_with(mark->name, "phase_")) return mark->name.substr(6);
  return "";
}

/// `machine` is asked for its phase while it runs; it may still be empty when this is called.
MachineOptions machine_options(const RunRequest& request, const Job& job, Progress* progress,
                               const std::unique_ptr<Machine>& machine) {
  MachineOptions options = request.options;
  if (options.tick_limit == 0) options.tick_limit = kDefaultTickLimit;
  for (const FirmwareImage& image : job.firmware()) {
    options.programs[image.name] = marked_words(image.symbols);
    for (const auto& [name, address] : image.symbols) options.symbols[address] = name;
  }
  if (progress && progress->enabled())
    options.progress = [progress, &machine](std::int64_t tick) {
      progress->tick(tick, [&machine] { return phase_of(*machine); });
    };
  return options;
}

std::int64_t peak_rss_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

/// `ticks`: those in which the machine ran, or instructions where there is no time.
stats::HostInfo host_info(double ticks, double clock_hz, double seconds) {
  stats::HostInfo host;
  host.seconds = seconds;
  host.simulated_hz = seconds > 0 ? ticks / seconds : 0;
  host.real_time_factor = host.simulated_hz / clock_hz;
  host.peak_rss_bytes = peak_rss_bytes();
  return host;
}

stats::RunObject describe(const RunRequest& request) {
  const SceneFile& file = request.file;
  stats::RunObject object;
  object.scene = file.scene.name;
  object.algorithm = request.algorithm->name;
  object.machine = request.type->name;
  object.preset = file.preset_label.empty() ? request.preset.name : file.preset_label;
  object.level = level_name(request.level);
  object.seed = file.scene.seed;
  const auto assumptions = request.preset.parameters.assumptions();
  object.assumptions.assign(assumptions.begin(), assumptions.end());
  if (!file.build.empty() && file.build != executable_digest())
    object.notes.push_back("resolved by another build of dendro");
  return object;
}

/// A host program that starts the machine many times comes back to its phases; what they took is told once.
void add_phases(const std::vector<Phase>& phases, stats::RunObject& object) {
  for (const Phase& p : phases) {
    const double seconds = static_cast<double>(p.cycles) / object.clock_hz;
    const auto same = std::find_if(object.phases.begin(), object.phases.end(), [&](const stats::PhaseRow& row) {
      return row.name == p.name && row.on_host == p.on_host;
    });
    if (same == object.phases.end()) {
      object.phases.push_back({p.name, p.cycles, seconds, p.on_host});
    } else {
      same->cycles += p.cycles;
      same->seconds += seconds;
    }
  }
}

void add_counters(const Machine& machine, double seconds, stats::RunObject& object) {
  object.cycles = machine.cycles();
  object.clock_hz = machine.clock_hz();
  object.seconds = static_cast<double>(object.cycles) / object.clock_hz;
  object.machine_cycles = machine.machine_cycles();
  object.instructions = machine.instructions();
  object.time_dependent = machine.time_dependent();
  add_phases(machine.phases(), object);
  for (const UnitStats& u : machine.units()) object.units.push_back({u.unit, u.values});
  for (const MarkEvent& m : machine.marks()) object.marks.emplace_back(m.name, m.tick);
  object.executions = machine.executions();
  object.elaborated = machine.elaborated();
  const double ticks = machine.cycles() > 0 ? static_cast<double>(machine.machine_cycles())
                                            : static_cast<double>(machine.instructions());
  object.host = host_info(ticks, machine.clock_hz(), seconds);
}

/// Where the ticks went, in false colours.
void write_cost(const PixelCosts& costs, const Picture& picture, const std::string& folder) {
  scene::write_png(folder + "/cost_ticks.png",
                   scene::draw_per_pixel(picture.width, picture.height, costs.ticks, "ticks per pixel"));
  scene::write_png(folder + "/cost_visits.png",
                   scene::draw_per_pixel(picture.width, picture.height, costs.visits, "visits per pixel"));
}

void write_pictures(const Job& job, const MachineView& view, const Picture& picture, const PixelCosts& costs,
                    const std::string& folder) {
  scene::write_png(folder + "/image.png", {picture.width, picture.height, picture.rgb});
  std::vector<scene::FloatChannel> channels;
  for (Layer& layer : job.layers(view)) channels.emplace_back(layer.name, std::move(layer.values));
  if (!costs.ticks.empty()) {
    channels.emplace_back("cost.ticks", costs.ticks);
    channels.emplace_back("cost.visits", costs.visits);
    write_cost(costs, picture, folder);
  }
  scene::write_exr(folder + "/image.exr", picture.width, picture.height, channels);
}

void add_picture(Picture picture, MachineView view, const PixelCosts& costs, const Job& job, const std::string& folder,
                 RunOutput& output) {
  view.width = picture.width;
  view.height = picture.height;
  view.rgb = picture.rgb.data();
  const ErrorReport error = job.compare(view);
  output.object.error = {error.reference,    error.psnr_db,        error.max_depth_error,
                         error.wrong_pixels, error.covered_pixels, error.extra};
  output.object.image = {"", picture.width, picture.height,
                         scene::image_digest({picture.width, picture.height, picture.rgb})};
  if (!folder.empty()) write_pictures(job, view, picture, costs, folder);
  output.rgb = std::move(picture.rgb);
}

/// A run on a machine whose programs are files.
void run_programs(const RunRequest& request, ProgramJob& job, const std::string& folder, Progress* progress, RunOutput& output) {
  ElfWorkstation workstation(request, job, request.with_picture ? folder : "", progress);
  job.run_programs(workstation);
  stats::RunObject& object = output.object;
  object.cycles = object.machine_cycles = workstation.cycles();
  object.clock_hz = workstation.clock_hz();
  object.seconds = static_cast<double>(object.cycles) / object.clock_hz;
  object.instructions = workstation.instructions();
  add_phases(workstation.phases(), object);
  for (const UnitStats& u : workstation.units())
    if (request.level != Level::kFunction) object.units.push_back({u.unit, u.values});
  const double ticks = object.cycles > 0 ? static_cast<double>(object.cycles) : static_cast<double>(object.instructions);
  object.host = host_info(ticks, object.clock_hz, workstation.host_seconds());
  if (request.level == Level::kEstimate) stats::add_sampling_interval(object);
  object.facts = job.facts();
  object.notes.insert(object.notes.end(), workstation.notes().begin(), workstation.notes().end());
  // Counters of a run without time have no `cycles` that they would add up to.
  for (const UnitStats& u : workstation.units())
    for (const auto& [name, value] : u.values)
      if (request.level == Level::kFunction) object.facts.emplace_back(u.unit + "." + name, static_cast<double>(value));
  stats::check_sanity(object);
  if (!request.with_picture) return;
  add_picture({job.width(), job.height(), job.rgb()}, {}, {}, job, folder, output);
  workstation.finish();
}

}  // namespace

Level level_of(const std::string& name, const MachineType& type, const config::Where& where) {
  std::string known;
  for (const Level level : type.levels) {
    if (name == level_name(level)) return level;
    known += (known.empty() ? "" : ", ") + std::string(level_name(level));
  }
  throw UserError(where.file, where.line, where.file == "--level" ? "" : "level",
                  fmt::format("{} has no level `{}`: known are {}", type.name, name, known));
}

RunRequest prepare_run(const Catalogue& catalogue, const RunArguments& arguments) {
  RunRequest request;
  request.catalogue = &catalogue;
  request.file = load_scene(arguments.scene, arguments.settings, catalogue);
  SceneFile& file = request.file;
  if (arguments.seed) file.scene.seed = *arguments.seed;
  const bool from_command = !arguments.machine.empty();
  const bool resolved = std::any_of(file.parameters.begin(), file.parameters.end(), [](const auto& p) {
    return p.second.kind == config::Node::Kind::kTable;
  });
  if (from_command && resolved)
    throw UserError("--machine", 0, "",
                    file.scene.file + " carries the parameters of its machine; use --set");
  const std::string machine = from_command ? arguments.machine : file.scene.machine;
  const config::Where where = from_command ? config::Where{"--machine", 0} : file.machine_where;
  request.preset = config::load_preset(machine, catalogue.presets(), where);
  request.type = catalogue.machine(request.preset.machine);
  request.algorithm = catalogue.algorithm(file.scene.algorithm);
  DENDRO_CHECK(request.type && request.algorithm, "{} {}", request.preset.machine, file.scene.algorithm);
  const auto& able = request.algorithm->machines;
  if (std::find(able.begin(), able.end(), request.type->name) == able.end()) {
    std::string list;
    for (const auto& name : able) list += (list.empty() ? "" : ", ") + name;
    throw UserError(where.file, where.line, "machine",
                    fmt::format("{} has no firmware for {}; it runs on {}", request.type->name,
                                file.scene.algorithm, list));
  }
  apply_parameters(file, request.preset.parameters);
  request.level = !arguments.level.empty()
                      ? level_of(arguments.level, *request.type)
                      : level_of(file.level.value_or("cycle"), *request.type, file.level_where);
  request.options = arguments.options;
  request.use_cache = arguments.use_cache;
  if (!request.options.vcd_file.empty() && request.level != Level::kClocked)
    throw UserError("--vcd", 0, "", "waveforms exist at --level clocked only");
  if (request.options.cost && request.level != Level::kCycle)
    throw UserError("--cost", 0, "", "ticks are counted by pixel at --level cycle only");
  check_inputs(file.inputs);
  return request;
}

std::map<std::uint32_t, std::string> marked_words(const std::map<std::string, std::uint32_t>& symbols) {
  std::map<std::uint32_t, std::string> marks;
  for (const auto& [name, address] : symbols)
    if (starts_with(name, "mark_") || starts_with(name, "phase_")) marks[address] = name;
  return marks;
}

void check_run(const RunRequest& request) { make_job(request); }

RunOutput execute(const RunRequest& request, const std::string& folder, Progress* progress) {
  const auto job = make_job(request);
  RunOutput output;
  output.object = describe(request);
  output.object.facts = job->facts();
  for (const std::string& path : job->input_files())
    output.inputs.emplace_back(path, base::sha256_file(path));
  for (const FirmwareImage& image : job->firmware()) output.firmware.emplace_back(image.name, image.sha256);
  if (auto* programs = dynamic_cast<ProgramJob*>(job.get())) {
    run_programs(request, *programs, folder, progress, output);
    return output;
  }

  const auto start = std::chrono::steady_clock::now();
  std::unique_ptr<Machine> machine;
  machine = request.type->make(request.preset.parameters, request.level,
                               machine_options(request, *job, progress, machine));
  if (progress) progress->start_run(request.file.scene.name, machine->clock_hz());
  machine->run([&](HostPort& port) {
    ReportingPort reporting(port, progress);
    job->run(reporting);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  add_counters(*machine, seconds, output.object);
  if (request.options.cost)
    output.object.facts.emplace_back("cost.elsewhere_ticks", static_cast<double>(machine->costs().elsewhere));
  if (request.options.activity > 0) {
    output.phases = machine->phases();
    output.activity = machine->activity();
  }
  stats::check_sanity(output.object);
  if (!request.with_picture) return output;
  MachineView view;
  view.peek = [&](std::uint32_t address, unsigned function) { return machine->peek(address, function); };
  add_picture(machine->picture(), view, machine->costs(), *job, folder, output);
  return output;
}

stats::RunObject describe_machine(const Machine& machine, double seconds) {
  stats::RunObject object;
  add_counters(machine, seconds, object);
  return object;
}

void expect_ticks(const RunRequest& request, Progress& progress) {
  const auto& levels = request.type->levels;
  const bool told = std::find(levels.begin(), levels.end(), Level::kCycle) != levels.end();
  if (!progress.enabled() || request.level != Level::kClocked || !told) return;
  RunRequest fast = request;
  fast.level = Level::kCycle;
  fast.with_picture = false;
  fast.options = {};
  fast.options.tick_limit = request.options.tick_limit;
  progress.expect(execute_in_worker(fast, "", nullptr).object.cycles);
}

RunOutput execute_in_worker(const RunRequest& request, const std::string& folder, Progress* progress) {
  return from_bytes(run_in_worker([&] { return to_bytes(execute(request, folder, progress)); }));
}

std::string to_bytes(const RunOutput& output) {
  Json json, phases = Json::array(), activity = Json::array();
  for (const Phase& p : output.phases) phases.push_back({p.name, p.cycles, p.on_host});
  for (const ActivitySample& sample : output.activity) {
    Json units = Json::array();
    for (const UnitStats& unit : sample.units) units.push_back({unit.unit, unit.values});
    activity.push_back({sample.tick, std::move(units)});
  }
  json["phases"] = std::move(phases);
  json["activity"] = std::move(activity);
  json["object"] = stats::to_json(output.object);
  json["rgb"] = Json::binary(output.rgb);
  json["inputs"] = output.inputs;
  json["firmware"] = output.firmware;
  const auto cbor = Json::to_cbor(json);
  return std::string(cbor.begin(), cbor.end());
}

RunOutput from_bytes(const std::string& bytes) {
  const Json json = Json::from_cbor(bytes);
  RunOutput output;
  output.object = stats::from_json(json.at("object").get<std::string>());
  for (const Json& p : json.at("phases"))
    output.phases.push_back({p.at(0).get<std::string>(), p.at(1).get<std::int64_t>(), p.at(2).get<bool>()});
  for (const Json& s : json.at("activity")) {
    ActivitySample sample{s.at(0).get<std::int64_t>(), {}};
    for (const Json& unit : s.at(1)) {
      auto values = unit.at(1).get<std::vector<std::pair<std::string, std::uint64_t>>>();
      sample.units.push_back({unit.at(0).get<std::string>(), std::move(values)});
    }
    output.activity.push_back(std::move(sample));
  }
  output.rgb = json.at("rgb").get_binary();
  output.inputs = json.at("inputs").get<std::vector<std::pair<std::string, std::string>>>();
  output.firmware = json.at("firmware").get<std::vector<std::pair<std::string, std::string>>>();
  return output;
}

}  // namespace dendro::study
