#include "sim/app/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "sim/base/error.h"

namespace dendro::app {
namespace {

namespace fs = std::filesystem;

/// Where a path leads, existing or not.
fs::path place_of(const std::string& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? fs::path(path).lexically_normal() : found;
}

}  // namespace

CLI::Validator whole_number(std::int64_t lowest, std::int64_t highest) {
  const auto check = [lowest, highest](std::string& text) -> std::string {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && value >= lowest && value <= highest) return "";
    return fmt::format("`{}` is not an integer in {}..{}", text, lowest, highest);
  };
  return CLI::Validator(check, "");
}

CLI::Validator finite_number(double lowest, bool above) {
  const auto check = [lowest, above](std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool whole = !text.empty() && *end == '\0' && std::isfinite(value);
    if (whole && (above ? value > lowest : value >= lowest)) return "";
    return fmt::format("`{}` is not a finite number {} {}", text, above ? "above" : "of at least", lowest);
  };
  return CLI::Validator(check, "");
}

CLI::Validator some_text() {
  return CLI::Validator(
      [](std::string& text) -> std::string { return text.empty() ? "must not be empty" : ""; }, "");
}

void add_waveform(CLI::App& command, MachineOptions& machine) {
  command.add_option("--vcd", machine.vcd_file, "waveform file, at --level clocked")->check(some_text());
  command.add_option("--vcd-from", machine.vcd_from, "first tick of the waveform")
      ->check(whole_number(0))
      ->needs("--vcd");
  command.add_option("--vcd-to", machine.vcd_to, "first tick that the waveform no longer shows")
      ->check(whole_number(0))
      ->needs("--vcd");
}

void add_pipeline_log(CLI::App& command, MachineOptions& machine) {
  command.add_option("--pipeline", machine.pipeline_file, "pipeline log for Konata, at --level clocked")
      ->check(some_text());
  command.add_option("--pipeline-from", machine.pipeline_from, "first clock of the pipeline log")
      ->check(whole_number(0))
      ->needs("--pipeline");
  command.add_option("--pipeline-to", machine.pipeline_to, "first clock whose fetches it no longer shows")
      ->check(whole_number(0))
      ->needs("--pipeline");
}

void check_window(const MachineOptions& options) {
  if (options.pipeline_from >= options.pipeline_to)
    throw UserError("--pipeline-to", 0, "",
                    fmt::format("the log's clocks {} up to {} are none; --pipeline-from must be the lesser",
                                options.pipeline_from, options.pipeline_to));
  if (options.vcd_from >= options.vcd_to)
    throw UserError("--vcd-to", 0, "",
                    fmt::format("the waveform's ticks {} up to {} are none; --vcd-from must be the lesser",
                                options.vcd_from, options.vcd_to));
}

void refuse_same_file(const std::string& option, const std::string& path, const std::string& other_name,
                      const std::string& other) {
  if (path.empty() || path == "-" || other.empty() || other == "-") return;
  std::error_code error;
  if (place_of(path) == place_of(other) || (fs::equivalent(path, other, error) && !error))
    throw UserError(option, 0, "", fmt::format("{} is the file of {}, too", path, other_name));
}

}  // namespace dendro::app
