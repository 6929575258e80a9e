#include "firmware/half_space/host/roughen_program.h"

#include <cmath>

#include "firmware/half_space/host/seeds.h"
#include "sim/base/check.h"

namespace dendro::half_space {

RoughenSettings read_roughen(scene::Options& options) {
  RoughenSettings settings;
  settings.roughness = options.real("roughness", 0, 0, 1);
  settings.hurst = options.real("roughness_hurst", 0.5, 0.05, 1);
  return settings;
}

Roughening make_roughening(const RoughenSettings& settings, double extent, const Box& box, int maxdepth,
                           std::uint64_t seed, std::uint64_t stream) {
  DENDRO_CHECK(extent >= 0 && extent < 256 && settings.roughness >= 0 && settings.roughness <= 1, "{} {}",
               extent, settings.roughness);
  Roughening roughening;
  roughening.box = box;
  roughening.maxdepth = maxdepth;
  for (int stage = 0; stage < kTileStages; ++stage) {
    const double amplitude = settings.roughness * extent * std::exp2(-settings.hurst / 2 * stage);
    const auto word = std::llround(std::ldexp(amplitude, kAmplitudeFractionBits));
    roughening.amplitudes.push_back(static_cast<std::uint32_t>(std::min<long long>(word, 0x7FFF)));
  }
  roughening.seeds = seed_table(seed, stream, seeds_for(kTileDraws));
  return roughening;
}

void run_roughen(lib::RdsDriver& driver, const lib::ProgramImage& image, const Roughening& roughening) {
  const Box& box = roughening.box;
  const auto write = [&](const char* name, const std::vector<std::uint32_t>& words) {
    const lib::ScratchArea& area = image.scratch.at(name);
    DENDRO_CHECK(words.size() <= area.size, "{} {}", name, words.size());
    driver.write_scratch(area.address, words);
  };
  write("box", {static_cast<std::uint32_t>(box.x0), static_cast<std::uint32_t>(box.y0),
                static_cast<std::uint32_t>(box.x1), static_cast<std::uint32_t>(box.y1)});
  write("params", {static_cast<std::uint32_t>(roughening.maxdepth)});
  write("amplitudes", roughening.amplitudes);
  write("seeds", roughening.seeds);
  driver.start(image.entry);
  driver.wait();
}

}  // namespace dendro::half_space
