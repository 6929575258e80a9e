#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/prepare_tree.h"
#include "firmware/half_space/reference/colour_model.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "firmware/half_space/reference/tree_reference.h"
#include "sim/base/check.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

using half_space::PreparedTree;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr unsigned kPixelBits = 24;
constexpr int kBackground = 255;

// A10: what taking turns in the control store costs.

double loads(const stats::RunObject& run) { return phase_seconds(run, "load_program"); }

void fill_overlays(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {{"loads", loads}};
  const Propagated turns =
      propagate_scene(context, {"figure6", {}, "", {}, "rds3000:fg86"}, metrics, "FG86 figure6");
  const Propagated resident = propagate_scene(context, {"figure6", {}, "", {}, "rds3000:big-store"}, metrics,
                                              "FG86 figure6 big-store");
  set_metric(rows[0], turns, metrics, 0);
  set_metric(rows[1], resident, metrics, 0);
  rows[0].note = fmt::format("4 programs, {:.1f} s of a run of {:.1f} s, of which {:.1f} s are the machine's",
                             loads(turns.nominal), turns.nominal.seconds, machine_seconds(turns.nominal));
  rows[1].note = fmt::format(
      "the same picture with all programs resident after one load each: {:.1f} s less; as A10 it rests "
      "on DEV-028",
      loads(turns.nominal) - loads(resident.nominal));
}

// A26: the hulls of trunks.

scene::Scene with_trunk(scene::Scene scene, const std::string& kind) {
  for (scene::Object& object : scene.objects) object.trunk_parameters["trunk"] = {kind, {}};
  return scene;
}

void fill_trunks(const TableContext& context, std::vector<TableRow>& rows) {
  const scene::Scene scene = request_of(context, {"figure6", {}, "function", {}, ""}).file.scene;
  std::size_t i = 0;
  for (const char* kind : {"cylinder", "cone"}) {
    const PreparedTree tree = half_space::prepare_tree(with_trunk(scene, kind), kPixelBits);
    DENDRO_CHECK(tree.hulls.trunks.size() == 1);
    set_single(rows[i], static_cast<double>(tree.hulls.trunks[0].hull.screen.size()));
    rows[i++].note = "planes of the trunk that figure6 sends to the machine";
  }
}

// A35: one point of the crown in two views.

/// The picture's nearest register before it is coloured.
std::vector<int> nearest_of(const PreparedTree& tree) {
  std::vector<int> nearest;
  for (const std::uint32_t word : half_space::run_tree_fixed_point(tree).pixels)
    nearest.push_back(static_cast<int>(word >> half_space::kNearestLow & half_space::kHullField));
  return nearest;
}

bool is_crown(int depth) { return depth != static_cast<int>(half_space::kTrunkMark) && depth != kBackground; }

/// The camera goes round the vertical through its target.
scene::Scene seen_from(scene::Scene scene, double degrees) {
  scene::Camera& camera = scene.camera;
  const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
  const double x = camera.position[0] - camera.target[0], z = camera.position[2] - camera.target[2];
  camera.position[0] = camera.target[0] + c * x + s * z;
  camera.position[2] = camera.target[2] - s * x + c * z;
  return scene;
}

struct View {
  View(const scene::Scene& scene, bool rough) {
    scene::Scene smooth = scene;
    smooth.options.set("roughness", {0.0, {}});
    tree = half_space::prepare_tree(smooth, kPixelBits);
    hull = shown = nearest_of(tree);
    if (rough) shown = nearest_of(half_space::prepare_tree(scene, kPixelBits));
  }

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * tree.hulls.width + x; }

  /// World point in the middle of a pixel's step of depth.
  glm::dvec3 world(int x, int y) const {
    const half_space::PreparedHulls& hulls = tree.hulls;
    const double metres = (hull[index(x, y)] + 0.5 - hulls.depth.shift) / hulls.depth.scale;
    return glm::inverse(hulls.view.linear) * (glm::dvec3(x, y, metres) - hulls.view.shift);
  }

  using Texel = std::array<int, 3>;
  Texel texel(int x, int y) const {
    Texel texel{};
    const std::uint32_t side = 1u << tree.colouring.level.bits;
    for (unsigned axis = 0; axis < 3; ++axis)
      texel[axis] = static_cast<int>(
          half_space::texel_coordinate(tree.colouring, axis, x, y, shown[index(x, y)]) >> 16 & (side - 1));
    return texel;
  }

  PreparedTree tree;       ///< without roughness
  std::vector<int> hull;   ///< nearest depths of the hulls as they are
  std::vector<int> shown;  ///< and as roughened, if they are
};

