#pragma once

#include <string>
#include <vector>

#include "sim/config/document.h"
#include "sim/config/parameters.h"

namespace dendro::config {

/// A machine as presets know it: its name, where its presets are embedded, and their names (the first is the
/// default).
struct MachinePresets {
  std::string name;
  std::string folder;
  std::vector<std::string> presets;
};

/// The resolved parameters of one machine and the name they go by.
struct Preset {
  std::string machine;      ///< "rds3000"
  std::string name;         ///< "fg86", or the file name without folder and ending
  std::string description;  ///< the preset's own line on what it is, or empty
  ParameterSet parameters;
};

/// Loads `NAME`, `NAME:PRESET` or a file ending in .toml (which includes a built-in one, or names its
/// `machine`). Throws UserError with file:line and key for everything that is wrong in the files; `where` is
/// blamed for `name`.
Preset load_preset(const std::string& name, const std::vector<MachinePresets>& machines, const Where& where);

/// Reads one entry `{ value, range | choices, scale, follows, source }`. Throws UserError with file:line and
/// key.
Parameter read_parameter(const std::string& key, const Node& entry);

/// True when the table is one parameter's entry and not a section of several.
bool is_entry(const Node& node);

/// Puts an entry in place of the parameter of the same key. Throws UserError when there is none.
void replace(ParameterSet& parameters, Parameter parameter);

/// The parameter as a preset's entry, on one line. What was overridden is written as its value and source
/// alone.
std::string to_entry(const Parameter& parameter);

}  // namespace dendro::config
