#include "firmware/half_space/host/hulls_program.h"
#include "firmware/half_space/hulls_facts.h"
#include "firmware/half_space/job.h"
#include "firmware/half_space/nearest_register.h"
#include "firmware/half_space/reference/hulls_reference.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

class HullsJob : public Job {
 public:
  HullsJob(const scene::Scene& scene, ProgramImage image, const Site& site)
      : prepared_(prepare_hulls(scene)), image_(std::move(image)), site_(site) {
    check_fits(prepared_, image_, site.scratch_words, scene.objects[0].source_where);
  }

  void run(HostPort& host) override { half_space::run(host, prepared_, image_, site_.repeat_field); }

  ErrorReport compare(const MachineView& machine) const override {
    DENDRO_CHECK(machine.width == prepared_.width && machine.height == prepared_.height,
                 "the monitor shows {}x{}", machine.width, machine.height);
    return half_space::compare(render_hulls_reference(prepared_), nearest_of(machine), prepared_.maxdepth,
                               machine.rgb);
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    const std::vector<std::uint8_t> nearest = nearest_of(machine);
    const HullsReference wanted = render_hulls_reference(prepared_);
    std::vector<Layer> layers;
    for (const char* name : {"R", "G", "B", "Z", "reference.Z", "reference.hull"})
      layers.push_back({name, std::vector<float>(nearest.size())});
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      for (int c = 0; c < 3; ++c) layers[c].values[i] = static_cast<float>(machine.rgb[3 * i + c]) / 255.0f;
      layers[3].values[i] = nearest[i];
      layers[4].values[i] = static_cast<float>(wanted.depth[i]);
      layers[5].values[i] = static_cast<float>(wanted.hull[i] + 1);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return prepared_.files; }

  std::vector<FirmwareImage> firmware() const override {
    return {{image_.name, image_.sha256, image_.symbols}};
  }

  std::vector<std::pair<std::string, double>> facts() const override { return hulls_facts(prepared_); }

 private:
  std::vector<std::uint8_t> nearest_of(const MachineView& machine) const {
    return nearest_register(prepared_.width, prepared_.height, machine.peek);
  }

  PreparedHulls prepared_;
  ProgramImage image_;
  Site site_;
};

}  // namespace

std::vector<std::pair<std::string, double>> hulls_facts(const PreparedHulls& prepared) {
  std::size_t back = 0, edge_on = 0, front = 0, wide = 0, visible = 0, unbounded = 0;
  for (const Hull& hull : prepared.hulls) {
    back += hull.program.back.size(), edge_on += hull.program.edge_on.size();
    front += hull.program.front.size(), wide += hull.program.wide_records();
    visible += hull.visible, unbounded += !hull.bounded;
  }
  const auto count = [](auto n) { return static_cast<double>(n); };
  return {{"hulls", count(prepared.hulls.size())},
          {"hulls.visible", count(visible)},
          {"hulls.unbounded", count(unbounded)},
          {"planes.back", count(back)},
          {"planes.edge_on", count(edge_on)},
          {"planes.front", count(front)},
          {"planes.wide", count(wide)},
          {"max_depth", count(prepared.maxdepth)},
          {"splits", count(prepared.splits)},
          {"host.flops", count(prepared.setup_flops)},
          {"host.growth_flops", count(prepared.growth.flops)}};
}

std::unique_ptr<Job> make_hulls_job(const scene::Scene& scene, ProgramImage image, const Site& site) {
  return std::make_unique<HullsJob>(scene, std::move(image), site);
}

}  // namespace dendro::half_space
