#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>

#include "sim/base/error.h"

namespace dendro::rds3000 {

/// The range of addresses a microprogram goes round in once its tick limit is spent, for the message about it.
class LoopFinder {
 public:
  static constexpr int kWords = 4096;

  /// Returns true when enough words were seen.
  bool see(std::uint32_t word_index) {
    first_ = word_index < first_ ? word_index : first_;
    last_ = word_index > last_ ? word_index : last_;
    return ++seen_ >= kWords;
  }

  UserError error(std::int64_t limit, const std::map<std::uint32_t, std::string>& names) const {
    std::string near;
    const auto after = names.upper_bound(last_);
    if (after != names.begin()) near = fmt::format(" (after {})", std::prev(after)->second);
    return UserError(fmt::format("the microprogram still runs after {} ticks, in the loop 0x{:03x}..0x{:03x}{}", limit,
                                 first_, last_, near));
  }

 private:
  std::uint32_t first_ = UINT32_MAX, last_ = 0;
  int seen_ = 0;
};

}  // namespace dendro::rds3000
