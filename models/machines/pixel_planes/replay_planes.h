#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/clocked_array_side.h"
#include "sim/trace/replayer.h"

namespace dendro::pixel_planes {

/// What both boundaries do with planes and pixels of a replayed unit.
struct PlaneRecords {
  const Spec& spec;
  trace::Replayer& replayer;

  /// Writes the words of a `set_...` record into a plane; `first`: which of its values is a word's number.
  void set(const trace::Record& record, std::size_t first, Plane& plane) const;
  /// The bit of a record's first value.
  unsigned bit_of(const trace::Record& record) const;
  /// Number of the pixel of a record's first value.
  std::size_t pixel_of(const trace::Record& record) const;
  /// Bits low to low + 31 of that pixel, low being its second value; those beyond the memory are 0.
  void expect_pixel(const trace::Record& record, const std::function<Plane(unsigned bit)>& memory) const;
  void expect_plane(const trace::Record& record, const Plane& plane) const;

  /// "the digest of what" as a word.
  void expect_digest(const trace::Record& record, const char* key, std::uint64_t got, const std::string& what) const;
};

inline bool bit_at(const Plane& plane, std::size_t pixel) { return plane[pixel / 64] >> pixel % 64 & 1; }

/// All planes of a memory.
std::vector<Plane> memory_of(const Spec& spec, const std::function<Plane(unsigned bit)>& plane);

/// Idle clocks behind which neither tree nor pixels change any more: longer than any stream, its leading zeros and levels.
constexpr std::int64_t kSettledClocks = 1024;

}  // namespace dendro::pixel_planes
