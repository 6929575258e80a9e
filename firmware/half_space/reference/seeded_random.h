#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/base/check.h"

namespace dendro::half_space {

/// Random numbers as FG86 6.1 has them: multiplicative, mod 2^16, a new seed every 512 numbers, the seed
/// being the first of them.
class SeededRandom {
 public:
  explicit SeededRandom(const std::vector<std::uint32_t>& seeds) : seeds_(seeds) {}

  /// 0..65535.
  std::uint32_t next() {
    if (count_ % 512 == 0) {
      DENDRO_CHECK(count_ / 512 < seeds_.size(), "{} seeds", seeds_.size());
      state_ = seeds_[count_ / 512] & 0xFFFF;
    } else {
      state_ = state_ * 25173 % 65536;
    }
    ++count_;
    return state_;
  }

  /// The same as a two's complement number.
  std::int32_t next_signed() {
    const auto value = static_cast<std::int32_t>(next());
    return value < 32768 ? value : value - 65536;
  }

 private:
  const std::vector<std::uint32_t>& seeds_;
  std::size_t count_ = 0;
  std::uint32_t state_ = 0;
};

}  // namespace dendro::half_space