struct Agreement {
  double common = 0, same = 0, beside = 0;

  double share() const { return 100 * same / common; }
  double near() const { return 100 * (same + beside) / common; }
};

/// Largest distance of two texels along an axis, modulo the cube's side.
int distance(const View::Texel& a, const View::Texel& b, int side) {
  int most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int d = std::abs(a[axis] - b[axis]);
    most = std::max(most, std::min(d, side - d));
  }
  return most;
}

/// Points of the hulls that both views see: the second has the same depth there, to two steps of the
/// register.
Agreement compare_views(const View& a, const View& b) {
  const half_space::PreparedHulls &here = a.tree.hulls, &there = b.tree.hulls;
  const int side = 1 << a.tree.colouring.level.bits;
  Agreement agreement;
  for (int y = 0; y < here.height; ++y)
    for (int x = 0; x < here.width; ++x) {
      if (!is_crown(a.hull[a.index(x, y)]) || !is_crown(a.shown[a.index(x, y)])) continue;
      const glm::dvec3 s = there.view(a.world(x, y));
      const int u = static_cast<int>(std::floor(s.x + 0.5)), v = static_cast<int>(std::floor(s.y + 0.5));
      if (u < 0 || v < 0 || u >= there.width || v >= there.height) continue;
      const int depth = b.hull[b.index(u, v)];
      if (!is_crown(depth) || !is_crown(b.shown[b.index(u, v)])) continue;
      if (std::abs(depth + 0.5 - (there.depth.scale * s.z + there.depth.shift)) > 2) continue;
      const int apart = distance(a.texel(x, y), b.texel(u, v), side);
      ++agreement.common;
      agreement.same += apart == 0, agreement.beside += apart == 1;
    }
  DENDRO_CHECK(agreement.common > 0, "the views have nothing in common");
  return agreement;
}

constexpr double kTurns[] = {5, 15, 30, 60};  // degrees  ASSUMED DEV-060

void fill_views(const TableContext& context, std::vector<TableRow>& rows) {
  const scene::Scene scene = request_of(context, {"figure6", {}, "function", {}, ""}).file.scene;
  for (const bool rough : {false, true}) {
    TableRow& row = rows[rough ? 1 : 0];
    const View front(scene, rough);
    Agreement sum;
    double least = 100, most = 0;
    for (const double turn : kTurns) {
      const Agreement one = compare_views(front, View(seen_from(scene, turn), rough));
      sum.common += one.common, sum.same += one.same, sum.beside += one.beside;
      least = std::min(least, one.share()), most = std::max(most, one.share());
    }
    set_range(row, sum.share(), least, most);
    row.assumptions = {"DEV-060", "DEV-054"};
    if (rough) row.assumptions.push_back("DEV-053");
    row.note = fmt::format(
        "{:.0f} common points of figure6 and its camera turned by 5, 15, 30, 60 degrees; {:.2f} % have the "
        "same texel or one beside it; ",
        sum.common, sum.near());
    row.note += rough ? "the field that roughens is fixed to the screen, so a point of the hull has another "
                        "depth in each view"
                      : "the other view's pixel is up to half a pixel and a step of depth away";
  }
}

