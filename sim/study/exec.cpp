#include "sim/study/exec.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "firmware/lib/rds3000/rds_driver.h"
#include "firmware/tools/assembler.h"
#include "firmware/tools/ucode.h"
#include "sim/base/error.h"
#include "sim/study/algorithms.h"
#include "sim/study/exec_elf.h"
#include "sim/study/worker.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kScratchpad = 0x820000;
constexpr std::uint32_t kScratchWords = 8192;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A source is assembled for the machine at hand; a finished program must suit it.
tools::Ucode load_ucode(const ExecArguments& arguments, const config::ParameterSet& parameters) {
  const std::string& path = arguments.program;
  const std::string text = arguments.text.empty() ? config::read_text({false, path}, {}) : arguments.text;
  const auto multiply_ticks = static_cast<int>(integer_of(parameters, "processor.multiply_ticks"));
  if (ends_with(path, ".gia")) {
    tools::AssembleOptions options;
    options.multiply_ticks = multiply_ticks;
    options.scratch_words = static_cast<unsigned>(integer_of(parameters, "processor.scratch_words"));
    options.include = include_beside(path);
    return tools::assemble(text, path, options).ucode;
  }
  tools::Ucode ucode = tools::read_ucode(text, path);
  if (ucode.multiply_ticks < multiply_ticks)
    throw UserError(path, 0, "processor.multiply_ticks",
                    fmt::format("the program was assembled for products after {} words, the machine takes {}",
                                ucode.multiply_ticks, multiply_ticks));
  if (static_cast<std::int64_t>(ucode.words.size()) > integer_of(parameters, "processor.control_store_words"))
    throw UserError(path, 0, "", fmt::format("{} words do not fit the control store", ucode.words.size()));
  return ucode;
}

lib::ProgramImage image_of(const tools::Ucode& ucode, const std::string& name) {
  lib::ProgramImage image;
  image.name = name;
  image.words = ucode.words;
  image.entry = ucode.entry;
  image.symbols = ucode.symbols;
  image.initial_scratch = ucode.scratch_data;
  return image;
}

struct Prepared {
  config::Preset preset;
  const MachineType* type = nullptr;
  Level level = Level::kCycle;
  tools::Ucode ucode;
};

Prepared prepare(const Catalogue& catalogue, const ExecArguments& arguments) {
  Prepared p;
  p.preset = exec_preset(catalogue, arguments);
  p.type = catalogue.machine(p.preset.machine);
  if (p.type->exec)
    throw UserError(arguments.program, 0, "",
                    p.type->name + " has no boundary to record yet; programs run by `dendro exec`");
  if (!arguments.arguments.empty())
    throw UserError("", 0, arguments.arguments.front(),
                    "a microprogram takes no arguments; give it data in its scratch areas");
  p.level = exec_level(arguments, *p.type);
  if (p.preset.parameters.find("processor.tick_ns") == nullptr)
    throw UserError(p.preset.machine + " has no processor that runs a program by itself: its host sends it commands");
  p.ucode = load_ucode(arguments, p.preset.parameters);
  if (p.ucode.machine != p.type->name)
    throw UserError(arguments.program, 0, "",
                    "the program is for " + p.ucode.machine + ", not " + p.type->name);
  for (const auto& [address, words] : arguments.dumps)
    if (address >= kScratchWords || words > kScratchWords - address)
      throw UserError("--dump", 0, "", fmt::format("the scratchpad has words 0 to {}", kScratchWords - 1));
  return p;
}

