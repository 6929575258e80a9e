#include "firmware/half_space/pixel_planes/prepare_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/half_space/host/screen_setup.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

constexpr unsigned kColourBits = 24, kIndexBits = 12;
constexpr unsigned kMostStreamBits = 48;  // a plane beyond moves by less than 2^-11 of a pixel over all depths
constexpr double kFlopsOfCorners = 4 * 4;  // depth at four corners

int log2_of(int side) {
  int log = 0;
  while (1 << log < side) ++log;
  return log;
}

/// Guard bits with which every value from low to high, rounding included, is a number of bits + guard bits.
unsigned guard_for(double low, double high, unsigned bits) {
  unsigned guard = 1;
  while (guard < 64 && (low - 1 < -std::ldexp(1.0, static_cast<int>(bits + guard) - 1) ||
                        high + 1 >= std::ldexp(1.0, static_cast<int>(bits + guard) - 1)))
    ++guard;
  return guard;
}

struct Range {
  double low = 0, high = 0;
};

Range over_array(const lib::Expression& e, const ArraySite& site) {
  const double x = static_cast<double>(e.a) * (site.width - 1), y = static_cast<double>(e.b) * (site.height - 1);
  return {e.c + std::min(0.0, x) + std::min(0.0, y), e.c + std::max(0.0, x) + std::max(0.0, y)};
}

void check_finite(const lib::Expression& e, const scene::Where& where) {
  if (!std::isfinite(e.a) || !std::isfinite(e.b) || !std::isfinite(e.c))
    throw UserError(where.file, where.line, "object", "a plane's coefficients are not finite in single precision");
}

/// Negative where the point (x, y, depth) lies outside; the larger slope is 1.
StreamPlane edge_on(const ScreenPlane& plane, double depth, const ArraySite& site, unsigned fraction) {
  const double scale = -1.0 / std::max(std::abs(plane.a), std::abs(plane.b));
  StreamPlane out;
  out.kind = PlaneKind::kEdgeOn;
  const double reach = 4.0 * std::max(site.width, site.height);  // an edge farther off is a constant of its side
  const double c = std::clamp((plane.d + plane.c * depth) * scale, -reach, reach);
  out.expression = {static_cast<float>(plane.a * scale), static_cast<float>(plane.b * scale), static_cast<float>(c)};
  const Range range = over_array(out.expression, site);
  out.fraction = fraction;
  out.guard = guard_for(range.low, range.high, 0);
  return out;
}

class Preparation {
 public:
  Preparation(const scene::Scene& scene, const ArraySite& site)
      : scene_(scene),
        options_(scene.options),
        view_((check_objects(scene), scene::parallel_view(scene.camera, scene.image))),
        site_(site) {
    // The whole picture decides how a plane is drawn, so that no two tiles do it in two ways.
    whole_ = site;
    if (!site.draws_tiles()) return;
    whole_.width = whole_tiles(scene.image.width, site.width), whole_.height = whole_tiles(scene.image.height, site.height);
  }

