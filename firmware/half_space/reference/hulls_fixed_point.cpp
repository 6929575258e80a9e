#include "firmware/half_space/reference/hulls_fixed_point.h"

#include <algorithm>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/stepper.h"

namespace dendro::half_space {
namespace {

std::uint32_t front_of(std::uint32_t word) { return word & kHullField; }
std::uint32_t back_of(std::uint32_t word) { return word >> kHullBackLow & kHullField; }
std::uint32_t nearest_of(std::uint32_t word) { return word >> kNearestLow & kHullField; }

void set_both(std::uint32_t& word, std::uint32_t front, std::uint32_t back) {
  word = (word & ~kHullBoth) | front | back << kHullBackLow;
}

void set_nearest(std::uint32_t& word, std::uint32_t nearest) {
  word = (word & ~(kHullField << kNearestLow)) | nearest << kNearestLow;
}

/// An empty pixel has 0 in both of the hull's registers and stays so.
template <typename F>
void scan(const PlaneProgram& program, const PlaneRecord& plane, FixedPointPicture& picture, F&& change) {
  step_over(plane, program.box, program.steep, [&](int x, int y, std::int64_t value) {
    std::uint32_t& word = picture.pixels[static_cast<std::size_t>(y) * picture.width + x];
    if ((word & kHullBoth) != 0) change(word, value);
  });
}

}  // namespace

HullsModel::HullsModel(int width, int height, int maxdepth, std::uint32_t before)
    : picture_{width, height, std::vector<std::uint32_t>(static_cast<std::size_t>(width) * height, before)},
      maxdepth_(static_cast<std::uint32_t>(maxdepth)) {}

template <typename F>
void HullsModel::each_pixel(const Box& box, F&& change) {
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x)
      change(picture_.pixels[static_cast<std::size_t>(y) * picture_.width + x]);
}

template <typename F>
void HullsModel::each_covered(const Box& box, F&& change) {
  each_pixel(box, [&](std::uint32_t& word) {
    const bool covered = (word & kHullBoth) != 0 && back_of(word) < maxdepth_;
    if (covered && front_of(word) < nearest_of(word)) change(word);
  });
}

void HullsModel::clear() {
  each_pixel({0, 0, picture_.width - 1, picture_.height - 1},
             [&](std::uint32_t& word) { set_nearest(word, maxdepth_); });
}

void HullsModel::passes(const PlaneProgram& program) {
  const auto depth_of = [&](std::int64_t z) {
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(z >> kFractionBits, 0, program.maxdepth));
  };
  each_pixel(program.box, [&](std::uint32_t& word) { set_both(word, 0, maxdepth_); });
  for (const PlaneRecord& plane : program.back)
    scan(program, plane, picture_, [&](std::uint32_t& word, std::int64_t z) {
      if (depth_of(z) < back_of(word)) set_both(word, 0, depth_of(z));
    });
  for (const PlaneRecord& plane : program.edge_on)
    scan(program, plane, picture_, [](std::uint32_t& word, std::int64_t side) {
      if (side > 0) set_both(word, 0, 0);
    });
  for (const PlaneRecord& plane : program.front)
    scan(program, plane, picture_, [&](std::uint32_t& word, std::int64_t z) {
      const std::uint32_t depth = depth_of(z), back = back_of(word);
      if (depth > front_of(word)) depth < back ? set_both(word, depth, back) : set_both(word, 0, 0);
    });
}

void HullsModel::merge(const Box& box) {
  each_covered(box, [](std::uint32_t& word) { set_nearest(word, front_of(word)); });
}

void HullsModel::merge_trunk(const Box& box) {
  each_covered(box, [](std::uint32_t& word) { set_nearest(word, kTrunkMark); });
}

void HullsModel::paint(const Trapezium& trapezium) {
  const std::vector<std::uint32_t> words = trapezium.words();
  const auto number = [&](int i) { return static_cast<std::int64_t>(static_cast<std::int32_t>(words[i])); };
  const Box& box = trapezium.box;
  for (int y = box.y0; y <= box.y1; ++y) {
    const std::int64_t left = number(0) + (y - box.y0) * number(2);
    const std::int64_t right = number(1) + (y - box.y0) * number(3);
    for (int x = box.x0; x <= box.x1; ++x) {
      std::uint32_t& word = picture_.pixels[static_cast<std::size_t>(y) * picture_.width + x];
      const std::int64_t at = std::int64_t{x} << kFractionBits;
      if (at >= left && at <= right && nearest_of(word) == maxdepth_) set_nearest(word, kTrunkMark);
    }
  }
}

FixedPointPicture run_hulls_fixed_point(const PreparedHulls& prepared, std::uint32_t before,
                                        const BetweenPassesAndMerge& between) {
  HullsModel model(prepared.width, prepared.height, prepared.maxdepth, before);
  model.clear();
  for (const Hull& hull : prepared.hulls) {
    if (!hull.visible) continue;
    model.passes(hull.program);
    if (between) between(hull, model.picture());
    model.merge(hull.program.box);
  }
  for (const Trunk& trunk : prepared.trunks) {
    if (!trunk.visible()) continue;
    if (trunk.painter) {
      model.paint(trunk.trapezium);
      continue;
    }
    model.passes(trunk.hull.program);
    model.merge_trunk(trunk.hull.program.box);
  }
  return model.picture();
}

}  // namespace dendro::half_space
