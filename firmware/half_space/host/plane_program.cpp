#include "firmware/half_space/host/plane_program.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

constexpr double kOne = 1 << kFractionBits;
constexpr double kLargestPlain = 32767.0;
/// Half of what 48.16 holds, so that a step beyond the box cannot overflow either.
constexpr double kLargestWide = 35184372088832.0;

std::int64_t to_fixed(double value) { return static_cast<std::int64_t>(std::nearbyint(value * kOne)); }

/// The largest magnitude of start + i·step_x + j·step_y in the box.
template <typename T>
T largest_in(const Box& box, T start, T step_x, T step_y) {
  T largest = 0;
  for (const int i : {0, box.width() - 1})
    for (const int j : {0, box.height() - 1}) {
      const T value = start + i * step_x + j * step_y;
      largest = std::max(largest, value < 0 ? -value : value);
    }
  return largest;
}

std::int64_t clamp_to_word(std::int64_t value) {
  return std::clamp<std::int64_t>(value, INT32_MIN, INT32_MAX);
}

PlaneRecord make_edge_on(double a, double b, double d, const Box& box) {
  PlaneRecord record;
  record.kind = PlaneKind::kEdgeOn;
  const double scale = std::max(std::abs(a), std::abs(b));
  if (scale > 0) a /= scale, b /= scale, d /= scale;
  const double start = a * box.x0 + b * box.y0 + d;
  if (scale > 0 && largest_in(box, start, a, b) <= kLargestPlain) {
    record.start = to_fixed(start), record.step_x = to_fixed(a), record.step_y = to_fixed(b);
  } else {
    // The line is so far away that all of the box lies on one side of it.
    record.start = start > 0 ? to_fixed(1.0) : to_fixed(-1.0);
  }
  return record;
}

std::uint32_t low(std::int64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t high(std::int64_t value) { return static_cast<std::uint32_t>(value >> 32); }

}  // namespace

std::vector<std::uint32_t> PlaneRecord::words() const {
  const std::uint32_t descriptor =
      static_cast<std::uint32_t>(kind) | (wide ? 4u : 0u) | static_cast<std::uint32_t>(face) << 8;
  if (!wide) return {low(start), low(step_x), low(step_y), descriptor};
  return {low(start), low(step_x), low(step_y), descriptor, high(start), high(step_x), high(step_y), 0};
}

std::vector<std::uint32_t> PlaneProgram::record_words() const {
  std::vector<std::uint32_t> all;
  for (const auto* records : {&back, &edge_on, &front})
    for (const PlaneRecord& record : *records) {
      const std::vector<std::uint32_t> words = record.words();
      all.insert(all.end(), words.begin(), words.end());
    }
  return all;
}

std::size_t PlaneProgram::wide_records() const {
  std::size_t count = 0;
  for (const auto* records : {&back, &edge_on, &front})
    count += static_cast<std::size_t>(
        std::count_if(records->begin(), records->end(), [](const PlaneRecord& r) { return r.wide; }));
  return count;
}

PlaneRecord make_record(const ScreenPlane& plane, const Box& box, SteepPolicy steep, double middle_depth) {
  if (plane.kind == PlaneKind::kEdgeOn) return make_edge_on(plane.a, plane.b, plane.d, box);
  DENDRO_CHECK(plane.c != 0);
  const double step_x = -plane.a / plane.c;
  const double step_y = -plane.b / plane.c;
  const double start = -(plane.a * box.x0 + plane.b * box.y0 + plane.d) / plane.c;
  const double reach = std::abs(start) + std::abs(step_x) * box.width() + std::abs(step_y) * box.height();
  // Written so that the infinities and not-a-numbers of a vanishing c land here too.
  if (!(reach < kLargestWide)) return make_edge_on(plane.a, plane.b, plane.d + plane.c * middle_depth, box);

  PlaneRecord record;
  record.kind = plane.kind;
  record.face = plane.face;
  record.start = to_fixed(start), record.step_x = to_fixed(step_x), record.step_y = to_fixed(step_y);
  const auto limit = static_cast<std::int64_t>(kLargestPlain * kOne);
  const bool is_steep = largest_in(box, record.start, record.step_x, record.step_y) > limit ||
                        std::max(std::abs(record.step_x), std::abs(record.step_y)) > limit;
  if (is_steep && steep == SteepPolicy::kWide) record.wide = true;
  if (is_steep && steep == SteepPolicy::kSaturate) {
    record.start = clamp_to_word(record.start);
    record.step_x = clamp_to_word(record.step_x);
    record.step_y = clamp_to_word(record.step_y);
  }
  return record;
}

}  // namespace dendro::half_space
