#include "sim/study/equalisation.h"

#include "firmware/adaptive_equalisation/job.h"
#include "sim/study/igc_programs.h"

namespace dendro::study {
namespace {

constexpr const char* kMachine = "pixel-planes";

lib::IgcPrograms programs_for(const tools::IgcOptions& options) {
  return igc_programs({"firmware/adaptive_equalisation/pixel_planes/equalise.igc"}, options);
}

std::unique_ptr<Job> make_equalisation(const scene::Scene& scene, const MachineType&, const config::ParameterSet& parameters) {
  const lib::ArraySite site = array_site(parameters);
  tools::IgcOptions options;
  options.memory_bits = site.memory_bits;
  options.registers = adaptive_equalisation::choose_layout(scene, site).registers();
  return adaptive_equalisation::make_job(scene, programs_for(options), site);
}

}  // namespace

Algorithm equalisation_algorithm() {
  return {"adaptive_equalisation",
          "grey values become ranks among the pixels around them (FGHS85)",
          {kMachine},
          "firmware/adaptive_equalisation",
          make_equalisation,
          {"grey_bits", "region", "method"}};
}

Firmware equalisation_firmware() {
  const lib::IgcPrograms programs = programs_for({});
  return {"adaptive_equalisation", kMachine, programs.name, "1p", programs.sha256, programs.words.size()};
}

}  // namespace dendro::study
