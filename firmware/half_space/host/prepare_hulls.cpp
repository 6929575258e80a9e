#include "firmware/half_space/host/prepare_hulls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/scene_setup.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

/// Keeps the crowns of a complete tree away from depth 0, which marks trunks, by more than two units.
constexpr double kCrownMargin = 0.01;

class HullsPreparation {
 public:
  HullsPreparation(const scene::Scene& scene, scene::Options& options, bool complete)
      : scene_(scene), options_(options), complete_(complete) {
    check_picture(scene);
    result_.view = scene::parallel_view(scene.camera, scene.image);
    result_.width = scene_.image.width, result_.height = scene_.image.height;
    result_.pixels_per_metre = scene_.image.height / scene_.camera.height;
  }

  PreparedHulls make() {
    check_mesh_options(scene_, options_);
    settings_ = read_scan_settings(options_, kHullBits);
    result_.maxdepth = settings_.maxdepth;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) take(scene_.objects[i], scene_.seed + i);
    if (complete_) place_trunks();
    find_depth_map();
    for (std::size_t i = 0; i < crowns_.size(); ++i) result_.hulls.push_back(make_crown(crowns_[i]));
    for (std::size_t i = 0; i < trunks_.size(); ++i) add_trunk(trunks_[i]);
    std::stable_sort(result_.trunks.begin(), result_.trunks.end(),
                     [](const Trunk& a, const Trunk& b) { return a.depth < b.depth; });
    return std::move(result_);
  }

 private:
  struct Crown {
    const scene::Object* object;
    ObjectPlanes planes;
    Extent extent;
  };
  struct PlacedTrunk {
    TrunkKind kind = TrunkKind::kNone;
    TrunkShape shape;
    ObjectPlanes planes;
    Extent extent;
    double depth = 0;
  };

  void take(const scene::Object& object, std::uint64_t seed) {
    for (ObjectPlanes& one : object_planes(object, options_, seed)) {
      Extent extent = extent_of(one, result_.view);
      check_extent(object, one, extent, options_);
      const Work work = growth_work(one.growth);
      result_.growth.flops += work.flops, result_.growth.instructions += work.instructions;
      result_.splits += static_cast<std::uint64_t>(one.growth.splits);
      result_.setup_flops += extent.flops;
      result_.files.insert(result_.files.end(), one.files.begin(), one.files.end());
      include(extent);
      crowns_.push_back({&object, std::move(one), std::move(extent)});
    }
    std::sort(result_.files.begin(), result_.files.end());
    result_.files.erase(std::unique(result_.files.begin(), result_.files.end()), result_.files.end());
  }

  void include(const Extent& extent) {
    nearest_ = std::min(nearest_, extent.nearest), farthest_ = std::max(farthest_, extent.farthest);
  }

  /// Scale f / (f + z) with z from the nearest that is drawn, which lies on the screen [S11].
  void place_trunks() {
    const double distance = options_.real("trunk_distance", 0, 0.01, 1e6);
    const double screen = nearest_;
    for (const Crown& crown : crowns_) {
      const TrunkSettings settings = read_trunk(*crown.object);
      if (settings.kind == TrunkKind::kNone) continue;
      const std::optional<CrownSize> size = crown_size(crown.planes);
      if (!size) blame(*crown.object, "a trunk needs a crown that is bounded");
      PlacedTrunk trunk;
      trunk.kind = settings.kind;
      trunk.depth = result_.view(size->centre).z;
      const double f = distance * size->height;
      const double scale =
          options_.has("trunk_distance") ? f / (f + std::max(0.0, trunk.depth - screen)) : 1.0;
      trunk.shape = crown.planes.trunk_points.empty()
                        ? trunk_shape(settings, *size, scale)
                        : fit_trunk(crown.planes.trunk_points, *size, *crown.object);
      result_.setup_flops += kFlopsProjectVertex + kFlopsTrunkSize;
      if (trunk.kind != TrunkKind::kPainter) {
        trunk.planes.planes = trunk_planes(trunk.kind, trunk.shape);
        trunk.extent = extent_of(trunk.planes, result_.view);
        result_.setup_flops += trunk.extent.flops;
        include(trunk.extent);
      }
      trunks_.push_back(std::move(trunk));
    }
    if (trunks_.empty() && options_.has("trunk_distance"))
      options_.fail("trunk_distance", "no object has a trunk");
    if (!trunks_.empty() && options_.has("depth_range"))
      options_.fail("depth_range", "goes without trunks: the depths are those of crowns and trunks");
  }

  void find_depth_map() {
    result_.depth =
        read_depth_map(options_, nearest_, farthest_, settings_.maxdepth, complete_ ? kCrownMargin : 0);
  }

  Hull make_hull(const ObjectPlanes& planes, const Extent& extent, bool keep_from_screen) {
    Hull hull;
    hull.bounded = extent.bounded;
    if (extent.has_depth())
      hull.depth_extent =
          std::min<double>((extent.farthest - extent.nearest) * result_.depth.scale, result_.maxdepth);
    hull.screen = to_screen(planes.planes, result_.view, result_.pixels_per_metre, result_.depth);
    if (keep_from_screen) hull.screen.push_back({0, 0, -1, 1, PlaneKind::kFront, 0});
    // No bits are left for a face number.
    std::optional<PlaneProgram> program =
        make_program(scene_.image, settings_, hull.screen, extent, false, result_.setup_flops);
    hull.visible = program.has_value();
    if (program) hull.program = std::move(*program);
    hull.program.steep = settings_.steep;
    return hull;
  }

  /// A crown that may reach depth 0 gets one more plane, at depth 1.
  Hull make_crown(const Crown& crown) {
    return make_hull(crown.planes, crown.extent,
                     complete_ && (!crown.extent.bounded || options_.has("depth_range")));
  }

  void add_trunk(const PlacedTrunk& placed) {
    Trunk trunk;
    trunk.depth = placed.depth;
    trunk.painter = placed.kind == TrunkKind::kPainter;
    if (trunk.painter) {
      const auto trapezium =
          trapezium_of(placed.shape, result_.view, result_.pixels_per_metre, result_.width, result_.height);
      trunk.hull.visible = trapezium.has_value();
      if (trapezium) trunk.trapezium = *trapezium;
    } else {
      trunk.hull = make_hull(placed.planes, placed.extent, false);
    }
    result_.trunks.push_back(std::move(trunk));
  }

  const scene::Scene& scene_;
  scene::Options& options_;
  bool complete_;
  PreparedHulls result_;
  ScanSettings settings_;
  std::vector<Crown> crowns_;
  std::vector<PlacedTrunk> trunks_;
  double nearest_ = INFINITY, farthest_ = -INFINITY;
};

