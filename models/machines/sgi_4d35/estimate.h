#pragma once

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// How level `estimate` samples: in every period of words one window, at a place that the seed draws. Before it as many
/// words as `lead_in` run at level `cycle` too, so that units and write buffer are as they would be.
struct Sampling {
  std::uint64_t period = 16384, lead_in = 128, window = 384;
  std::uint64_t exact = 1 << 19;  ///< words at the beginning that are not sampled
  std::uint64_t seed = 1;
};

/// Level `estimate`: function, with the caches kept up to date, and windows of level `cycle`. The result's cycles are
/// the windows' mean times the words; the unit sgi_4d35.estimate has the 99.7 % interval `low` to `high`, which holds
/// for the sampling alone, and the number of windows. The words under a debugger and `exact` behind them are not sampled.
ProgramResult run_estimate(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, const MachineOptions& options = {}, const Sampling& sampling = {});

}  // namespace dendro::sgi_4d35
