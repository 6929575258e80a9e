#include "firmware/raster_primitives/job.h"

#include <algorithm>
#include <cmath>

#include "firmware/raster_primitives/host/host_program.h"
#include "firmware/raster_primitives/reference/reference.h"
#include "sim/base/check.h"
#include "sim/scene/psnr.h"

namespace dendro::raster_primitives {
namespace {

constexpr double kRounding = 1.5;  ///< of a depth, units: half for what is cut off, one for the coefficients

class PrimitivesJob : public Job {
 public:
  PrimitivesJob(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site)
      : prepared_(prepare(scene, site)), programs_(std::move(programs)), site_(site) {}

  void run(HostPort& host) override { raster_primitives::run(host, prepared_, programs_, site_); }

  ErrorReport compare(const MachineView& machine) const override {
    DENDRO_CHECK(machine.width == prepared_.width && machine.height == prepared_.height, "the monitor shows {}x{}",
                 machine.width, machine.height);
    const Reference wanted = render_reference(prepared_);
    const std::vector<std::uint32_t> depth = depths(machine);
    std::vector<std::uint32_t> shadow(depth.size());
    if (prepared_.layout.shadows) shadow = lib::pixel_field(machine, site_, prepared_.layout.seen, 1);
    ErrorReport report;
    const auto width = static_cast<std::size_t>(prepared_.width);
    const Texels texels = compare_texels(machine, wanted, shadow);
    double squares = 0, worst_colour = 0, worst_shift = 0, worst_sphere = 0;
    std::int64_t inner = 0, wrong_shadows = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const bool covered = depth[i] != prepared_.farthest, wanted_covered = wanted.seen[i] >= 0;
      report.covered_pixels += wanted_covered;
      report.wrong_pixels += covered != wanted_covered;
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = machine.rgb[3 * i + c] - std::round(wanted.rgb[3 * i + c]);
        squares += difference * difference;
        if (wanted.inner[i] && (shadow[i] != 0) == wanted.shadow[i] && !texels.other[i])
          worst_colour = std::max(worst_colour, std::abs(machine.rgb[3 * i + c] - wanted.rgb[3 * i + c]));
      }
      if (!wanted.inner[i]) continue;
      ++inner;
      wrong_shadows += (shadow[i] != 0) != wanted.shadow[i];
      if (const ScreenSphere* sphere = sphere_of(wanted.seen[i])) {
        worst_sphere = std::max(worst_sphere, std::abs(depth[i] - wanted.depth[i]) / sphere->depth_radius);
        continue;
      }
      const double error = std::abs(depth[i] + 0.5 - wanted.depth[i]);
      report.max_depth_error = std::max(report.max_depth_error, error);
      // A corner that was moved moves the depth by so many pixels' worth of its slope.
      const double slope = std::abs(wanted.depth[i + 1] - wanted.depth[i - 1]) / 2 +
                           std::abs(wanted.depth[i + width] - wanted.depth[i - width]) / 2;
      if (error > kRounding) worst_shift = std::max(worst_shift, (error - kRounding) / slope);
    }
    report.psnr_db = scene::psnr(squares, 3 * depth.size());
    report.extra = {{"inner_pixels", static_cast<double>(inner)},
                    {"inner_colour_error", worst_colour},
                    {"inner_depth_error_pixels", worst_shift},
                    {"inner_sphere_depth_error_radii", worst_sphere},
                    {"inner_wrong_shadows", static_cast<double>(wrong_shadows)}};
    if (prepared_.layout.texture_bits > 0)
      for (const auto& figure : texels.figures) report.extra.push_back(figure);
    return report;
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    const Reference wanted = render_reference(prepared_);
    std::vector<Layer> layers = lib::picture_layers(
        machine, depths(machine), {"reference.R", "reference.G", "reference.B", "reference.Z", "reference.seen"});
    for (std::size_t i = 0; i < wanted.depth.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) layers[4 + c].values[i] = static_cast<float>(wanted.rgb[3 * i + c] / 255);
      layers[7].values[i] = static_cast<float>(wanted.depth[i]);
      layers[8].values[i] = static_cast<float>(wanted.seen[i] + 1);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return prepared_.files; }

  std::vector<FirmwareImage> firmware() const override { return {lib::firmware_image(programs_)}; }

