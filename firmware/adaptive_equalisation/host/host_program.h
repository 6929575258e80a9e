#pragma once

#include "firmware/adaptive_equalisation/host/prepare.h"
#include "models/parts/host/host_port.h"

namespace dendro::adaptive_equalisation {

// Instructions of the host, counted from the loops of run().
constexpr std::uint64_t kInstructionsGrey = 3;   // load, count, test for the end
constexpr std::uint64_t kInstructionsBound = 2 + 2 + 2;  // two sums, two tests against the border, two numbers made floating

/// Loads the picture, ranks every pixel and shows the ranks.
void run(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site);

}  // namespace dendro::adaptive_equalisation
