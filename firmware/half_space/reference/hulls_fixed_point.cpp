#include "firmware/half_space/reference/hulls_fixed_point.h"

#include <algorithm>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/stepper.h"

namespace dendro::half_space {
namespace {

/// One hull's share. An empty pixel has 0 in both of the hull's registers and stays so.
class HullPasses {
 public:
  HullPasses(const PlaneProgram& program, FixedPointPicture& picture)
      : program_(program), picture_(picture) {}

  void run() {
    const auto maxdepth = static_cast<std::uint32_t>(program_.maxdepth);
    each_pixel([&](std::uint32_t& word) { set_both(word, 0, maxdepth); });
    for (const PlaneRecord& plane : program_.back)
      scan(plane, [&](std::uint32_t& word, std::int64_t z) {
        const std::uint32_t depth = clamp_depth(z);
        if (depth < back_of(word)) set_both(word, 0, depth);
      });
    for (const PlaneRecord& plane : program_.edge_on)
      scan(plane, [](std::uint32_t& word, std::int64_t side) {
        if (side > 0) set_both(word, 0, 0);
      });
    for (const PlaneRecord& plane : program_.front)
      scan(plane, [&](std::uint32_t& word, std::int64_t z) {
        const std::uint32_t depth = clamp_depth(z), back = back_of(word);
        if (depth > front_of(word)) depth < back ? set_both(word, depth, back) : set_both(word, 0, 0);
      });
    each_pixel([&](std::uint32_t& word) {
      const std::uint32_t nearest = word >> kNearestLow & kHullField;
      const bool covered = front_of(word) < back_of(word) && back_of(word) < maxdepth;
      if (covered && front_of(word) < nearest) word = (word & kHullBoth) | front_of(word) << kNearestLow;
    });
  }

 private:
  static std::uint32_t front_of(std::uint32_t word) { return word & kHullField; }
  static std::uint32_t back_of(std::uint32_t word) { return word >> kHullBackLow & kHullField; }
  static void set_both(std::uint32_t& word, std::uint32_t front, std::uint32_t back) {
    word = (word & ~kHullBoth) | front | back << kHullBackLow;
  }

  std::uint32_t clamp_depth(std::int64_t z) const {
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(z >> kFractionBits, 0, program_.maxdepth));
  }

  std::uint32_t& pixel(int x, int y) {
    return picture_.pixels[static_cast<std::size_t>(y) * picture_.width + x];
  }

  template <typename F>
  void each_pixel(F&& change) {
    for (int y = program_.box.y0; y <= program_.box.y1; ++y)
      for (int x = program_.box.x0; x <= program_.box.x1; ++x) change(pixel(x, y));
  }

  template <typename F>
  void scan(const PlaneRecord& plane, F&& change) {
    step_over(plane, program_.box, program_.steep, [&](int x, int y, std::int64_t value) {
      std::uint32_t& word = pixel(x, y);
      if ((word & kHullBoth) != 0) change(word, value);
    });
  }

  const PlaneProgram& program_;
  FixedPointPicture& picture_;
};

}  // namespace

FixedPointPicture run_hulls_fixed_point(const PreparedHulls& prepared, std::uint32_t before) {
  FixedPointPicture picture{prepared.width, prepared.height, {}};
  const auto clear = static_cast<std::uint32_t>(prepared.maxdepth) << kNearestLow;
  const std::uint32_t nearest_field = kHullField << kNearestLow;
  picture.pixels.assign(static_cast<std::size_t>(prepared.width) * prepared.height,
                        (before & ~nearest_field) | clear);
  for (const Hull& hull : prepared.hulls)
    if (hull.visible) HullPasses(hull.program, picture).run();
  return picture;
}

}  // namespace dendro::half_space
