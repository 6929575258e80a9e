#pragma once

#include "models/machines/sgi_4d35/run_options.h"

namespace dendro::sgi_4d35 {

/// Level `cycle`: the core and its pipeline's time, exact to the last clock and counter. Ends as run_function().
ProgramResult run_cycle(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                        std::uint64_t limit, const RunOptions& options);

}  // namespace dendro::sgi_4d35