  PreparedPlanes make() {
    lib::check_picture_fits(scene_.image, site_);
    check_mesh_options(scene_, options_);
    result_.width = scene_.image.width, result_.height = scene_.image.height;
    result_.layout = choose_layout(scene_, site_);
    result_.maxdepth = (std::int64_t{1} << result_.layout.depth_bits) - 1;
    read_streams();
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) take(scene_.objects[i], scene_.seed + i);
    read_shading();
    const DepthMap depth = map_depth_of_scene();
    for (std::size_t i = 0; i < objects_.size(); ++i) add_hull(objects_[i], extents_[i], depth);
    add_tiles();
    check_index();
    skip_options_of_others();
    options_.finish();
    return std::move(result_);
  }

 private:
  static int whole_tiles(int side, int tile) { return (side + tile - 1) / tile * tile; }

  void add_tiles() {
    for (const lib::Tile& tile : lib::tiles_of(result_.width, result_.height, site_)) {
      TilePlanes work{tile, {}};
      for (std::size_t h = 0; h < result_.hulls.size(); ++h) {
        const StreamHull& hull = result_.hulls[h];
        const Box& box = hull.box;
        if (!hull.visible || (site_.draws_tiles() && !tile.meets(box.x0, box.y0, box.x1, box.y1, site_))) continue;
        std::vector<StreamPlane> planes = hull.planes;
        if (site_.draws_tiles())
          for (StreamPlane& plane : planes)
            plane = plane_in_tile(plane, hull.screen[plane.screen], tile, site_, result_.layout, least_guard_);
        work.hulls.emplace_back(h, std::move(planes));
      }
      result_.tiles.push_back(std::move(work));
    }
  }

  /// ASSUMED DEV-082
  void read_streams() {
    const int usual = std::max(log2_of(site_.width), log2_of(site_.height)) + 1;
    fraction_ = static_cast<unsigned>(options_.integer("fraction_bits", usual, 0, 20));
    least_guard_ = static_cast<unsigned>(options_.integer("guard_bits", 2, 1, 30));
    edge_fraction_ = static_cast<unsigned>(options_.integer("edge_fraction_bits", 16, 0, 24));
    options_.choice("variant", "two_stream", {"two_stream", "scratch"});
    options_.choice("colouring", "recolour", {"recolour", "index"});
    const auto depth_bits = static_cast<unsigned>(options_.integer("depth_bits", 16, 6, 24));
    if (depth_bits + fraction_ + least_guard_ > kMostStreamBits)
      options_.fail(options_.has("guard_bits") ? "guard_bits" : "fraction_bits",
                    fmt::format("{} depth, {} fraction and {} guard bits do not fit a stream of {} bits", depth_bits,
                                fraction_, least_guard_, kMostStreamBits));
  }

  void take(const scene::Object& object, std::uint64_t seed) {
    const std::string unbounded =
        options_.choice("unbounded", object.tree.empty() ? "error" : "background", {"error", "background"});
    const scene::Where& where = object.source_where;
    for (ObjectPlanes& one : object_planes(object, options_, seed)) {
      Extent extent = extent_of(one, view_);
      if (!extent.bounded && unbounded == "error")
        throw UserError(where.file, where.line, "object",
                        fmt::format("the intersection of the {} planes is unbounded", one.planes.size()));
      if (extent.empty)
        throw UserError(where.file, where.line, "object",
                        fmt::format("no point lies inside all {} planes", one.planes.size()));
      const Work work = growth_work(one.growth);
      result_.growth.flops += work.flops, result_.growth.instructions += work.instructions;
      result_.files.insert(result_.files.end(), one.files.begin(), one.files.end());
      objects_.push_back(std::move(one));
      extents_.push_back(std::move(extent));
      wheres_.push_back(where);
    }
    std::sort(result_.files.begin(), result_.files.end());
    result_.files.erase(std::unique(result_.files.begin(), result_.files.end()), result_.files.end());
  }

  DepthMap map_depth_of_scene() {
    const std::vector<double> given = options_.vector("depth_range", {0, 0}, -1e9, 1e9);
    const double margin = options_.real("depth_margin", 0.05, 0, 10);
    const auto most = static_cast<int>(result_.maxdepth);
    if (options_.has("depth_range")) {
      if (!(given[0] < given[1]))
        options_.fail("depth_range", "must be [nearest, farthest] with nearest < farthest");
      if (options_.has("depth_margin")) options_.fail("depth_margin", "goes without depth_range only");
      return map_depth(given[0], given[1], 0, most);
    }
    double nearest = INFINITY, farthest = -INFINITY;
    for (const Extent& extent : extents_)
      nearest = std::min(nearest, extent.nearest), farthest = std::max(farthest, extent.farthest);
    if (!(nearest < farthest))
      options_.fail("depth_range", "is needed when the planes are unbounded: [nearest, farthest] metres");
    return map_depth(nearest, farthest, margin, most);
  }

  void read_shading() {
    light_ = scene::to_light(scene_);
    ambient_ = scene_.lights.empty() ? 0.3 : scene_.lights[0].ambient;
    diffuse_ = options_.real("diffuse", 1.0 - ambient_, 0, 10);
    colour_ = options_.vector("colour", {1, 1, 1}, 0, 1);
    result_.background = to_rgb(options_.vector("background", {0, 0, 0}, 0, 1), 1.0);
  }

  void add_hull(const ObjectPlanes& object, const Extent& extent, const DepthMap& depth) {
    StreamHull hull;
    hull.bounded = extent.bounded;
    hull.screen = to_screen(object.planes, view_, scene_.image.height / scene_.camera.height, depth);
    hull.box = {0, 0, result_.width - 1, result_.height - 1};
    if (!extent.corners.empty()) {
      const std::optional<Box> around = box_around(extent.corners, result_.width, result_.height);
      hull.visible = around.has_value();
      if (around) hull.box = *around;
    }
    hull.before_screen = !extent.has_depth() || extent.nearest * depth.scale + depth.shift < 0;
    const std::size_t first = result_.faces.size();
    for (std::size_t i = 0; i < hull.screen.size(); ++i) add_plane(hull, i, object.planes[i].normal);
    if (result_.faces.size() > first) hull.first_shade = result_.faces[first];
    std::stable_sort(hull.planes.begin(), hull.planes.end(),
                     [](const StreamPlane& p, const StreamPlane& q) { return order_of(p.kind) < order_of(q.kind); });
    result_.hulls.push_back(std::move(hull));
  }

  static int order_of(PlaneKind kind) { return kind == PlaneKind::kBack ? 0 : kind == PlaneKind::kEdgeOn ? 1 : 2; }

  void add_plane(StreamHull& hull, std::size_t i, const glm::dvec3& normal) {
    StreamPlane plane = make_stream_plane(hull.screen[i], whole_, result_.layout, fraction_, least_guard_, edge_fraction_,
                                          wheres_[result_.hulls.size()]);
    if (plane.kind == PlaneKind::kFront) {
      plane.face = static_cast<int>(result_.faces.size());
      result_.faces.push_back(to_rgb(colour_, ambient_ + diffuse_ * std::max(0.0, glm::dot(normal, light_))));
    }
    plane.screen = i;
    hull.planes.push_back(plane);
  }

  void check_index() const {
    if (result_.layout.colouring != Colouring::kIndex) return;
    for (const StreamHull& hull : result_.hulls) {
      const auto fronts = std::count_if(hull.planes.begin(), hull.planes.end(),
                                        [](const StreamPlane& p) { return p.kind == PlaneKind::kFront; });
      if (fronts > 1 << kIndexBits)
        throw UserError(scene_.file, 0, "object",
                        fmt::format("{} front planes are more than {} bits can tell apart", fronts, kIndexBits));
    }
  }

  /// Keys of the frame-buffer program, so that one scene file serves both machines.
  void skip_options_of_others() {
    options_.integer("registers", 3, 2, 3);
    options_.boolean("boxing", true);
    options_.choice("starting_box", "vertices", {"vertices", "full"});
    read_steep(options_);
    options_.real("near_shade", 1.0, 0, 10);
    options_.real("far_shade", 0.15, -10, 10);
    options_.integer("bands", 0, 0, 128);
    options_.real("relief", 0.5, 0, 1);
  }

  const scene::Scene& scene_;
  scene::Options options_;
  scene::Affine view_;
  ArraySite site_, whole_;  ///< of the machine, and one as large as the picture
  PreparedPlanes result_;
  std::vector<ObjectPlanes> objects_;
  std::vector<Extent> extents_;
  std::vector<scene::Where> wheres_;
  unsigned fraction_ = 10, least_guard_ = 2, edge_fraction_ = 16;
  glm::dvec3 light_{};
  double ambient_ = 0, diffuse_ = 0;
  std::vector<double> colour_;
};

}  // namespace

