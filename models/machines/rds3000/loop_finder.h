#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>

#include "sim/base/error.h"

namespace dendro::rds3000 {

/// What the user is told of a program that does not halt: the loop's first and last word index, and the label before it.
inline UserError endless_program(std::int64_t limit, std::uint32_t first, std::uint32_t last,
                                 const std::map<std::uint32_t, std::string>& symbols) {
  std::string near;
  const auto after = symbols.upper_bound(first);
  if (after != symbols.begin()) {
    const auto& [address, name] = *std::prev(after);
    near = address == first ? fmt::format(" ({})", name) : fmt::format(" ({} + {})", name, first - address);
  }
  return UserError(fmt::format("the microprogram still runs after the limit of {} ticks, in the loop 0x{:03x}..0x{:03x}{}",
                               limit, first, last, near));
}

/// The range of addresses a microprogram goes round in once its tick limit is spent.
class LoopFinder {
 public:
  static constexpr int kWords = 4096;

  /// Returns true when enough words were seen.
  bool see(std::uint32_t word_index) {
    first_ = word_index < first_ ? word_index : first_;
    last_ = word_index > last_ ? word_index : last_;
    return ++seen_ >= kWords;
  }

  UserError error(std::int64_t limit, const std::map<std::uint32_t, std::string>& symbols) const {
    return endless_program(limit, first_, last_, symbols);
  }

 private:
  std::uint32_t first_ = UINT32_MAX, last_ = 0;
  int seen_ = 0;
};

}  // namespace dendro::rds3000
