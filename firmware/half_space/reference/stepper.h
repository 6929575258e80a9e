#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/half_space/host/plane_program.h"

namespace dendro::half_space {

/// The adder that steps a record's depth: 48.16 in 64 bits for wide records, else 16.16 in one word.
class Stepper {
 public:
  Stepper(const PlaneRecord& record, SteepPolicy steep)
      : wide_(record.wide), saturate_(steep == SteepPolicy::kSaturate) {}

  std::int64_t add(std::int64_t a, std::int64_t b) const {
    const std::int64_t sum = a + b;
    if (wide_) return sum;
    if (saturate_) return std::clamp<std::int64_t>(sum, INT32_MIN, INT32_MAX);
    return word(sum);
  }
  /// A record's field as the adder sees it.
  std::int64_t load(std::int64_t value) const { return wide_ ? value : word(value); }

 private:
  static std::int64_t word(std::int64_t value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
  }

  bool wide_;
  bool saturate_;
};

/// Calls visit(x, y, value) for every pixel of the box with the record's accumulator there.
template <typename Visit>
void step_over(const PlaneRecord& plane, const Box& box, SteepPolicy steep, Visit&& visit) {
  const Stepper step(plane, steep);
  const std::int64_t step_x = step.load(plane.step_x), step_y = step.load(plane.step_y);
  std::int64_t line = step.load(plane.start);
  for (int y = box.y0; y <= box.y1; ++y, line = step.add(line, step_y)) {
    std::int64_t value = line;
    for (int x = box.x0; x <= box.x1; ++x, value = step.add(value, step_x)) visit(x, y, value);
  }
}

}  // namespace dendro::half_space