Json run_here(const Prepared& p, const ExecArguments& arguments, Progress* progress) {
  MachineOptions options = arguments.options;
  if (options.tick_limit == 0) options.tick_limit = kDefaultTickLimit;
  options.marks = marked_words(p.ucode.symbols);
  for (const auto& [name, address] : p.ucode.symbols) options.symbols[address] = name;
  if (progress && progress->enabled())
    options.progress = [progress](std::int64_t tick) { progress->tick(tick); };
  const auto start = std::chrono::steady_clock::now();
  const auto machine = p.type->make(p.preset.parameters, p.level, options);
  if (progress) progress->start_run(arguments.program, machine->clock_hz());
  const lib::ProgramImage image = image_of(p.ucode, arguments.program);
  machine->run([&](HostPort& port) {
    ReportingPort reporting(port, progress);
    lib::RdsDriver driver(reporting);
    reporting.phase("load_program");
    driver.load_program(image);
    driver.start(image.entry);
    reporting.phase("finish");
    driver.wait();
  });
  RunOutput output;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  output.object = describe_machine(*machine, seconds);
  output.object.machine = p.type->name;
  output.object.preset = p.preset.name;
  output.object.level = level_name(p.level);
  stats::check_sanity(output.object);
  Json json;
  json["run"] = stats::to_json(output.object);
  json["exit_code"] = machine->peek(kScratchpad, 0) & 0xFF;
  json["dumps"] = Json::array();
  for (const auto& [address, words] : arguments.dumps) {
    Json dump = Json::array();
    for (std::uint32_t i = 0; i < words; ++i) dump.push_back(machine->peek(kScratchpad + address + i, 0));
    json["dumps"].push_back(dump);
  }
  return json;
}

}  // namespace

config::Preset exec_preset(const Catalogue& catalogue, const ExecArguments& arguments) {
  config::Preset preset = config::load_preset(arguments.machine, catalogue.presets(), {});
  for (const std::string& setting : arguments.settings) {
    auto [key, text] = config::split_setting(setting);
    if (key.compare(0, 11, "parameters.") == 0) key = key.substr(11);
    const config::Node value = config::parse_setting(text);
    if (value.kind != config::Node::Kind::kValue)
      throw UserError("--set", 0, key, "a parameter is one value");
    preset.parameters.set(key, value.value, {"--set", 0});
  }
  return preset;
}

Level exec_level(const ExecArguments& arguments, const MachineType& type) {
  if (!arguments.level.empty()) return level_of(arguments.level, type);
  for (const Level level : type.levels)
    if (level == Level::kCycle) return level;
  return type.levels.front();
}

void exec_here(const Catalogue& catalogue, const ExecArguments& arguments, Progress* progress) {
  run_here(prepare(catalogue, arguments), arguments, progress);
}

ExecOutput exec_program(const Catalogue& catalogue, const ExecArguments& arguments, Progress* progress) {
  const MachineType* type = catalogue.machine(exec_preset(catalogue, arguments).machine);
  if (type->exec) return exec_elf(catalogue, arguments);
  const Prepared prepared = prepare(catalogue, arguments);
  if (arguments.profile)
    throw UserError("--profile", 0, "", "profiles exist for programs that are ELF files only");
  if (!arguments.options.vcd_file.empty() && prepared.level != Level::kClocked)
    throw UserError("--vcd", 0, "", "waveforms exist at --level clocked only");
  const Json json =
      Json::parse(run_in_worker([&] { return run_here(prepared, arguments, progress).dump(); }));
  ExecOutput output;
  output.object = stats::from_json(json.at("run").get<std::string>());
  output.exit_code = json.at("exit_code").get<int>();
  output.dumps = json.at("dumps").get<std::vector<std::vector<std::uint32_t>>>();
  return output;
}

std::string exec_json(const ExecOutput& output) {
  const Json run = Json::parse(stats::to_json(output.object));
  Json json = {{"schema", 1}, {"command", "exec"}};
  for (const char* key : {"machine", "preset", "level", "cycles", "instructions", "clock_hz", "seconds"})
    json[key] = run[key];
  json["exit_code"] = output.exit_code;
  for (const char* key : {"phases", "units", "host", "elaborated", "machine_cycles"}) json[key] = run[key];
  if (!output.profile.empty()) {
    json["profile"] = Json::array();
    for (const ProfileRow& row : output.profile)
      json["profile"].push_back({{"function", row.name}, {"calls", row.calls}, {"cycles", row.cycles}});
  }
  return json.dump(1) + "\n";
}

}  // namespace dendro::study
