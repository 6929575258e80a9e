#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace dendro::zbuffer_views {

/// The big-endian word at byte `at`, which `file` must hold.
inline std::uint32_t word_at(const std::vector<std::uint8_t>& file, std::size_t at) {
  return std::uint32_t{file[at]} << 24 | std::uint32_t{file[at + 1]} << 16 | std::uint32_t{file[at + 2]} << 8 | file[at + 3];
}

/// The structure of 32-bit big-endian words at byte `at`, which `file` must hold whole.
template <class T>
T get(const std::vector<std::uint8_t>& file, std::size_t at) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
  T value{};
  for (std::size_t i = 0; i < sizeof(T); i += 4) {
    const std::uint32_t word = word_at(file, at + i);
    std::memcpy(reinterpret_cast<char*>(&value) + i, &word, 4);
  }
  return value;
}

}  // namespace dendro::zbuffer_views
