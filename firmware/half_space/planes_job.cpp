#include "firmware/half_space/planes_job.h"

#include <algorithm>
#include <cmath>

#include "firmware/half_space/pixel_planes/planes_program.h"
#include "firmware/half_space/reference/faces_reference.h"
#include "firmware/half_space/reference/reference.h"
#include "sim/base/check.h"
#include "sim/scene/psnr.h"

namespace dendro::half_space {
namespace {

class PlanesJob : public Job {
 public:
  PlanesJob(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site)
      : prepared_(prepare_planes(scene, site)), programs_(std::move(programs)), site_(site) {}

  void run(HostPort& host) override { half_space::run(host, prepared_, programs_, site_); }

  ErrorReport compare(const MachineView& machine) const override {
    DENDRO_CHECK(machine.width == prepared_.width && machine.height == prepared_.height, "the monitor shows {}x{}",
                 machine.width, machine.height);
    const FacesReference wanted = render_faces_reference(prepared_);
    const std::vector<std::uint32_t> nearest = nearest_of(machine);
    ErrorReport report;
    report.psnr_db = scene::psnr(wanted.rgb, machine.rgb);
    std::int64_t other_face = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const bool covered = nearest[i] != static_cast<std::uint32_t>(prepared_.maxdepth);
      const bool wanted_covered = wanted.hull[i] >= 0;
      report.covered_pixels += wanted_covered;
      report.wrong_pixels += covered != wanted_covered;
      if (!covered || !wanted_covered) continue;
      if (!std::equal(machine.rgb + 3 * i, machine.rgb + 3 * i + 3, wanted.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i))) {
        ++other_face;
        continue;
      }
      report.max_depth_error = std::max(report.max_depth_error, std::abs(nearest[i] + 0.5 - wanted.depth[i]));
    }
    report.wrong_pixels += other_face;
    report.extra.emplace_back("other_colour", static_cast<double>(other_face));
    return report;
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    const std::vector<std::uint32_t> nearest = nearest_of(machine);
    const FacesReference wanted = render_faces_reference(prepared_);
    std::vector<Layer> layers =
        lib::picture_layers(machine, nearest, {"reference.Z", "reference.hull", "reference.face"});
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      layers[4].values[i] = static_cast<float>(wanted.depth[i]);
      layers[5].values[i] = static_cast<float>(wanted.hull[i] + 1);
      layers[6].values[i] = static_cast<float>(wanted.face[i] + 1);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return prepared_.files; }

  std::vector<FirmwareImage> firmware() const override { return {lib::firmware_image(programs_)}; }

  std::vector<std::pair<std::string, double>> facts() const override {
    std::size_t visible = 0, unbounded = 0, most_guard = 0;
    for (const StreamHull& hull : prepared_.hulls) visible += hull.visible, unbounded += !hull.bounded;
    for (const TilePlanes& tile : prepared_.tiles)
      for (const auto& [hull, planes] : tile.hulls)
        for (const StreamPlane& plane : planes)
          if (plane.kind != PlaneKind::kEdgeOn) most_guard = std::max<std::size_t>(most_guard, plane.guard);
    const auto count = [](auto n) { return static_cast<double>(n); };
    return {{"hulls", count(prepared_.hulls.size())},
            {"hulls.visible", count(visible)},
            {"hulls.unbounded", count(unbounded)},
            {"tiles", count(prepared_.tiles.size())},
            {"planes.back", count(prepared_.planes(PlaneKind::kBack))},
            {"planes.edge_on", count(prepared_.planes(PlaneKind::kEdgeOn))},
            {"planes.front", count(prepared_.planes(PlaneKind::kFront))},
            {"max_depth", count(prepared_.maxdepth)},
            {"depth_bits", count(prepared_.layout.depth_bits)},
            {"memory_bits_used", count(prepared_.layout.used)},
            {"guard_bits.most", count(most_guard)},
            {"host.flops_per_plane", count(kFlopsStreamPlane)},
            {"host.growth_flops", count(prepared_.growth.flops)}};
  }

 private:
  std::vector<std::uint32_t> nearest_of(const MachineView& machine) const {
    return lib::pixel_field(machine, site_, prepared_.layout.nearest, prepared_.layout.depth_bits);
  }

  PreparedPlanes prepared_;
  lib::IgcPrograms programs_;
  ArraySite site_;
};

}  // namespace

std::unique_ptr<Job> make_planes_job(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site) {
  return std::make_unique<PlanesJob>(scene, std::move(programs), site);
}

}  // namespace dendro::half_space
