#include "sim/study/workstation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"
#include "sim/scene/image_io.h"
#include "sim/study/exec_elf.h"
#include "sim/study/file_cache.h"

namespace dendro::study {
namespace {

constexpr std::uint32_t kLabel = 0x7002;
constexpr double kPicturesASecond = 15;

std::string untimed(const std::string& program) { return program + " (untimed)"; }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void add_units(std::vector<UnitStats>& sum, const std::vector<UnitStats>& more) {
  for (const UnitStats& unit : more) {
    const auto same = std::find_if(sum.begin(), sum.end(), [&](const UnitStats& u) { return u.unit == unit.unit; });
    if (same == sum.end()) {
      sum.push_back(unit);
      continue;
    }
    DENDRO_CHECK(same->values.size() == unit.values.size(), "{}", unit.unit);
    for (std::size_t i = 0; i < unit.values.size(); ++i) same->values[i].second += unit.values[i].second;
  }
}

}  // namespace

std::string shipped_program(const std::string& name) {
  std::string bytes;
  for (const ProgramImage::Chunk& chunk : embedded_chunks("mips/" + name + ".elf.hex")) {
    DENDRO_CHECK(chunk.physical == bytes.size(), "{} has a gap", name);
    bytes.append(chunk.bytes.begin(), chunk.bytes.end());
  }
  return bytes;
}

ProgramResult run_elf(const MachineType& type, const config::ParameterSet& parameters, Level level, const MachineOptions& options,
                      const std::string& program, const std::string& bytes, const std::vector<std::string>& arguments,
                      MemoryServices& services) {
  const ElfProgram elf = read_elf(bytes, program);
  ExecArguments call;
  call.program = program;
  call.arguments = arguments;
  const ProgramImage image = place_program(elf, call, main_bytes_of(parameters));
  const auto limit = static_cast<std::uint64_t>(options.tick_limit == 0 ? kDefaultTickLimit : options.tick_limit);
  const ProgramResult result = type.exec(parameters, level, image, services, limit, options);
  const std::string wrong = ending_error(services, result, elf, limit);
  if (!wrong.empty()) throw UserError(program, 0, "", wrong);
  if (services.exit_code.value_or(0) != 0) {
    const std::string said = first_line(services.errors);
    throw UserError(program, 0, "", said.empty() ? fmt::format("ended with {}", *services.exit_code) : said);
  }
  return result;
}

ElfWorkstation::ElfWorkstation(const RunRequest& request, const ProgramJob& job, std::string folder, Progress* progress)
    : request_(request), job_(job), folder_(std::move(folder)), progress_(progress) {}

void ElfWorkstation::run(const std::string& program, const std::vector<std::string>& arguments, bool timed) {
  if (progress_ != nullptr) progress_->phase(program);
  MemoryServices services(files_, &large_files_);
  MachineOptions options = request_.options;
  if (recorded_) options.recorder = nullptr;
  recorded_ |= timed;
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult result = run_elf(*request_.type, request_.preset.parameters, timed ? request_.level : Level::kFunction,
                                       options, program, shipped_program(program), arguments, services);
  clock_hz_ = result.clock_hz;
  if (timed) {
    host_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    instructions_ += result.instructions;
    add_units(units_, result.units);
    add(program, result, services.marks);
  } else {
    add_phase(untimed(program), 0);
  }
}

void ElfWorkstation::make(const std::string& program, const std::vector<std::string>& arguments, const std::string& name,
                          const std::string& made_from, const std::function<bool(const base::ScratchFile&)>& good) {
  base::ScratchFile& file = large_file(name);
  // A limit of instructions is there to be run into.
  if (!request_.use_cache || request_.options.tick_limit != 0) return run(program, arguments, false);
  const std::string key = base::sha256(fmt::format("{}\n{}\n{}\n{}\n{}\n{}", executable_digest(), base::sha256(shipped_program(program)),
                                                   fmt::join(arguments, " "), name, main_bytes_of(request_.preset.parameters), made_from));
  const FileCache cache;
  if (cache.find(key, file) && good(file)) {
    add_phase(untimed(program), 0);
    notes_.push_back(fmt::format("{} was not run: its {} are those of an earlier run, from the cache (--no-cache makes them again)", program, name));
    return;
  }
  file.clear();
  run(program, arguments, false);
  cache.store(key, file);
}

void ElfWorkstation::add(const std::string& program, const ProgramResult& result,
                         const std::vector<MemoryServices::Mark>& calls) {
  cycles_ += result.cycles;
  // An estimate is of the whole program.
  if (result.marks.empty() && result.cycles != 0) return add_phase(program, result.cycles);
  std::string phase = program + ".start";
  std::int64_t since = 0;
  // Without times the phases are told all the same.
  std::vector<ProgramMark> marks = result.marks;
  if (marks.empty())
    for (const MemoryServices::Mark& call : calls) marks.push_back({call.number, call.label, 0, 0});
  for (const ProgramMark& mark : marks) {
    const std::string name = mark.number == kLabel ? job_.phase_name(mark.label) : "";
    if (name.empty()) continue;
    add_phase(phase, mark.cycles - since);
    phase = program + "." + name;
    since = mark.cycles;
  }
  add_phase(phase, result.cycles - since);
}

void ElfWorkstation::add_phase(const std::string& name, std::int64_t cycles) {
  const auto same = std::find_if(phases_.begin(), phases_.end(), [&](const Phase& p) { return p.name == name; });
  if (same == phases_.end())
    phases_.push_back({name, cycles, false});
  else
    same->cycles += cycles;
}

void ElfWorkstation::show(int width, int height, const std::vector<std::uint8_t>& rgb) {
  if (folder_.empty()) return;
  std::filesystem::create_directories(folder_ + "/frames");
  pictures_.push_back(fmt::format("{}/frames/{:04}.png", folder_, pictures_.size()));
  scene::write_png(pictures_.back(), {width, height, rgb});
}

void ElfWorkstation::keep(const std::string& name, const base::ScratchFile& file) {
  if (folder_.empty()) return;
  const std::string path = folder_ + "/" + name;
  if (!file.write_to(path)) throw UserError(path, 0, "", "cannot write here: the disk is full or the folder is missing or read-only");
}

void ElfWorkstation::finish() {
  if (pictures_.size() > 1) scene::write_animation(folder_ + "/animation.gif", pictures_, kPicturesASecond);
}

}  // namespace dendro::study
