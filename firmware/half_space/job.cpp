#include "firmware/half_space/job.h"

#include <algorithm>

#include "firmware/half_space/host/host_program.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "firmware/half_space/reference/reference.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

class HalfSpaceJob : public Job {
 public:
  HalfSpaceJob(const scene::Scene& scene, ProgramImage image, const Site& site)
      : prepared_(prepare(scene)), image_(std::move(image)), site_(site) {
    check_fits(prepared_, image_, site.scratch_words, scene.objects[0].source_where);
  }

  void run(HostPort& host) override { half_space::run(host, prepared_, image_, site_.repeat_field); }

  ErrorReport compare(const MachineView& machine) const override {
    DENDRO_CHECK(machine.width == width() && machine.height == height(), "the monitor shows {}x{}",
                 machine.width, machine.height);
    ErrorReport report = half_space::compare(reference(), read_back(machine, width(), height()), machine.rgb);
    const UnboundedPixels open = count_unbounded(prepared_.screen, width(), height(), prepared_.program.maxdepth);
    report.extra.emplace_back("unbounded_pixels", static_cast<double>(open.unbounded));
    report.extra.emplace_back("unbounded_share", open.share());
    return report;
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    const std::size_t pixels = static_cast<std::size_t>(width()) * height();
    std::vector<Layer> layers;
    for (const char* name : {"R", "G", "B", "Z", "face", "reference.Z", "reference.face"})
      layers.push_back({name, std::vector<float>(pixels)});
    const SimulatedPicture simulated = read_back(machine, width(), height());
    const ReferencePicture wanted = reference();
    for (std::size_t i = 0; i < pixels; ++i) {
      for (int c = 0; c < 3; ++c) layers[c].values[i] = static_cast<float>(machine.rgb[3 * i + c]) / 255.0f;
      layers[3].values[i] = simulated.face[i] != 0 ? static_cast<float>(simulated.front[i])
                                                   : static_cast<float>(prepared_.program.maxdepth);
      layers[4].values[i] = simulated.face[i];
      layers[5].values[i] = wanted.face[i] != 0 ? static_cast<float>(wanted.depth[i])
                                                : static_cast<float>(prepared_.program.maxdepth);
      layers[6].values[i] = wanted.face[i];
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return prepared_.files; }

  std::vector<FirmwareImage> firmware() const override {
    return {{image_.name, image_.sha256, image_.symbols}};
  }

  std::vector<std::pair<std::string, double>> facts() const override {
    const PlaneProgram& program = prepared_.program;
    const auto count = [](std::size_t n) { return static_cast<double>(n); };
    return {{"planes.back", count(program.back.size())},
            {"planes.edge_on", count(program.edge_on.size())},
            {"planes.front", count(program.front.size())},
            {"planes.wide", count(program.wide_records())},
            {"box.width", static_cast<double>(program.box.width())},
            {"box.height", static_cast<double>(program.box.height())},
            {"max_depth", static_cast<double>(program.maxdepth)},
            {"host.flops", static_cast<double>(prepared_.setup_flops)},
            {"host.growth_flops", static_cast<double>(prepared_.growth.flops)}};
  }

 private:
  int width() const { return prepared_.program.width; }
  int height() const { return prepared_.program.height; }

  ReferencePicture reference() const {
    return render_reference(prepared_.screen, prepared_.program.shades, width(), height(),
                            prepared_.program.maxdepth);
  }

  Prepared prepared_;
  ProgramImage image_;
  Site site_;
};

}  // namespace

std::unique_ptr<Job> make_job(const scene::Scene& scene, ProgramImage image, const Site& site) {
  return std::make_unique<HalfSpaceJob>(scene, std::move(image), site);
}

}  // namespace dendro::half_space