const std::uint64_t kFlopsStreamPlane =
    kFlopsTransformPlane + kFlopsSlopes + static_cast<std::uint64_t>(kFlopsOfCorners) + kFlopsShade;

std::size_t PreparedPlanes::planes(PlaneKind kind) const {
  std::size_t count = 0;
  for (const StreamHull& hull : hulls)
    count += static_cast<std::size_t>(std::count_if(hull.planes.begin(), hull.planes.end(),
                                                    [kind](const StreamPlane& p) { return p.kind == kind; }));
  return count;
}

std::map<std::string, unsigned> PixelLayout::registers() const {
  return {{"depth_bits", depth_bits}, {"front", front},     {"back", back},  {"nearest", nearest},
          {"colour", colour},         {"scratch", scratch}, {"index", index}};
}

PixelLayout choose_layout(const scene::Scene& scene, const ArraySite& site) {
  scene::Options options = scene.options;
  PixelLayout layout;
  const bool scratch = options.choice("variant", "two_stream", {"two_stream", "scratch"}) == "scratch";
  const bool index = options.choice("colouring", "recolour", {"recolour", "index"}) == "index";
  if (scratch && site.ports < 2)
    options.fail("variant", "the scratch copy needs a memory with two ports (array.ports = 2); this one has one");
  if (scratch && index) options.fail("colouring", "index goes with two_stream only");
  layout.variant = scratch ? StreamVariant::kScratch : StreamVariant::kTwoStream;
  layout.colouring = index ? Colouring::kIndex : Colouring::kRecolour;
  const unsigned fields = scratch ? 4 : 3, rest = kColourBits + (index ? kIndexBits : 0);
  const auto memory = static_cast<unsigned>(site.memory_bits);
  const unsigned room = memory > rest ? std::min(24u, (memory - rest) / fields) : 0;
  const auto bits = static_cast<unsigned>(options.integer("depth_bits", std::max(6u, room), 6, 24));
  layout.depth_bits = bits;
  layout.front = 0, layout.back = bits, layout.nearest = 2 * bits, layout.colour = 3 * bits;
  layout.scratch = layout.index = 3 * bits + kColourBits;
  layout.used = fields * bits + rest;
  if (layout.used > memory)
    options.fail("depth_bits", fmt::format("{} registers of {} bits and {} further bits are {} of a pixel; the memory has {}",
                                           fields, bits, rest, layout.used, memory));
  return layout;
}