/// The camera's place as a setting.
std::string camera_setting(const scene::Scene& scene) {
  const auto& p = scene.camera.position;
  return fmt::format("camera.position=[{:.9f}, {:.9f}, {:.9f}]", p[0], p[1], p[2]);
}

/// The machine's own pictures: a pixel's colour against that of the texel at its world point in double
/// precision.
void fill_maps(const TableContext& context, std::vector<TableRow>& rows) {
  const scene::Scene scene = request_of(context, {"figure6", {}, "function", {}, ""}).file.scene;
  std::vector<SceneRun> runs = {{"figure6", {}, "function", {}, ""}};
  for (const double turn : kTurns)
    runs.push_back({"figure6", {camera_setting(seen_from(scene, turn))}, "function", {}, ""});
  double right = 0, all = 0, least = 100, most = 0;
  for (const Outcome& outcome : compared_runs(context, runs, "FG86 views")) {
    const stats::RunObject run = from_bytes(outcome.value()).object;
    const double crown = static_cast<double>(run.error.covered_pixels) - error_figure(run, "trunk_pixels");
    const double good = crown - error_figure(run, "texels_differ");
    right += good, all += crown;
    least = std::min(least, 100 * good / crown), most = std::max(most, 100 * good / crown);
  }
  set_range(rows[0], 100 * right / all, least, most);
  rows[0].assumptions = {"DEV-060", "DEV-054"};
  rows[0].note = fmt::format(
      "{:.0f} crown pixels in five pictures of figure6 as the machine leaves them; the texel does not depend "
      "on the view, {:.0f} pixels lie on a texel's side within the rounding of 16.16 (N-A8)",
      all, all - right);
}

// A36: the reverse painter against trunks as hulls.

constexpr double kElevations[] = {0, 15, 30, 60, 90};
constexpr int kGroves = 4, kTrees = 12, kSide = 256;  // ASSUMED DEV-060
constexpr double kGround = 8;                         ///< metres a side  ASSUMED DEV-060

scene::Scene trees_from(double elevation, std::uint64_t seed, const std::string& trunk) {
  scene::Scene scene;
  scene.name = "FG86-A36";
  scene.seed = seed;
  scene.image.width = scene.image.height = kSide;
  scene.camera.height = 1.3 * kGround;
  const double angle = elevation * kDegree;
  scene.camera.position = {0, 30 * std::sin(angle), 30 * std::cos(angle)};
  scene.camera.target = {0, 0, 0};
  if (elevation == 90) scene.camera.position = {0, 30, 0}, scene.camera.up = {0, 0, -1};
  scene.options = scene::Options("half_space");
  scene::Object object;
  object.tree = "round";
  const auto set = [&](const char* key, auto value) { object.tree_parameters[key] = {value, {}}; };
  set("copies", std::int64_t{kTrees});
  set("copies_area", scene::OptionValue::Array{{kGround, {}}, {kGround, {}}});
  object.trunk_parameters["trunk_height"] = {1.2, {}};
  scene.objects = {object};
  return with_trunk(std::move(scene), trunk);
}

/// Pixels of the trunks when no crown is there.
std::vector<bool> bare_trunks(const half_space::PreparedHulls& hulls) {
  half_space::HullsModel model(hulls.width, hulls.height, hulls.maxdepth);
  model.clear();
  for (const half_space::Trunk& trunk : hulls.trunks) {
    if (!trunk.visible()) continue;
    if (trunk.painter) {
      model.paint(trunk.trapezium);
    } else {
      model.passes(trunk.hull.program);
      model.merge_trunk(trunk.hull.program.box);
    }
  }
  std::vector<bool> covered;
  for (const std::uint32_t word : model.picture().pixels)
    covered.push_back((word >> half_space::kNearestLow & half_space::kHullField) == half_space::kTrunkMark);
  return covered;
}

struct Painting {
  double trunk = 0, hidden = 0,
         shown = 0;  ///< pixels: exact trunk; trunk that the painter hides, and shows too many

  double wrong() const { return hidden + shown; }
};

