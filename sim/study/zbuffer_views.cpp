#include "sim/study/zbuffer_views.h"

#include "firmware/zbuffer_views/job.h"
#include "sim/base/sha256.h"
#include "sim/study/workstation.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "sgi-4d35";
constexpr const char* kPrograms[] = {"zbuffer_views_precompute", "zbuffer_views_reconstruct", "zbuffer_views_polygons"};
const char* const kVariants[] = {"", "-unmapped", "-O1", "-fcr31"};

std::unique_ptr<Job> make_zbuffer_views(const scene::Scene& scene, const MachineType&, const config::ParameterSet&) {
  zbuffer_views::Programs programs;
  programs.suffix = zbuffer_views::program_suffix(scene);
  for (const char* program : kPrograms) {
    const std::string name = program + programs.suffix;
    programs.images.push_back({name, base::sha256(shipped_program(name)), {}});
  }
  return zbuffer_views::make_job(scene, std::move(programs));
}

}  // namespace

Algorithm zbuffer_views_algorithm() {
  Algorithm algorithm = {"zbuffer_views",
                         "trees from precomputed z-buffer views of several layers (MO95)",
                         {kMachine},
                         "firmware/zbuffer_views",
                         make_zbuffer_views};
  algorithm.option_keys = {"bands",       "layers",       "view_width",   "view_height", "threshold",   "pitch",        "rule",
                           "leaf_side",   "diffuse",      "frames",       "turn",        "turns",       "shadows",      "light_width",
                           "light_height", "epsilon",     "reuse_light",  "draw",        "precompute",  "views",        "save_views",
                           "near",        "background",   "leaf_colour",  "leaf_below",  "trunk_colour", "branch_colour", "skip_empty",
                           "full_product", "compiler",    "mapped"};
  algorithm.path_keys = {"views"};
  return algorithm;
}

std::vector<Firmware> zbuffer_views_firmware() {
  std::vector<Firmware> list;
  for (const char* program : kPrograms)
    for (const char* variant : kVariants) {
      const std::string bytes = shipped_program(std::string(program) + variant);
      list.push_back({program, kMachine, "firmware/zbuffer_views/sgi_4d35", *variant == 0 ? "-O2" : variant, base::sha256(bytes), bytes.size() / 4});
    }
  return list;
}

}  // namespace dendro::study
