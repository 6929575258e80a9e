#include "sim/study/primitives.h"

#include <string_view>

#include "firmware/raster_primitives/host/host_program.h"
#include "firmware/raster_primitives/job.h"
#include "sim/study/igc_programs.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "pixel-planes";

lib::IgcPrograms programs_for(const raster_primitives::Layout& layout, const tools::IgcOptions& options) {
  std::vector<std::string> sources = {"firmware/raster_primitives/pixel_planes/triangles.igc"};
  if (layout.has_spheres()) sources.push_back("firmware/raster_primitives/pixel_planes/spheres.igc");
  if (layout.shadows) sources.push_back("firmware/raster_primitives/pixel_planes/shadows.igc");
  if (layout.texture_bits > 0) sources.push_back("firmware/raster_primitives/pixel_planes/textures.igc");
  return igc_programs(sources, options);
}

std::unique_ptr<Job> make_primitives(const scene::Scene& scene, const MachineType&,
                                     const config::ParameterSet& parameters) {
  const lib::ArraySite site = array_site(parameters);
  tools::IgcOptions options;
  options.memory_bits = site.memory_bits;
  const raster_primitives::Layout layout = raster_primitives::choose_layout(scene, site);
  options.registers = raster_primitives::register_values(layout);
  return raster_primitives::make_job(scene, programs_for(layout, options), site);
}

}  // namespace

Algorithm raster_primitives_algorithm() {
  return {"raster_primitives",
          "smooth triangles, spheres, shadows and textures with depths in pixel memory (FGHS85)",
          {kMachine},
          "firmware/raster_primitives",
          make_primitives,
          {"depth_bits", "fraction_bits", "patch_steps", "cull", "colours", "background", "spheres", "sphere_digits", "shadows",
           "texture", "texture_size", "texture_seed", "textured"}};
}

std::vector<Firmware> raster_primitives_firmware() {
  std::vector<Firmware> list;
  // The machine's memory holds either what spheres keep in a pixel or what textures do.
  for (const bool shadows : {false, true})
    for (const char* more : {"", "spheres", "texture"}) {
      raster_primitives::Layout layout;
      layout.shadows = shadows;
      if (std::string_view(more) == "spheres") layout.square_bits = raster_primitives::square_bits_for(512, 512);
      if (std::string_view(more) == "texture") layout.place_texture(6);
      const lib::IgcPrograms programs = programs_for(layout, {});
      list.push_back({"raster_primitives", kMachine, programs.name, "1p", programs.sha256, programs.words.size()});
    }
  return list;
}

}  // namespace dendro::study
