#pragma once

#include <cstdint>
#include <string>

#include "sim/base/scratch_file.h"

namespace dendro::study {

/// $XDG_CACHE_HOME/dendro or ~/.cache/dendro; empty: there is none.
std::string cache_root();

/// Large files that programs made, below cache_root(), each by a digest of what it was made from; those that were not used for longest
/// go when all are more than `most_bytes`. A folder that cannot be written means no cache and no error. Processes may share it.
class FileCache {
 public:
  explicit FileCache(std::uintmax_t most_bytes = kMostBytes);

  /// Puts the file into `file`. False when it is not there, or is not what store() wrote under this key.
  bool find(const std::string& key, base::ScratchFile& file) const;
  void store(const std::string& key, const base::ScratchFile& file) const;

 private:
  /// Compressed views of about 80 trees like those of the built-in scenes.
  static constexpr std::uintmax_t kMostBytes = 1'000'000'000;

  void make_room() const;

  std::string folder_;  // empty: no cache
  std::uintmax_t most_bytes_;
};

}  // namespace dendro::study
