#include "sim/study/exec_igc.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "firmware/lib/pixel_planes/array_job.h"
#include "firmware/tools/igc_assembler.h"
#include "firmware/tools/ucode.h"
#include "models/parts/igc/igc_isa.h"
#include "sim/base/error.h"
#include "sim/study/algorithms.h"
#include "sim/study/igc_programs.h"

namespace dendro::study {
namespace {

constexpr double kMostStream = 4611686018427387904.0;  // 2^62: what is larger saturates

[[noreturn]] void fail(const std::string& command, const std::string& what) { throw UserError("", 0, command, what); }

std::uint64_t number(const std::string& command, const std::string& what, const std::string& text, std::uint64_t most) {
  const bool hex = text.compare(0, 2, "0x") == 0;
  std::uint64_t value = 0;
  const char *const begin = text.data() + (hex ? 2 : 0), *const end = text.data() + text.size();
  const auto result = std::from_chars(begin, end, value, hex ? 16 : 10);
  if (begin == end || result.ec != std::errc() || result.ptr != end || value > most)
    fail(command, fmt::format("{}: `{}` is not a whole number from 0 to {}", what, text, most));
  return value;
}

float coefficient(const std::string& command, const std::string& text) {
  float value = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    fail(command, fmt::format("`{}` is no finite number of single precision", text));
  return value;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

lib::Expression expression(const std::string& command, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) fail(command, "`" + text + "` is not A,B,C, nor fraction=, guard= or constant=");
  return {coefficient(command, parts[0]), coefficient(command, parts[1]), coefficient(command, parts[2])};
}

}  // namespace

IgcExec::IgcExec(const ExecArguments& arguments, const config::ParameterSet& parameters) {
  const lib::ArraySite site = array_site(parameters);
  ports_ = site.ports, memory_bits_ = site.memory_bits;
  for (const std::string& word : arguments.arguments) commands_.push_back(parse(word));
  const std::string& file = arguments.program;
  const std::string text = arguments.text.empty() ? config::read_text({false, file}, {}) : arguments.text;
  if (std::filesystem::path(file).extension() == ".igc")
    assemble(arguments, text);
  else
    read(file, text);
  programs_.name = file;
  if (programs_.words.size() > igc::kStoreWords)
    throw UserError(file, 0, "", fmt::format("{} words do not fit the control store of {}", programs_.words.size(), igc::kStoreWords));
  check(file);
  for (const auto& [address, count] : arguments.dumps)
    if (const auto pixels = static_cast<std::uint32_t>(site.width * site.height); address >= pixels || count > pixels - address)
      throw UserError("--dump", 0, "", fmt::format("the array has pixels 0 to {}", pixels - 1));
}

void IgcExec::assemble(const ExecArguments& arguments, const std::string& text) {
  tools::IgcOptions options{ports_, memory_bits_, {}};
  for (const Command& command : commands_)
    if (command.is_register) options.registers.emplace(command.name, command.value);
  const tools::IgcImage image = tools::assemble_igc(text, arguments.program, options);
  programs_.words = image.words, programs_.registers = image.registers;
  for (const auto& [name, program] : image.programs)
    programs_.entries[name] = {program.entry, program.phase, program.uses_tree};
}

void IgcExec::read(const std::string& file, const std::string& text) {
  const tools::Ucode ucode = tools::read_ucode(text, file);
  if (ucode.machine != "pixel-planes") throw UserError(file, 0, "", "the program is for " + ucode.machine + ", not pixel-planes");
  programs_.words = ucode.words;
  for (const auto& [name, at] : ucode.symbols) programs_.entries[name] = {at, "run", false};
  for (unsigned n = 0; n < igc::kRegisters; ++n) programs_.registers[fmt::format("r{}", n)] = n;
  for (std::size_t n = 0; n < ucode.words.size(); ++n) {
    const igc::MicroWord word = igc::unpack(ucode.words[n]);
    if (ports_ < 2 && (word.read_b || word.write_b))
      throw UserError(file, 0, "", fmt::format("word {} uses two ports: the array's memory has 1", n));
  }
}

void IgcExec::check_fits(const std::string& word, const Command& command) {
  for (const float value : {command.expression->a, command.expression->b, command.expression->c})
    if (std::abs(std::ldexp(static_cast<double>(value), static_cast<int>(command.fraction))) >= kMostStream)
      fail(word, fmt::format("{} with {} fraction bits is too large for any number of guard bits: a stream has {}", value,
                             command.fraction, igc::kStreamBits));
}

IgcExec::Command IgcExec::parse(const std::string& word) {
  Command command;
  const std::vector<std::string> parts = split(word, ':');
  if (const auto equals = word.find('='); equals != std::string::npos && parts.size() == 1) {
    command.name = word.substr(0, equals);
    command.is_register = true;
    command.value = static_cast<unsigned>(number(word, "value", word.substr(equals + 1), 255));
    return command;
  }
  command.name = parts[0];
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const auto equals = parts[k].find('=');
    const std::string key = parts[k].substr(0, equals), value = equals == std::string::npos ? "" : parts[k].substr(equals + 1);
    if (key == "fraction")
      command.fraction = static_cast<unsigned>(number(word, key, value, 63));
    else if (key == "guard")
      command.guard = static_cast<unsigned>(number(word, key, value, 63));
    else if (key == "constant")
      command.constant = number(word, key, value, UINT64_MAX);
    else
      command.expression = expression(word, parts[k]);
  }
  if (command.expression) check_fits(word, command);
  return command;
}

