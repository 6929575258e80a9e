#include <fmt/format.h>

#include "firmware/half_space/stability/support.h"

// N-A3. Seen along a two-fold axis, 4 of the icosahedron's 20 planes have c = 0 exactly. The half-plane test
// is exact but for the rounding of the record's three numbers, which moves a line by at most 0.008 of a pixel
// over 512 lines.

namespace dendro::half_space {
namespace {

using stability::Bound;

struct View {
  int side;
  double height;
  double roll;  ///< quarter turns keep the faces exactly edge-on
};

/// The first is Figure 4's.
constexpr View kViews[] = {{512, 2.6, 0},   {512, 2.0, 90}, {511, 1.7, 0},
                           {256, 2.6, 180}, {200, 3.1, 90}, {64, 2.2, 0}};

Prepared icosahedron(const View& view) {
  scene::Object object;
  object.solid = "icosahedron";
  object.rotate = {0, 0, view.roll};
  return prepare(looking_at(object, view.side, view.height));
}

/// The edge-on planes between two flat ones, so that they alone decide every pixel.
Prepared slab_with_edges_of(const Prepared& prepared) {
  std::vector<ScreenPlane> planes = {{0, 0, 1, -4000.5}, {0, 0, -1, 5.5}};
  for (const ScreenPlane& plane : prepared.screen)
    if (plane.kind == PlaneKind::kEdgeOn) planes.push_back(plane);
  return from_screen(planes, prepared.program.width, prepared.program.height);
}

struct Totals {
  Tally counts, figure, half_planes, records, picture;
  std::int64_t near = 0;         // pixels so near a line that the rounding of its record decides
  std::int64_t near_differ = 0;  // those of them that differ
};

/// Every pixel against the sign of a·x + b·y + d in rationals.
void compare_half_planes(const Words& words, const Prepared& slab, const std::string& name, bool is_figure,
                         Totals& totals) {
  Enclosure enclosure(slab);
  const int width = slab.program.width;
  for (int y = 0; y < slab.program.height; ++y)
    for (int x = 0; x < width; ++x) {
      ++totals.half_planes.pixels;
      std::string outside;
      for (std::size_t k = 2; k < slab.screen.size(); ++k)
        if (enclosure.plane(k).floor32(x, y) >= 0)
          outside = fmt::format("plane {} has the pixel {:.9f} outside", k - 1,
                                static_cast<double>(enclosure.plane(k).floor32(x, y)) * 0x1p-32);
      const bool covered = face_of(words[static_cast<std::size_t>(y) * width + x]) != 0;
      const bool near = !enclosure.decided(x, y);
      totals.near += near;
      if (covered == outside.empty()) continue;
      totals.near_differ += near;
      const std::string where =
          fmt::format("{}: pixel ({}, {}), step {} of line {}, is {}: {}", name, x, y, x, y,
                      covered ? "covered" : "empty", outside.empty() ? "it is inside all planes" : outside);
      if (!near) totals.half_planes.fault(where);
      if (is_figure) totals.figure.fault(where);
    }
}

}  // namespace

stability::Result edge_on_planes(const stability::Rig& rig, std::uint64_t) {
  Totals totals;
  for (const View& view : kViews) {
    const std::string name = fmt::format("{0}x{0}, height {1}, roll {2}", view.side, view.height, view.roll);
    const Prepared prepared = icosahedron(view);
    const PlaneProgram& program = prepared.program;
    if (program.edge_on.size() != 4 || program.back.size() + program.front.size() != 16)
      totals.counts.fault(fmt::format("{}: {} edge-on planes", name, program.edge_on.size()));
    const Words words = draw(rig, prepared);
    compare_words(words, exact_record_words(program), program.width, name, totals.records);
    Enclosure enclosure(prepared);
    compare_enclosed(words, enclosure, program.width, name, totals.picture);
    const Prepared slab = slab_with_edges_of(prepared);
    compare_half_planes(draw(rig, slab), slab, name, &view == kViews, totals);
  }
  const auto row = [](const std::string& what, const Tally& tally, const char* unit) {
    return stability::Row{"N-A3",         what,       static_cast<double>(tally.count), 0, unit, "gmp",
                          Bound::kAtMost, tally.first};
  };
  return {{row(fmt::format("{} views without exactly 4 edge-on and 16 other faces", std::size(kViews)),
               totals.counts, "views"),
           row("Figure 4's view: pixels that differ from the exact half-plane test", totals.figure, "pixels"),
           row(fmt::format(
                   "all views: pixels that differ outside a record's rounding ({} of {} differ inside it)",
                   totals.near_differ, totals.near),
               totals.half_planes, "pixels"),
           row("icosahedron: words that differ from the records' exact values", totals.records, "pixels"),
           row("icosahedron: pixels outside what the exact planes allow", totals.picture, "pixels")},
          {}};
}

}  // namespace dendro::half_space
