#pragma once

#include <vector>

#include "models/machines/machine.h"
#include "models/machines/rds3000/engine.h"

namespace dendro::rds3000 {

/// The run as consecutive phases: while the processor runs, the machine's (named by the last `phase_NAME` mark, "run"
/// before the first); else the host's ("host" before the first). `end` is the run's length in ticks.
std::vector<Phase> timeline(const std::vector<ik11b::HostPhase>& host, std::int64_t tick_ps,
                            const std::vector<RunInterval>& runs, const std::vector<MarkEvent>& marks,
                            std::int64_t end);

}  // namespace dendro::rds3000