/// Where trapezium and hexagon have the same outline, so that only the order of painting can differ.
Painting compare_trunks(double elevation, std::uint64_t seed) {
  const PreparedTree exact = half_space::prepare_tree(trees_from(elevation, seed, "cylinder"), kPixelBits);
  const PreparedTree painter = half_space::prepare_tree(trees_from(elevation, seed, "painter"), kPixelBits);
  const std::vector<bool> hexagons = bare_trunks(exact.hulls), trapezia = bare_trunks(painter.hulls);
  const std::vector<int> right = nearest_of(exact), painted = nearest_of(painter);
  constexpr int kMark = static_cast<int>(half_space::kTrunkMark);
  Painting result;
  for (std::size_t i = 0; i < right.size(); ++i) {
    result.trunk += right[i] == kMark;
    if (hexagons[i] != trapezia[i] || (right[i] == kMark) == (painted[i] == kMark)) continue;
    (right[i] == kMark ? result.hidden : result.shown) += 1;
  }
  return result;
}

void fill_painter(const TableContext&, std::vector<TableRow>& rows) {
  std::size_t i = 0;
  for (const double elevation : kElevations) {
    Painting sum;
    double least = INFINITY, most = 0;
    for (std::uint64_t seed = 1; seed <= kGroves; ++seed) {
      const Painting one = compare_trunks(elevation, seed);
      sum.trunk += one.trunk, sum.hidden += one.hidden, sum.shown += one.shown;
      least = std::min(least, one.wrong()), most = std::max(most, one.wrong());
    }
    TableRow& row = rows[i++];
    set_range(row, sum.wrong() / kGroves, least, most);
    row.assumptions = {"DEV-060"};
    row.note = fmt::format(
        "mean of {} groves of {} trees: {:.1f} trunk pixels hidden that exact trunks show, {:.1f} shown that "
        "they hide, of {:.0f}",
        kGroves, kTrees, sum.hidden / kGroves, sum.shown / kGroves, sum.trunk / kGroves);
    if (sum.wrong() > 0)
      row.note += elevation < 20 ? "; trunks stand before the crowns of other trees"
                                 : "; these lie where a trunk leaves its crown within a step of depth";
  }
}

std::vector<TableRow> painter_claims() {
  std::vector<TableRow> rows;
  for (const double elevation : kElevations)
    rows.push_back(
        claim(fmt::format("FG86-A36{}", static_cast<char>('a' + rows.size())),
              fmt::format("reverse painter: wrong pixels at {:g} degrees", elevation), "px", 0.0,
              "\"from above ... this will give the correct priority\": against trunks as hulls, where both "
              "have the same outline"));
  return rows;
}

}  // namespace

std::vector<RowGroup> fg86_tree_groups() {
  return {
      {"figure6 with one control-store page and with eight, over every assumption",
       {claim("FG86-A10b", "program loads of a complete tree", "s"),
        claim("FG86-A10c", "program loads of a complete tree, big-store", "s")},
       fill_overlays},
      {"",
       {claim("FG86-A26a", "planes of a trunk as hexagonal cylinder", "1", 8.0, "6 + 2"),
        claim("FG86-A26b", "planes of a trunk as hexagonal cone", "1", 7.0, "6 + 1")},
       fill_trunks},
      {"figure6 from five sides at level function",
       {claim("FG86-A35a", "pixels with their world point's texel", "%", 100.0, "\"consistency of colour\"")},
       fill_maps},
      {"figure6 from five sides on integers, smooth and roughened",
       {claim("FG86-A35b", "pixels of two views with the same texel", "%", 100.0,
              "the same for nearest pixels of two pictures, which are not at the same point"),
        claim("FG86-A35c", "the same with a roughened crown", "%", 100.0,
              "the same with the crown roughened")},
       fill_views},
      {"groves seen from 0 to 90 degrees on integers, trunks as hulls and painted", painter_claims(),
       fill_painter}};
}

}  // namespace dendro::study
