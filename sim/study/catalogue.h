#pragma once

#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "sim/config/preset.h"
#include "sim/study/algorithms.h"

namespace dendro::study {

/// All that a study can run, and where its files are.
struct Catalogue {
  std::vector<MachineType> machines;
  std::vector<Algorithm> algorithms;
  std::string share;  ///< folder of meshes and program images that ship with dendro; may not exist

  const MachineType* machine(const std::string& name) const;
  const Algorithm* algorithm(const std::string& name) const;
  std::vector<config::MachinePresets> presets() const;
};

/// share/dendro beside the executable (build tree) or beside its folder (installed).
std::string share_folder();

/// SHA-256 of the running executable.
std::string executable_digest();

/// "gcc 12.2.0, release, x86_64".
std::string compiler_name();

}  // namespace dendro::study
