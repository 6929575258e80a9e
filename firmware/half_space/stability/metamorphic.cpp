#include <fmt/format.h>

#include <algorithm>

#include "firmware/half_space/stability/support.h"

// X1 to X4 and X6. They need no reference picture; where rounding differs between two pictures, the exact
// planes say which pixels may.

namespace dendro::half_space {
namespace {

using stability::Bound;

/// A random hull with `cuts` planes beside the six of its box.
struct Hull {
  int cuts, side;
  std::int64_t depth_bits;
};

constexpr Hull kHulls[] = {{0, 64, 12},   {6, 200, 12},  {12, 199, 8},
                           {20, 256, 12}, {30, 150, 10}, {12, 100, 6}};

using Real = scene::OptionValue;

/// The same depth range for both pictures, so that only the transformation differs.
scene::Scene hull_scene(std::mt19937_64& random, const Hull& hull) {
  scene::Scene scene = looking_at(random_hull(random, hull.cuts), hull.side, 3.0);
  scene = with(std::move(scene), "depth_range",
               {Real::Array{{3.25, {"stability", 0}}, {6.75, {"stability", 0}}}, {"stability", 0}});
  return with(std::move(scene), "depth_bits", {hull.depth_bits, {"stability", 0}});
}

std::string name_of(const Hull& hull, std::uint64_t seed) {
  return fmt::format("hull of 6 + {} planes, side {}, {} bits, seed {}", hull.cuts, hull.side,
                     hull.depth_bits, seed);
}

struct Totals {
  Tally unexplained;    ///< differ although the exact planes decide the pixel
  Tally first, second;  ///< impossible words of either picture
  std::int64_t differ = 0, pixels = 0, covered = 0;
};

using Place = std::function<std::size_t(int x, int y)>;

/// `second[place(x, y)]` has to be `first` at (x, y).
void compare_moved(const Words& first, const Words& second, const Place& place, Enclosure& enclosure,
                   int side, const std::string& name, Totals& totals) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const std::uint32_t a = first[static_cast<std::size_t>(y) * side + x], b = second[place(x, y)];
      ++totals.pixels;
      totals.covered += face_of(a) != 0;
      if (a == b) continue;
      ++totals.differ;
      if (!enclosure.decided(x, y)) continue;
      totals.unexplained.fault(
          fmt::format("{}: pixel ({}, {}) is 0x{:06x}, transformed 0x{:06x}", name, x, y, a, b));
    }
}

using Transform = std::function<void(scene::Scene&)>;
using PlaceIn = std::function<std::size_t(int x, int y, int side)>;

stability::Result transformed(const stability::Rig& rig, std::uint64_t seed, const std::string& id,
                              const Transform& transform, const PlaceIn& place, bool exact) {
  std::mt19937_64 random(seed);
  Totals totals;
  for (const Hull& hull : kHulls) {
    const std::string name = name_of(hull, seed);
    const scene::Scene scene = hull_scene(random, hull);
    scene::Scene other = scene;
    transform(other);
    const Prepared prepared = prepare(scene), moved = prepare(other);
    Enclosure enclosure(prepared), around(moved);
    const Words first = draw(rig, prepared), second = draw(rig, moved);
    compare_enclosed(first, enclosure, hull.side, name, totals.first);
    compare_enclosed(second, around, hull.side, name + ", transformed", totals.second);
    compare_moved(
        first, second, [&](int x, int y) { return place(x, y, hull.side); }, enclosure, hull.side, name,
        totals);
  }
  const std::string of = fmt::format("{} hulls, {} covered pixels", std::size(kHulls), totals.covered);
  const auto count = [](const Tally& tally) { return static_cast<double>(tally.count); };
  stability::Result result;
  if (exact)
    result.rows.push_back({id, "pixels that differ, " + of, static_cast<double>(totals.differ), 0, "pixels",
                           "machine", Bound::kAtMost, totals.unexplained.first});
  else
    result.rows.push_back(
        {id,
         fmt::format("pixels that differ outside the bound of N-A2 ({} differ inside it), {}",
                     totals.differ - totals.unexplained.count, of),
         count(totals.unexplained), 0, "pixels", "machine", Bound::kAtMost, totals.unexplained.first});
  result.rows.push_back({id, "pixels of either picture outside what the exact planes allow",
                         count(totals.first) + count(totals.second), 0, "pixels", "gmp", Bound::kAtMost,
                         totals.first.count > 0 ? totals.first.first : totals.second.first});
  result.rows.push_back({id, "covered pixels, so that the pictures show something",
                         static_cast<double>(totals.covered), 0, "pixels", "machine", Bound::kMoreThan, ""});
  return result;
}

/// True when two faces have the pixel's depth: the order of the planes then decides which number it gets.
bool is_tied(const PlaneProgram& program, int x, int y, int depth) {
  int faces = 0;
  for (const PlaneRecord& r : program.front) {
    const std::int64_t z = r.start + r.step_x * (x - program.box.x0) + r.step_y * (y - program.box.y0);
    faces += std::clamp<std::int64_t>(z >> kFractionBits, 0, program.maxdepth) == depth;
  }
  return faces > 1;
}

/// The tile of a program: the same records, moved on to the tile's first pixel by whole steps.
Prepared tile_of(const Prepared& whole, const Box& box) {
  Prepared tile = whole;
  PlaneProgram& program = tile.program;
  const int i = box.x0 - program.box.x0, j = box.y0 - program.box.y0;
  for (auto* records : {&program.back, &program.edge_on, &program.front})
    for (PlaneRecord& record : *records) record.start += i * record.step_x + j * record.step_y;
  program.box = box;
  return tile;
}

