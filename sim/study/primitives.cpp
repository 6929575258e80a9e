#include "sim/study/primitives.h"

#include "firmware/raster_primitives/host/host_program.h"
#include "firmware/raster_primitives/job.h"
#include "sim/study/igc_programs.h"

namespace dendro::study {
namespace {

std::unique_ptr<Job> make_primitives(const scene::Scene& scene, const MachineType&,
                                     const config::ParameterSet& parameters) {
  raster_primitives::ArraySite site;
  site.width = static_cast<int>(integer_of(parameters, "array.width"));
  site.height = static_cast<int>(integer_of(parameters, "array.height"));
  site.memory_bits = static_cast<int>(integer_of(parameters, "array.memory_bits"));
  tools::IgcOptions options;
  options.memory_bits = site.memory_bits;
  const raster_primitives::Layout layout = raster_primitives::choose_layout(scene, site);
  options.registers = raster_primitives::register_values(layout);
  std::vector<std::string> sources = {"firmware/raster_primitives/pixel_planes/triangles.igc"};
  if (layout.has_spheres()) sources.push_back("firmware/raster_primitives/pixel_planes/spheres.igc");
  if (layout.shadows) sources.push_back("firmware/raster_primitives/pixel_planes/shadows.igc");
  return raster_primitives::make_job(scene, igc_programs(sources, options), site);
}

}  // namespace

Algorithm raster_primitives_algorithm() {
  return {"raster_primitives",
          "smooth triangles, spheres and shadows with depths in pixel memory (FGHS85)",
          {"pixel-planes"},
          "firmware/raster_primitives",
          make_primitives,
          {"depth_bits", "fraction_bits", "patch_steps", "cull", "colours", "background", "spheres", "sphere_digits", "shadows"}};
}

}  // namespace dendro::study
