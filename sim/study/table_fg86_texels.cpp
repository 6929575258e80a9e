#include <fmt/format.h>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "sim/study/igc_programs.h"
#include "sim/study/table_fg86.h"
#include "sim/study/table_probe.h"

namespace dendro::study {
namespace {

constexpr const char* kProgram = "firmware/half_space/pixel_planes/texels.igc";
constexpr unsigned kTexels = 8192, kCoordinateBits = 15, kColourLow = kCoordinateBits;
constexpr double kCube = 32768, kFrames = 60;

/// Sends a quarter of a cube's texels, one command each.
class TexelsJob : public Job {
 public:
  explicit TexelsJob(const config::ParameterSet& parameters) {
    tools::IgcOptions options;
    options.ports = static_cast<int>(integer_of(parameters, "array.ports"));
    options.memory_bits = static_cast<int>(integer_of(parameters, "array.memory_bits"));
    options.registers = {{"coordinates", 0}, {"colour", kColourLow}};
    programs_ = igc_programs({kProgram}, options);
  }

  void run(HostPort& host) override {
    lib::IgcDriver driver(host, programs_);
    host.phase("load_program");
    driver.load();
    host.phase("texels");
    driver.set_register("coordinates", 0);
    driver.set_register("colour", kColourLow);
    for (std::uint64_t texel = 0; texel < kTexels; ++texel)
      driver.run("texel", texel | (texel * 0x10421 & 0xFFFFFF) << kCoordinateBits);
    driver.wait();
  }

  ErrorReport compare(const MachineView&) const override { return {}; }
  std::vector<Layer> layers(const MachineView&) const override { return {}; }
  std::vector<std::string> input_files() const override { return {}; }
  std::vector<FirmwareImage> firmware() const override { return {{programs_.name, programs_.sha256, {}}}; }
  std::vector<std::pair<std::string, double>> facts() const override { return {}; }

 private:
  lib::IgcPrograms programs_;
};

double texels_a_frame(const stats::RunObject& run) {
  double seconds = 0;
  for (const stats::PhaseRow& p : run.phases) seconds += p.name == "load_program" ? 0 : p.seconds;
  return kTexels / seconds / kFrames;
}

void fill_texels(const TableContext& context, std::vector<TableRow>& rows) {
  const ProbeRequest probe(context, "FG86 texels", "pixel-planes", [](const config::ParameterSet& parameters) {
    return std::make_unique<TexelsJob>(parameters);
  });
  const std::vector<Metric> metrics = {{"texels", texels_a_frame}};
  const Propagated p = propagate_request(context, probe.request(), metrics, "FG86 texels");
  set_metric(rows[0], p, metrics, 0);
  rows[0].assumptions.insert(rows[0].assumptions.begin(), "DEV-091");
  rows[0].note = fmt::format(
      "{:.1f} clocks a texel, whatever number of pixels shows it; the {:.0f} of a cube take {:.1f} frames. Needs {} bits of "
      "coordinates a pixel, which 72 do not hold beside three depths of 16 and a colour",
      p.nominal.clock_hz / kFrames / *rows[0].simulated, kCube, kCube / *rows[0].simulated, kCoordinateBits);
}

}  // namespace

std::vector<RowGroup> fg86_texels_groups() {
  return {{"texels.igc on Pixel-Planes, nominal and over every assumption",
           {claim("FG86-A28c", "texels sent in 1/60 s, Pixel-Planes", "1", 4900.0,
                  "the STINT's 70x70 in real time; on Pixel-Planes every texel goes to all pixels that show it")},
           fill_texels}};
}

}  // namespace dendro::study
