#include "sim/study/exec_elf.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>

#include "models/parts/r3000/r3000_isa.h"
#include "sim/base/check.h"
#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/study/algorithms.h"
#include "sim/study/elf.h"
#include "sim/study/exec_callers.h"
#include "sim/study/exec_services.h"
#include "sim/study/gdb_socket.h"
#include "sim/study/worker.h"

namespace dendro::study {
namespace {

constexpr std::uint32_t kFirstPage = 0x00400000, kPageBytes = 4096, kKseg0 = 0x80000000,
                        kPhysical = 0x1FFFFFFF;
/// Where monitor, program and stack still fit, and what the program's part of kuseg and kseg0 can hold.
constexpr std::int64_t kLeastMemory = 32 << 20, kMostMemory = 256 << 20;
constexpr std::uint32_t kStackBytes = DENDRO_STACK_BYTES;
constexpr const char* kMonitor = "mips/monitor.hex";

}  // namespace

std::vector<ProgramImage::Chunk> embedded_chunks(const std::string& path) {
  const std::string* text = base::embedded_file(path);
  DENDRO_CHECK(text != nullptr, "{} is not embedded", path);
  std::vector<ProgramImage::Chunk> chunks;
  const char* at = text->c_str();
  for (char* end = nullptr; *at != 0; at = end) {
    while (*at == ' ' || *at == '\n' || *at == '\r') ++at;
    if (*at == 0) break;
    const bool address = *at == '@';
    const auto value = static_cast<std::uint32_t>(std::strtoul(at + address, &end, 16));
    DENDRO_CHECK(end != at + address, "{} has no number at byte {}", path, at - text->c_str());
    if (address)
      chunks.push_back({value & kPhysical, {}});
    else
      chunks.back().bytes.push_back(static_cast<std::uint8_t>(value));
  }
  return chunks;
}

namespace {

std::uint32_t monitor_start() { return kKseg0 + DENDRO_MONITOR_START; }

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t word) {
  for (unsigned i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (24 - 8 * i));
}

/// argc, argv, no environment, no auxiliary vector, as Linux leaves them; `top` is the address behind the
/// stack.
std::vector<std::uint8_t> first_stack(const std::vector<std::string>& arguments, std::uint32_t top) {
  std::size_t text = 0;
  for (const std::string& argument : arguments) text += argument.size() + 1;
  const std::size_t words = 1 + arguments.size() + 1 + 1 + 2;
  std::vector<std::uint8_t> bytes((words * 4 + text + 7) & ~std::size_t{7});
  const auto base = static_cast<std::uint32_t>(top - bytes.size());
  put(bytes, 0, static_cast<std::uint32_t>(arguments.size()));
  std::size_t at = words * 4;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    put(bytes, 4 * (i + 1), base + static_cast<std::uint32_t>(at));
    std::copy(arguments[i].begin(), arguments[i].end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    at += arguments[i].size() + 1;
  }
  return bytes;
}

}  // namespace