/// The same planes set up by the host for the tile alone.
Prepared tile_anew(const Prepared& whole, const Box& box) {
  Prepared tile = whole;
  PlaneProgram& program = tile.program;
  program.box = box;
  for (auto* records : {&program.back, &program.edge_on, &program.front}) records->clear();
  for (const ScreenPlane& plane : whole.screen) {
    const PlaneRecord record = make_record(plane, box, program.steep, program.maxdepth / 2.0);
    (record.kind == PlaneKind::kBack    ? program.back
     : record.kind == PlaneKind::kFront ? program.front
                                        : program.edge_on)
        .push_back(record);
  }
  return tile;
}

std::vector<Box> tiles(int side, int columns, int rows) {
  std::vector<Box> boxes;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      boxes.push_back(
          {i * side / columns, j * side / rows, (i + 1) * side / columns - 1, (j + 1) * side / rows - 1});
  return boxes;
}

}  // namespace

stability::Result permuted_planes(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Tally shape, faces;
  std::int64_t tied = 0;
  for (const Hull& hull : kHulls) {
    Prepared prepared = prepare(hull_scene(random, hull));
    const Words first = draw(rig, prepared);
    PlaneProgram& program = prepared.program;
    for (auto* records : {&program.back, &program.edge_on, &program.front})
      std::shuffle(records->begin(), records->end(), random);
    const Words second = draw(rig, prepared);
    for (int y = 0; y < hull.side; ++y)
      for (int x = 0; x < hull.side; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * hull.side + x;
        const std::string place = fmt::format("{}: pixel ({}, {}) is 0x{:06x}, permuted 0x{:06x}",
                                              name_of(hull, seed), x, y, first[i], second[i]);
        const bool same = (face_of(first[i]) != 0) == (face_of(second[i]) != 0) &&
                          depth_of(first[i]) == depth_of(second[i]);
        if (!same) shape.fault(place);
        if (!same || first[i] == second[i]) continue;
        if (is_tied(program, x, y, depth_of(first[i]))) {
          ++tied;
        } else {
          faces.fault(place);
        }
      }
  }
  return {{{"X1", fmt::format("pixels whose coverage or depth differs, {} hulls", std::size(kHulls)),
            static_cast<double>(shape.count), 0, "pixels", "machine", Bound::kAtMost, shape.first},
           {"X1", fmt::format("pixels whose face differs although no two faces tie ({} at ties)", tied),
            static_cast<double>(faces.count), 0, "pixels", "machine", Bound::kAtMost, faces.first}},
          {}};
}

stability::Result quarter_turn(const stability::Rig& rig, std::uint64_t seed) {
  return transformed(
      rig, seed, "X2",
      [](scene::Scene& scene) {
        scene.camera.up = {1, 0, 0};
      },
      [](int x, int y, int side) { return static_cast<std::size_t>(side - 1 - x) * side + y; }, false);
}

stability::Result scaled_by_two(const stability::Rig& rig, std::uint64_t seed) {
  return transformed(
      rig, seed, "X3",
      [](scene::Scene& scene) {
        scene.objects[0].scale *= 2;
        scene.camera.height *= 2;
        for (double& v : scene.camera.position) v *= 2;
        scene.options.set("depth_range",
                          {Real::Array{{6.5, {"stability", 0}}, {13.5, {"stability", 0}}}, {"stability", 0}});
      },
      [](int x, int y, int side) { return static_cast<std::size_t>(y) * side + x; }, true);
}

stability::Result mirrored(const stability::Rig& rig, std::uint64_t seed) {
  return transformed(
      rig, seed, "X4",
      [](scene::Scene& scene) {
        for (scene::PlaneEntry& plane : scene.objects[0].planes) plane.normal[0] = -plane.normal[0];
      },
      [](int x, int y, int side) { return static_cast<std::size_t>(y) * side + (side - 1 - x); }, false);
}

stability::Result tiled(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Tally moved, anew_outside;
  std::int64_t anew = 0;
  for (const Hull& hull : kHulls) {
    const std::string name = name_of(hull, seed);
    const Prepared whole = prepare(hull_scene(random, hull));
    const Words wanted = draw(rig, whole);
    Enclosure enclosure(whole);
    for (const auto& [columns, rows] : {std::pair(2, 2), {3, 5}, {1, 7}}) {
      std::vector<Prepared> by_steps, by_host;
      for (const Box& box : tiles(hull.side, columns, rows)) {
        by_steps.push_back(tile_of(whole, box));
        by_host.push_back(tile_anew(whole, box));
      }
      const std::string split = fmt::format("{}, {}x{} tiles", name, columns, rows);
      compare_words(draw_all(rig, by_steps), wanted, hull.side, split, moved);
      const Words joined = draw_all(rig, by_host);
      for (std::size_t i = 0; i < wanted.size(); ++i) anew += joined[i] != wanted[i];
      compare_enclosed(joined, enclosure, hull.side, split, anew_outside);
    }
  }
  return {{{"X6",
            fmt::format("pixels that differ, {} hulls in 3 tilings, records moved by whole steps",
                        std::size(kHulls)),
            static_cast<double>(moved.count), 0, "pixels", "machine", Bound::kAtMost, moved.first},
           {"X6",
            fmt::format(
                "records set up anew for each tile: pixels outside the bound of N-A2 ({} differ inside it)",
                anew),
            static_cast<double>(anew_outside.count), 0, "pixels", "gmp", Bound::kAtMost, anew_outside.first}},
          {}};
}

}  // namespace dendro::half_space
