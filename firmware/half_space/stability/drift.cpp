#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "firmware/half_space/stability/support.h"

// N-A2. start, step_x and step_y are each off by up to half (rounded) or one (truncated) 2^-16, so that the
// value i pixels and j lines further is off by at most i + j + 1 of those.

namespace dendro::half_space {
namespace {

using stability::Bound;

struct Hull {
  const char* solid;  ///< empty: a random hull
  int side;
  double height;
};

constexpr Hull kHulls[] = {
    {"icosahedron", 512, 2.6}, {"dodecahedron", 512, 2.4}, {"", 512, 3.0}, {"icosahedron", 300, 4.0}};

/// Planes drawn one by one on the machine in the first hull.
constexpr int kAlone = 12;

struct Drift {
  double largest = 0;  ///< units of depth
  double share = 0;    ///< of the pixel's own bound
  std::string where, worst;

  void see(double error, double bound, const std::function<std::string()>& place) {
    if (error > largest) largest = error, where = place();
    if (error / bound > share) share = error / bound, worst = place();
  }
};

/// Steps the record over the box as the passes do and compares every pixel.
void follow(const PlaneRecord& record, std::size_t index, Enclosure& enclosure, const Box& box,
            const std::string& hull, Drift& drift) {
  std::int64_t line = record.start;
  for (int y = box.y0; y <= box.y1; ++y, line += record.step_y) {
    std::int64_t value = line;
    for (int x = box.x0; x <= box.x1; ++x, value += record.step_x) {
      const std::int64_t exact = enclosure.plane(index).floor32(x, y);
      const double error = static_cast<double>(std::abs(value * 65536 - exact)) * 0x1p-32;
      const double bound = static_cast<double>(enclosure.slack(index, x, y)) * 0x1p-32;
      drift.see(error, bound, [&] {
        return fmt::format("{}: plane {}, pixel ({}, {}), step {} of line {}: off by {:.6f}, allowed {:.6f}",
                           hull, index + 1, x, y, x - box.x0, y - box.y0, error, bound);
      });
    }
  }
}

PlaneRecord record_of(const Prepared& prepared, std::size_t index, Enclosure& enclosure, Rounding rounding) {
  const PlaneProgram& program = prepared.program;
  return rounding == Rounding::kTruncated
             ? enclosure.plane(index).truncated(program.box)
             : make_record(prepared.screen[index], program.box, SteepPolicy::kWide, program.maxdepth / 2.0);
}

/// The plane as the only front plane, before a back plane at the largest depth but one.
Prepared alone(const Prepared& prepared, std::size_t index, PlaneRecord record) {
  const PlaneProgram& program = prepared.program;
  ScreenPlane plane = prepared.screen[index];
  if (plane.c > 0) plane.a = -plane.a, plane.b = -plane.b, plane.c = -plane.c, plane.d = -plane.d;
  Prepared result = from_screen({{0, 0, 1, 1.0 - program.maxdepth}, plane}, program.width, program.height);
  record.kind = PlaneKind::kFront;
  record.face = 1;
  record.wide = result.program.front.front().wide;
  result.program.front = {record};
  return result;
}

struct Totals {
  Drift drift;
  Tally machine, alone;
  double bound = 0;
};

void measure(const stability::Rig& rig, const Hull& hull, const scene::Object& object, Rounding rounding,
             bool each, Totals& totals) {
  const std::string name = fmt::format("{} {}", *hull.solid ? hull.solid : "random hull", hull.side);
  Prepared prepared = prepare(looking_at(object, hull.side, hull.height));
  PlaneProgram& program = prepared.program;
  Enclosure enclosure(prepared, rounding);
  totals.bound = std::max(totals.bound, (2 * hull.side - 1) * static_cast<double>(rounding) * 0x1p-17);
  program.back.clear(), program.front.clear();
  int drawn = 0;
  for (std::size_t k = 0; k < prepared.screen.size(); ++k) {
    if (prepared.screen[k].kind == PlaneKind::kEdgeOn) continue;
    PlaneRecord record = record_of(prepared, k, enclosure, rounding);
    if (record.kind == PlaneKind::kEdgeOn) continue;
    record.wide = make_record(prepared.screen[k], program.box, SteepPolicy::kWide, 0).wide;
    follow(record, k, enclosure, program.box, name, totals.drift);
    (record.kind == PlaneKind::kBack ? program.back : program.front).push_back(record);
    if (!each || drawn++ >= kAlone) continue;
    const Prepared one = alone(prepared, k, record);
    Enclosure around(one, rounding);
    compare_enclosed(draw(rig, one), around, program.width, fmt::format("{} plane {} alone", name, k + 1),
                     totals.alone);
  }
  compare_enclosed(draw(rig, prepared), enclosure, program.width, name, totals.machine);
}

}  // namespace

stability::Result depth_drift(const stability::Rig& rig, std::uint64_t seed) {
  stability::Result result;
  for (const Rounding rounding : {Rounding::kNearest, Rounding::kTruncated}) {
    const std::string how = rounding == Rounding::kNearest ? "rounded" : "truncated";
    std::mt19937_64 random(seed);
    Totals totals;
    for (const Hull& hull : kHulls) {
      const scene::Object object = *hull.solid ? random_solid(random, hull.solid) : random_hull(random, 12);
      measure(rig, hull, object, rounding, &hull == kHulls, totals);
    }
    result.rows.push_back({"N-A2", how + " increments: largest drift of a depth", totals.drift.largest,
                           totals.bound, "depth units", "gmp", Bound::kAtMost, totals.drift.where});
    result.rows.push_back({"N-A2", how + " increments: largest share of a pixel's own bound",
                           totals.drift.share, 1, "", "gmp", Bound::kAtMost, totals.drift.worst});
    result.rows.push_back(
        {"N-A2", fmt::format("{}: {} planes alone on the machine, pixels outside the bound", how, kAlone),
         static_cast<double>(totals.alone.count), 0, "pixels", "gmp", Bound::kAtMost, totals.alone.first});
    result.rows.push_back({"N-A2", how + ": whole hulls on the machine, pixels outside the bound",
                           static_cast<double>(totals.machine.count), 0, "pixels", "gmp", Bound::kAtMost,
                           totals.machine.first});
  }
  return result;
}

}  // namespace dendro::half_space
