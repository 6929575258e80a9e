#pragma once

#include <string>
#include <vector>

#include "sim/study/run.h"

namespace dendro::study {

struct BenchRow {
  std::string machine, level, work;
  double simulated_hz = 0;  ///< ticks with the machine running per host second
  double real_time_factor = 0;
  double host_seconds = 0;
  std::int64_t peak_rss_bytes = 0;
};

/// Host speed of each machine and level on the machine's own scene, the best of `repeats` runs, one at a
/// time. `level` limits it to one level (empty: all).
std::vector<BenchRow> bench(const Catalogue& catalogue, const std::string& level,
                            const std::vector<std::string>& settings, int repeats, Progress* progress);

std::string bench_json(const std::vector<BenchRow>& rows);
std::string bench_text(const std::vector<BenchRow>& rows);

}  // namespace dendro::study