ProgramImage place_program(const ElfProgram& program, const ExecArguments& arguments,
                           std::uint32_t main_bytes) {
  const std::string& path = arguments.program;
  ProgramImage image;
  image.chunks = embedded_chunks(kMonitor);
  image.start = monitor_start();
  image.program.entry = program.entry;
  image.program.mapped = program.entry < kKseg0;
  const std::uint32_t base = image.program.mapped ? 0 : kKseg0, lowest = base + kFirstPage,
                      highest = base + main_bytes - kStackBytes;
  std::uint32_t end = lowest;
  for (const ElfProgram::Segment& segment : program.segments) {
    if (segment.address < lowest || segment.address > highest ||
        segment.bytes.size() > highest - segment.address)
      throw UserError(path, 0, "",
                      fmt::format("{} bytes at 0x{:08x} lie outside of 0x{:08x} to 0x{:08x}",
                                  segment.bytes.size(), segment.address, lowest, highest));
    image.chunks.push_back({segment.address & kPhysical, segment.bytes});
    end = std::max(end, static_cast<std::uint32_t>(segment.address + segment.bytes.size()));
  }
  image.program.first_break = (end + kPageBytes - 1) & ~(kPageBytes - 1);
  std::vector<std::string> words = {path};
  words.insert(words.end(), arguments.arguments.begin(), arguments.arguments.end());
  // The last page stays empty: what runs over the stack's end does not land in nothing.
  const std::uint32_t top = (image.program.mapped ? kKseg0 : kKseg0 + main_bytes) - kPageBytes;
  const std::vector<std::uint8_t> stack = first_stack(words, top);
  if (stack.size() > kStackBytes / 4) throw UserError("the arguments are too long for the program's stack");
  image.program.stack = static_cast<std::uint32_t>(top - stack.size());
  image.chunks.push_back({static_cast<std::uint32_t>(main_bytes - kPageBytes - stack.size()), stack});
  return image;
}

namespace {

std::string fault_text(const CallServices::Fault& fault, const ElfProgram& program) {
  const unsigned code = fault.cause >> 2 & 31;
  const bool slot = fault.cause & r3000::kCauseBd;
  std::string text = fmt::format("the processor raised {} at {}{}", r3000::exception_name(code),
                                 program.place(fault.epc), slot ? " or its delay slot" : "");
  if (code >= r3000::kMod && code <= r3000::kAdes) text += fmt::format(", address 0x{:08x}", fault.address);
  if (code == r3000::kInt) text += fmt::format(", R3010 control 0x{:08x}", fault.fpu);
  if (code == r3000::kCpu) text += fmt::format(", coprocessor {}", fault.cause >> 28 & 3);
  return text + fmt::format(", Cause 0x{:08x}", fault.cause);
}

/// The R3010's interrupt has the monitor use the registers for itself.
std::string callers_of(const CallServices::Fault& fault, const ElfProgram& program, const ProgramResult& result) {
  if ((fault.cause >> 2 & 31) == r3000::kInt) return "";
  return callers_text(program, result, fault.epc + (fault.cause & r3000::kCauseBd ? 4 : 0));
}

std::int64_t peak_rss() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

}  // namespace

std::uint32_t main_bytes_of(const config::ParameterSet& parameters) {
  const std::int64_t bytes = integer_of(parameters, "memory.main_bytes");
  if (bytes < kLeastMemory || bytes > kMostMemory)
    throw UserError("", 0, "memory.main_bytes",
                    fmt::format("is {}, allowed are {} to {}", bytes, kLeastMemory, kMostMemory));
  return static_cast<std::uint32_t>(bytes);
}

std::string ending_error(const CallServices& services, const ProgramResult& result, const ElfProgram& program,
                         std::uint64_t limit) {
  if (services.fault) return fault_text(*services.fault, program) + callers_of(*services.fault, program, result);
  if (result.stopped) return "";
  return fmt::format("did not end within {} instructions (--limit); it was at {}{}", limit, program.place(result.pc),
                     callers_text(program, result, result.pc));
}

void record_elf(const Catalogue& catalogue, const ExecArguments& arguments) {
  const config::Preset preset = exec_preset(catalogue, arguments);
  const ElfProgram program = read_elf(config::read_text({false, arguments.program}, {}), arguments.program);
  const ProgramImage image = place_program(program, arguments, main_bytes_of(preset.parameters));
  const auto limit = static_cast<std::uint64_t>(
      arguments.options.tick_limit == 0 ? kDefaultTickLimit : arguments.options.tick_limit);
  HostServices services(false);
  const ProgramResult result = catalogue.machine(preset.machine)
                                   ->exec(preset.parameters, Level::kCycle, image, services, limit, arguments.options);
  const std::string wrong = ending_error(services, result, program, limit);
  if (!wrong.empty()) throw UserError(arguments.program, 0, "", wrong);
}

