#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/stats/database.h"
#include "sim/study/run.h"

namespace dendro::study {

/// One finished run as it lies in the database.
struct SweepRow {
  std::string refused;  ///< why machine or program would not run so; empty: it ran
  std::string scene, machine, preset, level, git, image_sha256;
  std::uint64_t seed = 0;
  std::map<std::string, double> figures;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< key, value as TOML, in the preset's order
};

/// The runs of all sweeps into one folder: `results.sqlite`. A run is found by RunCache::key(), so a changed program,
/// parameter or input file is another run. Locked against other writers while it is open.
class SweepResults {
 public:
  explicit SweepResults(const std::string& path);

  bool has(const std::string& key);
  std::optional<SweepRow> find(const std::string& key);
  /// Stores one run whole or not at all. `settings` is what the study put in.
  void store(const std::string& key, const SweepRow& row, const std::vector<std::string>& settings);

 private:
  stats::Database database_;
};

/// The row of a run that was made.
SweepRow row_of(const RunRequest& request, const RunOutput& output, const std::string& git);
/// The row of a run that was refused.
SweepRow refused_row(const RunRequest& request, const std::string& why, const std::string& git);

/// The commit of the repository around the working directory, "-dirty" behind it when files differ; "none" outside of
/// any.
std::string git_state();

}  // namespace dendro::study
