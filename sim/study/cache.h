#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/study/interval.h"

namespace dendro::study {

/// Finished runs on disk, below $XDG_CACHE_HOME/dendro or ~/.cache/dendro. A folder that cannot be written
/// means no cache and no error.
class RunCache {
 public:
  RunCache();

  /// Digest of everything that a run depends on: this executable (its firmware sources are inside), all
  /// parameters' values, level, what is counted and compared, and the scene with its input files as they are
  /// now.
  static std::string key(const RunRequest& request);

  std::optional<std::string> find(const std::string& key) const;
  void store(const std::string& key, const std::string& bytes) const;

 private:
  std::string folder_;  // empty: no cache
};

/// What becomes of the pictures of worker_runs().
enum class Pictures {
  kNone,     ///< not made
  kCompared  ///< compared with the reference and thrown away: the run object has its error report
};

/// Makes runs in `jobs` worker processes, with a progress line. With a cache only what is not in it, and each
/// run is stored when it is finished; errors are not stored.
RunMaker worker_runs(int jobs, Progress* progress, const std::string& name, const RunCache* cache = nullptr,
                     Pictures pictures = Pictures::kNone);

}  // namespace dendro::study
