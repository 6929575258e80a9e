#include "firmware/adaptive_equalisation/job.h"

#include "firmware/adaptive_equalisation/host/host_program.h"
#include "firmware/adaptive_equalisation/reference/reference.h"
#include "sim/base/check.h"
#include "sim/scene/psnr.h"

namespace dendro::adaptive_equalisation {
namespace {

class EqualisationJob : public Job {
 public:
  EqualisationJob(const scene::Scene& scene, lib::IgcPrograms programs, const lib::ArraySite& site)
      : prepared_(prepare(scene, site)), programs_(std::move(programs)), site_(site) {}

  void run(HostPort& host) override { adaptive_equalisation::run(host, prepared_, programs_, site_); }

  ErrorReport compare(const MachineView& machine) const override {
    DENDRO_CHECK(machine.width == prepared_.width && machine.height == prepared_.height, "the monitor shows {}x{}",
                 machine.width, machine.height);
    const std::vector<std::uint32_t> wanted = wanted_ranks(), found = found_ranks(machine);
    ErrorReport report;
    report.reference = "integer";
    report.covered_pixels = static_cast<std::int64_t>(wanted.size());
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto level = static_cast<std::uint8_t>(wanted[i] >> (prepared_.layout.rank_bits - 8));
      rgb.insert(rgb.end(), 3, level);
      report.wrong_pixels += found[i] != wanted[i];
    }
    report.psnr_db = scene::psnr(rgb, machine.rgb);
    return report;
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    const std::vector<std::uint32_t> wanted = wanted_ranks();
    std::vector<Layer> layers = lib::picture_layers(machine, found_ranks(machine), {"input.Y", "reference.rank"});
    const double most = static_cast<double>((1u << prepared_.layout.grey_bits) - 1);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      layers[4].values[i] = static_cast<float>(prepared_.grey[i] / most);
      layers[5].values[i] = static_cast<float>(wanted[i]);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return {}; }

  std::vector<FirmwareImage> firmware() const override { return {lib::firmware_image(programs_)}; }

  std::vector<std::pair<std::string, double>> facts() const override {
    const auto count = [](auto n) { return static_cast<double>(n); };
    return {{"pixels", count(prepared_.grey.size())},
            {"rows", count(prepared_.height)},
            {"region", count(prepared_.region)},
            {"grey_bits", count(prepared_.layout.grey_bits)},
            {"rank_bits", count(prepared_.layout.rank_bits)},
            {"memory_bits_used", count(prepared_.layout.used())},
            {"host.instructions_per_pixels", count(kInstructionsGrey + kInstructionsBound)}};
  }

 private:
  std::vector<std::uint32_t> wanted_ranks() const {
    return ranks(prepared_.grey, prepared_.width, prepared_.height, prepared_.region);
  }
  std::vector<std::uint32_t> found_ranks(const MachineView& machine) const {
    return lib::pixel_field(machine, site_, prepared_.layout.rank(), prepared_.layout.rank_bits);
  }

  Prepared prepared_;
  lib::IgcPrograms programs_;
  lib::ArraySite site_;
};

}  // namespace

std::unique_ptr<Job> make_job(const scene::Scene& scene, lib::IgcPrograms programs, const lib::ArraySite& site) {
  return std::make_unique<EqualisationJob>(scene, std::move(programs), site);
}

}  // namespace dendro::adaptive_equalisation
