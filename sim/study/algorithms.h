#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/job.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "firmware/tools/gia_include.h"
#include "firmware/tools/ucode.h"
#include "models/machines/machine.h"
#include "sim/config/parameters.h"
#include "sim/scene/scene.h"

namespace dendro::study {

/// One entry of the list of algorithms.
struct Algorithm {
  std::string name;                   ///< "half_space": the scene's `algorithm` and the name of its own table
  std::string summary;                ///< one line
  std::vector<std::string> machines;  ///< names of machines that have firmware for it
  std::string folder;                 ///< "firmware/half_space"; its scenes lie in scenes/ below
  /// Prepares a scene for a machine. Throws UserError for what the algorithm or its firmware cannot do.
  std::function<std::unique_ptr<Job>(const scene::Scene&, const MachineType&, const config::ParameterSet&)>
      make;
  std::vector<std::string> option_keys = {};  ///< every key that its job reads from its own table
  std::vector<std::string> path_keys = {};    ///< those among them that name a file
};

/// The one list of algorithms.
const std::vector<Algorithm>& algorithms();

/// An integer parameter of a machine. Throws UserError naming the key when it is missing or of another type.
std::int64_t integer_of(const config::ParameterSet& parameters, const std::string& key);

/// Finds an included file among the microcode that ships with dendro, by its path from the repository's root.
std::optional<std::string> shipped_include(const std::string& path);

/// The same for a user's source: beside it first.
tools::IncludeReader include_beside(const std::string& source);

/// The half-space program as it is assembled for a machine with these parameters. Throws UserError.
tools::Ucode half_space_program(const config::ParameterSet& parameters);

/// The microprogram of an embedded source, assembled for a machine with these parameters. Throws UserError.
lib::ProgramImage program_image(const std::string& path, const config::ParameterSet& parameters);

/// The program with three registers as it is assembled for a machine with these parameters.
tools::Ucode hulls_program(const config::ParameterSet& parameters);

/// A microprogram that ships with dendro, in all its packings.
struct Firmware {
  std::string name;  ///< "half_space"
  std::string machine;
  std::string path;    ///< of its source below the repository's root
  std::string pack;    ///< "none" or "full"; pixel arrays: "1p" or "2p", the ports it is for
  std::string sha256;  ///< of its .ucode text
  std::size_t words = 0;
};

/// Everything `dendro firmware` lists.
std::vector<Firmware> firmware_list();

}  // namespace dendro::study