  std::vector<std::pair<std::string, double>> facts() const override {
    const auto count = [](auto n) { return static_cast<double>(n); };
    return {{"triangles", count(prepared_.set_up.size())},
            {"triangles.given", count(prepared_.given)},
            {"triangles.facing_away", count(prepared_.facing_away)},
            {"triangles.outside", count(prepared_.outside)},
            {"triangles.without_area", count(prepared_.without_area)},
            {"triangles.flat", count(prepared_.flat)},
            {"tiles", count(prepared_.tiles.size())},
            {"depth_bits", count(prepared_.layout.depth_bits)},
            {"memory_bits_used", count(prepared_.layout.used())},
            {"texels", count(prepared_.texture.rgb.size())},
            {"shadows", count(prepared_.shadows.size())},
            {"spheres", count(prepared_.spheres.size())},
            {"spheres.given", count(prepared_.spheres_given)},
            {"host.flops_per_spheres", sphere_flops()},
            {"host.flops_per_triangles",
             triangle_flops() + count(prepared_.vertex_flops + kFlopsShadow * prepared_.shadows.size()) /
                                         std::max<double>(1, count(prepared_.set_up.size()))}};
  }

 private:
  struct Texels {
    std::vector<bool> other;  ///< the pixel shows another texel than the reference
    std::vector<std::pair<std::string, double>> figures;
  };

  /// A pixel keeps a whole texel; the reference's point must lie in it, but for the roundings of coefficients.
  Texels compare_texels(const MachineView& machine, const Reference& wanted, const std::vector<std::uint32_t>& shadow) const {
    const Layout& layout = prepared_.layout;
    Texels out;
    out.other.resize(wanted.textured.size());
    if (layout.texture_bits == 0) return out;
    const auto shows = lib::pixel_field(machine, site_, layout.texel, 1);
    const std::array<std::vector<std::uint32_t>, 2> kept = {
        lib::pixel_field(machine, site_, layout.texel + 1, layout.texture_bits),
        lib::pixel_field(machine, site_, layout.texel_v(), layout.texture_bits)};
    const auto width = static_cast<std::size_t>(prepared_.width);
    double pixels = 0, wrong_colours = 0, others = 0, beyond = 0, worst = 0;
    for (std::size_t i = 0; i < shows.size(); ++i) {
      pixels += shows[i];
      if (shows[i] != 0) {
        const std::uint32_t rgb = prepared_.texture.at(kept[0][i], kept[1][i]);
        bool right = true;
        for (unsigned c = 0; c < 3; ++c) right = right && machine.rgb[3 * i + c] == (rgb >> (8 * c) & 255) >> shadow[i];
        wrong_colours += !right;
      }
      if (!wanted.inner[i] || !wanted.textured[i]) continue;
      bool far = shows[i] == 0;
      for (int k = 0; k < 2; ++k) {
        const auto at = [&](std::size_t pixel) { return wanted.texel[pixel][k]; };
        const double error = outside(at(i), kept[static_cast<std::size_t>(k)][i], prepared_.texture.side());
        out.other[i] = out.other[i] || error > 0;
        worst = std::max(worst, error);
        const double a = (at(i + 1) - at(i - 1)) / 2, b = (at(i + width) - at(i - width)) / 2;
        far = far || error > texel_rounding(a, b, at(i), prepared_.rules);
      }
      others += out.other[i];
      beyond += far;
    }
    out.figures = {{"texture_pixels", pixels},
                   {"texture_wrong_colours", wrong_colours},
                   {"inner_other_texels", others},
                   {"inner_texel_error", worst},
                   {"inner_texels_beyond_rounding", beyond}};
    return out;
  }

  /// How far `value` lies outside [texel, texel + 1), modulo `side`.
  static double outside(double value, std::uint32_t texel, int side) {
    double from = std::fmod(value - texel, side);
    if (from < 0) from += side;
    return from < 1 ? 0 : std::min(from - 1, side - from);
  }

  double triangle_flops() const {
    double sum = 0;
    for (const TriangleSetup& triangle : prepared_.set_up) sum += static_cast<double>(flops_of(triangle));
    return sum / std::max<double>(1, static_cast<double>(prepared_.set_up.size()));
  }

  double sphere_flops() const {
    double sum = 0;
    for (const SphereSetup& sphere : prepared_.sphere_set_up) sum += static_cast<double>(flops_of(sphere));
    return sum / std::max<double>(1, static_cast<double>(prepared_.sphere_set_up.size()));
  }

  const ScreenSphere* sphere_of(std::int32_t number) const {
    const auto triangles = static_cast<std::int32_t>(prepared_.triangles.size());
    return number < triangles ? nullptr : &prepared_.spheres[static_cast<std::size_t>(number - triangles)];
  }

  std::vector<std::uint32_t> depths(const MachineView& machine) const {
    return lib::pixel_field(machine, site_, prepared_.layout.depth, prepared_.layout.depth_bits);
  }

  Prepared prepared_;
  lib::IgcPrograms programs_;
  ArraySite site_;
};

}  // namespace

std::unique_ptr<Job> make_job(const scene::Scene& scene, lib::IgcPrograms programs, const ArraySite& site) {
  return std::make_unique<PrimitivesJob>(scene, std::move(programs), site);
}

}  // namespace dendro::raster_primitives