std::string IgcExec::names() const {
  std::string programs, registers;
  for (const auto& [name, entry] : programs_.entries) programs += (programs.empty() ? "" : ", ") + name;
  for (const auto& [name, at] : programs_.registers) registers += (registers.empty() ? "" : ", ") + name;
  return "programs " + programs + (registers.empty() ? "" : "; registers " + registers);
}

void IgcExec::check(const std::string& file) const {
  if (commands_.empty())
    throw UserError(file, 0, "", "its programs run when they are commanded: give commands behind --, as NAME:A,B,C:fraction=8:guard=2 "
                                 "or REGISTER=VALUE; it has " + names());
  for (const Command& command : commands_) {
    if (command.is_register ? programs_.registers.count(command.name) == 0 : programs_.entries.count(command.name) == 0)
      throw UserError(file, 0, command.name, "is not there: it has " + names());
    if (!command.is_register && programs_.entries.at(command.name).uses_tree && !command.expression)
      throw UserError(file, 0, command.name, "takes an expression: " + command.name + ":A,B,C");
  }
}

std::map<std::string, std::uint32_t> IgcExec::symbols() const {
  std::map<std::string, std::uint32_t> symbols;
  for (const auto& [name, entry] : programs_.entries) symbols["phase_" + entry.phase + "." + name] = entry.at;
  return symbols;
}

void IgcExec::drive(HostPort& host) const {
  lib::IgcDriver driver(host, programs_);
  host.phase("load_program");
  driver.load();
  host.phase("commands");
  for (const Command& command : commands_) {
    if (command.is_register)
      driver.set_register(command.name, command.value);
    else if (command.expression)
      driver.run(command.name, *command.expression, command.fraction, command.guard, command.constant);
    else
      driver.run(command.name, command.constant);
  }
  driver.wait();
}

std::string IgcExec::pixel(const Machine& machine, std::uint32_t pixel) const {
  std::string text;
  for (int low = 0; low < memory_bits_; low += 32) {
    const int digits = (std::min(32, memory_bits_ - low) + 3) / 4;
    text = fmt::format("{:0{}x}", machine.peek(pixel, static_cast<unsigned>(low)), digits) + text;
  }
  return "0x" + text;
}

}  // namespace dendro::study
