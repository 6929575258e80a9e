#pragma once

#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/array_job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/tools/igc_assembler.h"
#include "sim/config/parameters.h"

namespace dendro::study {

/// The micro-programs of embedded sources, one behind the other in the control store; a program replaces one of the same name
/// before it. Throws UserError.
lib::IgcPrograms igc_programs(const std::vector<std::string>& paths, const tools::IgcOptions& options);

/// The pixel array of a machine with these parameters. Throws UserError.
lib::ArraySite array_site(const config::ParameterSet& parameters);

}  // namespace dendro::study