StreamPlane make_stream_plane(const ScreenPlane& plane, const ArraySite& site, const PixelLayout& layout,
                              unsigned fraction, unsigned least_guard, unsigned edge_fraction,
                              const scene::Where& where) {
  if (plane.kind != PlaneKind::kEdgeOn) {
    StreamPlane out;
    out.kind = plane.kind;
    out.fraction = fraction;
    out.expression = {static_cast<float>(-plane.a / plane.c), static_cast<float>(-plane.b / plane.c),
                      static_cast<float>(-plane.d / plane.c)};
    const Range range = over_array(out.expression, site);
    const lib::Expression& e = out.expression;
    const bool finite = std::isfinite(e.a) && std::isfinite(e.b) && std::isfinite(e.c);
    out.guard = finite ? std::max(least_guard, guard_for(range.low, range.high, layout.depth_bits)) : 64;
    if (fraction + layout.depth_bits + out.guard <= kMostStreamBits && out.guard < 64) return out;
  }
  const double middle = (std::ldexp(1.0, static_cast<int>(layout.depth_bits)) - 1) / 2;
  StreamPlane out = edge_on(plane, middle, site, edge_fraction);
  check_finite(out.expression, where);
  return out;
}

StreamPlane plane_in_tile(const StreamPlane& whole, const ScreenPlane& screen, const lib::Tile& tile, const ArraySite& site,
                          const PixelLayout& layout, unsigned least_guard) {
  ScreenPlane moved = screen;
  moved.d += screen.a * tile.x0 + screen.b * tile.y0;
  StreamPlane out = whole;
  if (whole.kind == PlaneKind::kEdgeOn) {
    const double middle = (std::ldexp(1.0, static_cast<int>(layout.depth_bits)) - 1) / 2;
    out = edge_on(moved, middle, site, whole.fraction);
    out.face = whole.face, out.screen = whole.screen;
    return out;
  }
  out.expression.c = static_cast<float>(-moved.d / moved.c);
  const Range range = over_array(out.expression, site);
  out.guard = std::max(least_guard, guard_for(range.low, range.high, layout.depth_bits));
  return out;
}

PreparedPlanes prepare_planes(const scene::Scene& scene, const ArraySite& site) { return Preparation(scene, site).make(); }

}  // namespace dendro::half_space
