#pragma once

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// Level `function`: the processor's core on plain memory, no caches and no time. Ends when a service stops
/// the machine or after `limit` words.
ProgramResult run_function(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, const MachineOptions& options = {});

}  // namespace dendro::sgi_4d35
