#pragma once

#include <string>
#include <vector>

#include "sim/study/run.h"

namespace dendro::study {

/// `scene` at `level` with `settings` (KEY=VALUE), in a child process, as `dendro run` does it.
RunOutput run_scene(const Catalogue& all, const std::string& scene, const std::string& level,
                    const std::vector<std::string>& settings, const MachineOptions& options = {});

/// Cycles, instructions, phases, counters of all units and marks are equal, and there are some.
void expect_same_time(const stats::RunObject& a, const stats::RunObject& b);

/// The scenes named in the environment's DENDRO_SCENES, else `quick`.
std::vector<std::string> scenes_or(const std::vector<std::string>& quick);

}  // namespace dendro::study