/// A value of the wrong kind is left to those who read the tree's parameters.
bool has_copies(const scene::Object& object) {
  const auto copies = object.tree_parameters.find("copies");
  if (copies == object.tree_parameters.end()) return false;
  const auto* count = std::get_if<std::int64_t>(&copies->second.value);
  return count != nullptr && *count > 1;
}

}  // namespace

std::size_t PreparedHulls::planes() const {
  std::size_t count = 0;
  for (const Hull& hull : hulls) count += hull.screen.size();
  return count;
}

bool needs_three_registers(const scene::Scene& scene) {
  scene::Options options = scene.options;
  const bool several =
      scene.objects.size() > 1 || std::any_of(scene.objects.begin(), scene.objects.end(), has_copies);
  const bool three = options.integer("registers", several ? 3 : 2, 2, 3) == 3;
  if (several && !three) options.fail("registers", "more than one hull needs the third register");
  return three;
}

bool is_complete_tree(const scene::Scene& scene) {
  scene::Options options = scene.options;
  bool complete = options.text("texture", "none") != "none" || options.real("roughness", 0, 0, 1) > 0;
  for (const scene::Object& object : scene.objects)
    complete = read_trunk(object).kind != TrunkKind::kNone || complete;
  if (complete && options.integer("registers", 3, 2, 3) == 2)
    options.fail("registers", "texture, roughness and trunks need the third register");
  return complete;
}

std::vector<Rgb> read_depth_shades(scene::Options& options, int maxdepth) {
  const std::vector<double> colour = options.vector("colour", {1, 1, 1}, 0, 1);
  const double near_shade = options.real("near_shade", 1.0, 0, 10);
  const double far_shade = options.real("far_shade", 0.15, -10, 10);
  const auto bands = static_cast<int>(options.integer("bands", 0, 0, 128));
  const double relief = options.real("relief", 0.5, 0, 1);
  const Rgb background = to_rgb(options.vector("background", {0, 0, 0}, 0, 1), 1.0);
  std::vector<Rgb> shades;
  for (int d = 0; d < 256; ++d) {
    const double way = static_cast<double>(d) / maxdepth;
    const double in_band = std::abs(2 * (way * bands - std::floor(way * bands)) - 1);
    const double shade =
        (near_shade + (far_shade - near_shade) * way) * (1 - (bands > 0 ? relief * in_band : 0));
    shades.push_back(d < maxdepth ? to_rgb(colour, shade) : background);
  }
  return shades;
}

PreparedHulls prepare_hulls(const scene::Scene& scene) {
  scene::Options options = scene.options;
  options.integer("registers", 3, 2, 3);
  PreparedHulls prepared = HullsPreparation(scene, options, false).make();
  prepared.shades = read_depth_shades(options, prepared.maxdepth);
  options.finish();
  return prepared;
}

PreparedHulls prepare_crowns(const scene::Scene& scene, scene::Options& options) {
  options.integer("registers", 3, 3, 3);
  if (options.integer("depth_bits", kHullBits, 6, kHullBits) != kHullBits)
    options.fail("depth_bits", fmt::format("a complete tree takes {} bits: depth 0 marks trunks", kHullBits));
  return HullsPreparation(scene, options, true).make();
}

}  // namespace dendro::half_space
