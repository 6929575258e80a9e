#include "firmware/half_space/host/scene_setup.h"

#include <fmt/format.h>

#include "sim/base/error.h"

namespace dendro::half_space {

ScanSettings read_scan_settings(scene::Options& options, int most_bits) {
  ScanSettings settings;
  settings.maxdepth = (1 << options.integer("depth_bits", most_bits, 6, most_bits)) - 1;
  settings.boxing = options.boolean("boxing", true);
  settings.steep = read_steep(options);
  settings.full_box = options.choice("starting_box", "vertices", {"vertices", "full"}) == "full";
  return settings;
}

void blame(const scene::Object& object, const std::string& message) {
  throw UserError(object.source_where.file, object.source_where.line, source_key(object), message);
}

void check_extent(const scene::Object& object, const ObjectPlanes& planes, const Extent& extent,
                  scene::Options& options) {
  const std::string unbounded =
      options.choice("unbounded", planes.grown ? "background" : "error", {"error", "background"});
  if (!extent.bounded && unbounded == "error")
    blame(object, fmt::format("the intersection of the {} planes is unbounded", planes.planes.size()));
  if (extent.empty) blame(object, fmt::format("no point lies inside all {} planes", planes.planes.size()));
}

DepthMap read_depth_map(scene::Options& options, double nearest, double farthest, int maxdepth,
                        double least_margin) {
  const std::vector<double> given = options.vector("depth_range", {0, 0}, -1e9, 1e9);
  const double margin = options.real("depth_margin", 0.05, least_margin, 10);
  if (options.has("depth_range")) {
    if (!(given[0] < given[1]))
      options.fail("depth_range", "must be [nearest, farthest] with nearest < farthest");
    if (options.has("depth_margin")) options.fail("depth_margin", "goes without depth_range only");
    return map_depth(given[0], given[1], 0, maxdepth);
  }
  if (!(nearest < farthest))
    options.fail("depth_range", "is needed when the planes are unbounded: [nearest, farthest] metres");
  return map_depth(nearest, farthest, margin, maxdepth);
}

std::optional<PlaneProgram> make_program(const scene::Image& image, const ScanSettings& settings,
                                         const std::vector<ScreenPlane>& screen, const Extent& extent,
                                         bool faces, std::uint64_t& flops) {
  PlaneProgram program;
  program.width = image.width, program.height = image.height;
  program.maxdepth = settings.maxdepth, program.boxing = settings.boxing, program.steep = settings.steep;
  program.box = {0, 0, image.width - 1, image.height - 1};
  if (!extent.corners.empty()) {
    const std::optional<Box> around = box_around(extent.corners, image.width, image.height);
    if (!around) return std::nullopt;
    if (!settings.full_box) program.box = *around;
  }
  for (const ScreenPlane& plane : screen) {
    PlaneRecord record = make_record(plane, program.box, program.steep, program.maxdepth / 2.0);
    if (!faces) record.face = 0;
    (record.kind == PlaneKind::kBack    ? program.back
     : record.kind == PlaneKind::kFront ? program.front
                                        : program.edge_on)
        .push_back(record);
    flops += kFlopsTransformPlane + kFlopsSlopes + kFlopsRound + kFlopsSteepTest;
  }
  return program;
}

}  // namespace dendro::half_space
