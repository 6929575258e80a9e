#include "sim/study/exec.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/lib/rds3000/rds_driver.h"
#include "firmware/tools/assembler.h"
#include "firmware/tools/ucode.h"
#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/study/algorithms.h"
#include "sim/study/exec_elf.h"
#include "sim/study/exec_igc.h"
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
  std::optional<IgcExec> igc;  ///< instead of it, on a machine whose host commands its programs
};

Prepared prepare(const Catalogue& catalogue, const ExecArguments& arguments) {
  Prepared p;
  p.preset = exec_preset(catalogue, arguments);
  p.type = catalogue.machine(p.preset.machine);
  DENDRO_CHECK(!p.type->exec, "{} runs ELF files", p.type->name);
  p.level = exec_level(arguments, *p.type);
  if (p.type->name == "pixel-planes") {
    p.igc.emplace(arguments, p.preset.parameters);
    return p;
  }
  if (!arguments.arguments.empty())
    throw UserError("", 0, arguments.arguments.front(),
                    "a microprogram takes no arguments; give it data in its scratch areas");
  p.ucode = load_ucode(arguments, p.preset.parameters);
  if (p.ucode.machine != p.type->name)
    throw UserError(arguments.program, 0, "",
                    "the program is for " + p.ucode.machine + ", not " + p.type->name);
  for (const auto& [address, words] : arguments.dumps)
    if (address >= kScratchWords || words > kScratchWords - address)
      throw UserError("--dump", 0, "", fmt::format("the scratchpad has words 0 to {}", kScratchWords - 1));
  return p;
}

void drive(HostPort& host, const lib::ProgramImage& image) {
  lib::RdsDriver driver(host);
  host.phase("load_program");
  driver.load_program(image);
  driver.start(image.entry);
  host.phase("finish");
  driver.wait();
}

Json run_here(const Prepared& p, const ExecArguments& arguments, Progress* progress) {
  MachineOptions options = arguments.options;
  if (options.tick_limit == 0) options.tick_limit = kDefaultTickLimit;
  const std::map<std::string, std::uint32_t> symbols = p.igc ? p.igc->symbols() : p.ucode.symbols;
  options.marks = marked_words(symbols);
  if (p.igc) options.programs[arguments.program] = options.marks;
  for (const auto& [name, address] : symbols) options.symbols[address] = name;
  if (progress && progress->enabled())
    options.progress = [progress](std::int64_t tick) { progress->tick(tick); };
  const auto start = std::chrono::steady_clock::now();
  const auto machine = p.type->make(p.preset.parameters, p.level, options);
  if (progress) progress->start_run(arguments.program, machine->clock_hz());
  machine->run([&](HostPort& port) {
    ReportingPort reporting(port, progress);
    if (p.igc)
      p.igc->drive(reporting);
    else
      drive(reporting, image_of(p.ucode, arguments.program));
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
  json["exit_code"] = p.igc ? 0 : machine->peek(kScratchpad, 0) & 0xFF;
  json["dumps"] = json["dump_lines"] = Json::array();
  for (const auto& [address, count] : arguments.dumps) {
    Json dump = Json::array();
    for (std::uint32_t n = address; n < address + count; ++n) {
      const std::uint32_t word = p.igc ? 0 : machine->peek(kScratchpad + n, 0);
      if (!p.igc) dump.push_back(word);
      json["dump_lines"].push_back(p.igc ? fmt::format("pixel[{}] = {}", n, p.igc->pixel(*machine, n))
                                         : fmt::format("scratch[{}] = 0x{:08x}", n, word));
    }
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
  if (arguments.gdb_port) throw UserError("--gdb", 0, "", "GDB follows programs that are ELF files only");
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
  output.dump_lines = json.at("dump_lines").get<std::vector<std::string>>();
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
