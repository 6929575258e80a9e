#include "firmware/half_space/host/prepare_hulls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/screen_setup.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

class HullsPreparation {
 public:
  explicit HullsPreparation(const scene::Scene& scene)
      : scene_(scene),
        options_(scene.options),
        view_((check_picture(scene), scene::parallel_view(scene.camera, scene.image))) {}

  PreparedHulls make() {
    options_.integer("registers", 3, 2, 3);
    check_mesh_options(scene_, options_);
    result_.width = scene_.image.width, result_.height = scene_.image.height;
    result_.maxdepth = (1 << options_.integer("depth_bits", kHullBits, 6, kHullBits)) - 1;
    boxing_ = options_.boolean("boxing", true);
    steep_ = read_steep(options_);
    full_box_ = options_.choice("starting_box", "vertices", {"vertices", "full"}) == "full";
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) take(scene_.objects[i], scene_.seed + i);
    const DepthMap depth = map_depth_of_scene();
    for (std::size_t i = 0; i < objects_.size(); ++i) add_hull(objects_[i], extents_[i], depth);
    make_shades();
    options_.finish();
    return std::move(result_);
  }

 private:
  void take(const scene::Object& object, std::uint64_t seed) {
    const std::string unbounded =
        options_.choice("unbounded", object.tree.empty() ? "error" : "background", {"error", "background"});
    for (ObjectPlanes& one : object_planes(object, options_, seed)) {
      Extent extent = extent_of(one, view_);
      const scene::Where& where = object.source_where;
      if (!extent.bounded && unbounded == "error")
        throw UserError(where.file, where.line, "object",
                        fmt::format("the intersection of the {} planes is unbounded", one.planes.size()));
      if (extent.empty)
        throw UserError(where.file, where.line, "object",
                        fmt::format("no point lies inside all {} planes", one.planes.size()));
      const Work work = growth_work(one.growth);
      result_.growth.flops += work.flops, result_.growth.instructions += work.instructions;
      result_.splits += static_cast<std::uint64_t>(one.growth.splits);
      result_.setup_flops += extent.flops;
      result_.files.insert(result_.files.end(), one.files.begin(), one.files.end());
      objects_.push_back(std::move(one));
      extents_.push_back(std::move(extent));
    }
    std::sort(result_.files.begin(), result_.files.end());
    result_.files.erase(std::unique(result_.files.begin(), result_.files.end()), result_.files.end());
  }

  DepthMap map_depth_of_scene() {
    const std::vector<double> given = options_.vector("depth_range", {0, 0}, -1e9, 1e9);
    const double margin = options_.real("depth_margin", 0.05, 0, 10);
    if (options_.has("depth_range")) {
      if (!(given[0] < given[1]))
        options_.fail("depth_range", "must be [nearest, farthest] with nearest < farthest");
      if (options_.has("depth_margin")) options_.fail("depth_margin", "goes without depth_range only");
      return map_depth(given[0], given[1], 0, result_.maxdepth);
    }
    double nearest = INFINITY, farthest = -INFINITY;
    for (const Extent& extent : extents_)
      nearest = std::min(nearest, extent.nearest), farthest = std::max(farthest, extent.farthest);
    if (!(nearest < farthest))
      options_.fail("depth_range", "is needed when the planes are unbounded: [nearest, farthest] metres");
    return map_depth(nearest, farthest, margin, result_.maxdepth);
  }

  void add_hull(const ObjectPlanes& object, const Extent& extent, const DepthMap& depth) {
    Hull hull;
    hull.bounded = extent.bounded;
    hull.screen = to_screen(object.planes, view_, scene_.image.height / scene_.camera.height, depth);
    PlaneProgram& program = hull.program;
    program.width = result_.width, program.height = result_.height;
    program.maxdepth = result_.maxdepth, program.boxing = boxing_, program.steep = steep_;
    program.box = {0, 0, result_.width - 1, result_.height - 1};
    if (!extent.corners.empty()) {
      const std::optional<Box> around = box_around(extent.corners, result_.width, result_.height);
      hull.visible = around.has_value();
      if (around && !full_box_) program.box = *around;
    }
    for (const ScreenPlane& plane : hull.screen) {
      PlaneRecord record = make_record(plane, program.box, steep_, result_.maxdepth / 2.0);
      record.face = 0;  // no bits are left for it
      auto& list = record.kind == PlaneKind::kBack    ? program.back
                   : record.kind == PlaneKind::kFront ? program.front
                                                      : program.edge_on;
      list.push_back(record);
      result_.setup_flops += kFlopsTransformPlane + kFlopsSlopes + kFlopsRound + kFlopsSteepTest;
    }
    result_.hulls.push_back(std::move(hull));
  }

  /// All 24 bits are depth, so depth is what colour can come from: the look-up table fades it.  ASSUMED
  /// DEV-046
  void make_shades() {
    const std::vector<double> colour = options_.vector("colour", {1, 1, 1}, 0, 1);
    const double near_shade = options_.real("near_shade", 1.0, 0, 10);
    const double far_shade = options_.real("far_shade", 0.15, -10, 10);
    const auto bands = static_cast<int>(options_.integer("bands", 0, 0, 128));
    const double relief = options_.real("relief", 0.5, 0, 1);
    const Rgb background = to_rgb(options_.vector("background", {0, 0, 0}, 0, 1), 1.0);
    for (int d = 0; d < 256; ++d) {
      const double way = static_cast<double>(d) / result_.maxdepth;
      const double in_band = std::abs(2 * (way * bands - std::floor(way * bands)) - 1);
      const double shade =
          (near_shade + (far_shade - near_shade) * way) * (1 - (bands > 0 ? relief * in_band : 0));
      result_.shades.push_back(d < result_.maxdepth ? to_rgb(colour, shade) : background);
    }
  }

  const scene::Scene& scene_;
  scene::Options options_;
  scene::Affine view_;
  PreparedHulls result_;
  std::vector<ObjectPlanes> objects_;
  std::vector<Extent> extents_;
  bool boxing_ = true, full_box_ = false;
  SteepPolicy steep_ = SteepPolicy::kWide;
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

PreparedHulls prepare_hulls(const scene::Scene& scene) { return HullsPreparation(scene).make(); }

}  // namespace dendro::half_space
