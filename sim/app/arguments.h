#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "models/machines/machine.h"

/// Checks of what stands on the command line, made before anything runs.
namespace dendro::app {

/// A decimal integer in lowest..highest; nothing is clamped.
CLI::Validator whole_number(std::int64_t lowest, std::int64_t highest = INT64_MAX);

/// A finite number from `lowest` (which itself is out with `above`) on.
CLI::Validator finite_number(double lowest, bool above);

/// Any text but the empty one.
CLI::Validator some_text();

/// The options --vcd, --vcd-from and --vcd-to.
void add_waveform(CLI::App& command, MachineOptions& machine);

/// The options --pipeline, --pipeline-from and --pipeline-to.
void add_pipeline_log(CLI::App& command, MachineOptions& machine);

/// Throws UserError for a window of a waveform or pipeline log that shows no tick.
void check_window(const MachineOptions& options);

/// Throws UserError at `option` when both paths name one file, through whatever links or folders. An empty
/// path or "-" names none.
void refuse_same_file(const std::string& option, const std::string& path, const std::string& other_name,
                      const std::string& other);

}  // namespace dendro::app
