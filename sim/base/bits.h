#pragma once

#include <cstdint>

namespace dendro::base {

/// Bits [low, low + width) of `word`, as an unsigned number. width is 1..63.
constexpr std::uint64_t field(std::uint64_t word, unsigned low, unsigned width) {
  return (word >> low) & ((std::uint64_t{1} << width) - 1);
}

/// `word` with bits [low, low + width) replaced by the low bits of `value`.
constexpr std::uint64_t with_field(std::uint64_t word, unsigned low, unsigned width, std::uint64_t value) {
  const std::uint64_t mask = ((std::uint64_t{1} << width) - 1) << low;
  return (word & ~mask) | ((value << low) & mask);
}

/// The low `width` bits of `value` as a two's-complement number. width is 1..32.
constexpr std::int32_t sign_extend(std::uint32_t value, unsigned width) {
  const unsigned up = 32 - width;
  return static_cast<std::int32_t>(value << up) >> up;
}

constexpr std::uint32_t rotate_right(std::uint32_t value, unsigned count) {
  return count == 0 ? value : (value >> count) | (value << (32 - count));
}

}  // namespace dendro::base
