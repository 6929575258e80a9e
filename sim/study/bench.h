#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/study/run.h"

namespace dendro::study {

struct BenchRow {
  std::string machine, level, work;
  double simulated_hz = 0;  ///< ticks with the machine running per host second
  double real_time_factor = 0;
  double host_seconds = 0;  ///< for those ticks; of programs, only those that the run times
  std::int64_t peak_rss_bytes = 0;
  double ticks = 0;  ///< at `function`, instructions
  std::optional<double> times_cycle,
      tick_error;  ///< at `estimate`: speed against `cycle`, ticks against its ticks less 1
};

/// Host speed of each machine and level on the machine's own scene, the best of `repeats` runs, one at a
/// time. `machine` limits it to one machine, `level` to one level (empty: all). What a scene makes before the
/// programs that count is made once, into a folder among the system's temporary ones that is removed again.
/// Throws UserError for a machine or a level that there is not.
std::vector<BenchRow> bench(const Catalogue& catalogue, const std::string& machine, const std::string& level,
                            const std::vector<std::string>& settings, int repeats, Progress* progress);

std::string bench_json(const std::vector<BenchRow>& rows);
std::string bench_text(const std::vector<BenchRow>& rows);

}  // namespace dendro::study