ExecOutput exec_elf(const Catalogue& catalogue, const ExecArguments& arguments) {
  const config::Preset preset = exec_preset(catalogue, arguments);
  const MachineType& type = *catalogue.machine(preset.machine);
  const Level level = exec_level(arguments, type);
  if (!arguments.dumps.empty())
    throw UserError("--dump", 0, "", type.name + " has no scratchpad; let the program print");
  if (!arguments.options.vcd_file.empty() && level != Level::kClocked)
    throw UserError("--vcd", 0, "", "waveforms exist at --level clocked only");
  if (arguments.profile && level != Level::kCycle)
    throw UserError("--profile", 0, "", "profiles exist at --level cycle only");
  if (!arguments.options.pipeline_file.empty() && level != Level::kClocked)
    throw UserError("--pipeline", 0, "", "pipeline logs exist at --level clocked only");
  const ElfProgram program = read_elf(config::read_text({false, arguments.program}, {}), arguments.program);
  const std::uint32_t main_bytes = main_bytes_of(preset.parameters);
  const ProgramImage image = place_program(program, arguments, main_bytes);
  const auto limit = arguments.options.tick_limit == 0 ? kDefaultTickLimit : arguments.options.tick_limit;
  HostServices services;
  std::unique_ptr<GdbSocket> gdb;
  if (arguments.gdb_port) {
    gdb = std::make_unique<GdbSocket>(*arguments.gdb_port, [&services] { return services.exit_code; },
                                      check_interrupt);
    fmt::print(stderr, "waiting for GDB on 127.0.0.1:{}\n", gdb->port());
  }
  const auto start = std::chrono::steady_clock::now();
  MachineOptions options = arguments.options;
  std::map<std::uint32_t, WordClocks> words;
  if (arguments.profile) options.word_clocks = &words;
  options.debugger = gdb.get();
  options.progress = [](std::int64_t) { check_interrupt(); };
  const ProgramResult result =
      type.exec(preset.parameters, level, image, services, static_cast<std::uint64_t>(limit), options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (gdb && gdb->killed()) throw UserError(arguments.program, 0, "", "GDB ended the program");
  const std::string wrong = ending_error(services, result, program, static_cast<std::uint64_t>(limit));
  if (!wrong.empty()) throw UserError(arguments.program, 0, "", wrong);
  ExecOutput output;
  output.prints_output = true;
  output.exit_code = services.exit_code.value_or(0);
  stats::RunObject& object = output.object;
  object.machine = type.name;
  object.preset = preset.name;
  object.level = level_name(level);
  object.clock_hz = result.clock_hz;
  object.cycles = object.machine_cycles = result.cycles;
  object.seconds = static_cast<double>(result.cycles) / result.clock_hz;
  object.elaborated = {type.name};
  object.instructions = result.instructions;
  for (const UnitStats& unit : result.units) object.units.push_back({unit.unit, unit.values});
  if (level == Level::kEstimate) stats::add_sampling_interval(object);
  for (const Phase& phase : phases_of(result.marks, result.cycles))
    object.phases.push_back(
        {phase.name, phase.cycles, static_cast<double>(phase.cycles) / result.clock_hz, phase.on_host});
  if (object.has_time() && object.phases.empty())
    object.phases.push_back({"program", result.cycles, object.seconds, false});
  if (arguments.profile) output.profile = profile_of(words, program);
  object.host.seconds = seconds;
  object.host.simulated_hz = static_cast<double>(result.cycles) / std::max(seconds, 1e-9);
  object.host.real_time_factor = object.seconds / std::max(seconds, 1e-9);
  object.host.peak_rss_bytes = peak_rss();
  const auto assumptions = preset.parameters.assumptions();
  object.assumptions.assign(assumptions.begin(), assumptions.end());
  return output;
}

}  // namespace dendro::study
