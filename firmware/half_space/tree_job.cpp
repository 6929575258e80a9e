#include "firmware/half_space/host/hulls_program.h"
#include "firmware/half_space/host/tree_program.h"
#include "firmware/half_space/hulls_facts.h"
#include "firmware/half_space/job.h"
#include "firmware/half_space/nearest_register.h"
#include "firmware/half_space/reference/texture_model.h"
#include "firmware/half_space/reference/tree_reference.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

class TreeJob : public Job {
 public:
  TreeJob(const scene::Scene& scene, const ProgramSource& program, const Site& site)
      : tree_(prepare_tree(scene, site.pixel_bits)), site_{site.control_store_words, site.repeat_field} {
    programs_.hulls = program("hulls");
    check_fits(tree_.hulls, programs_.hulls, site.scratch_words, scene.objects[0].source_where);
    if (tree_.rough()) programs_.roughen = program("roughen");
    if (!tree_.textured()) return;
    if (!tree_.texture.from_host) programs_.texture = program("texture");
    programs_.colour = program("colour");
    cube_ = make_texture(tree_.texture);
  }

  void run(HostPort& host) override {
    half_space::run(host, tree_, programs_, cube_, site_, [&] {
      nearest_ = nearest_register(width(), height(), [&](std::uint32_t address, unsigned function) {
        return host.peek(address, function);
      });
    });
  }

  ErrorReport compare(const MachineView& machine) const override {
    check_view(machine);
    return half_space::compare(tree_, render_tree_reference(tree_, cube_), cube_, nearest_, machine.rgb);
  }

  std::vector<Layer> layers(const MachineView& machine) const override {
    check_view(machine);
    const HullsReference wanted = render_tree_reference(tree_, cube_);
    std::vector<Layer> layers;
    for (const char* name :
         {"R", "G", "B", "Z", "reference.R", "reference.G", "reference.B", "reference.Z", "reference.hull"})
      layers.push_back({name, std::vector<float>(nearest_.size())});
    for (std::size_t i = 0; i < nearest_.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        layers[c].values[i] = static_cast<float>(machine.rgb[3 * i + c]) / 255.0f;
        layers[4 + c].values[i] = static_cast<float>(wanted.rgb[3 * i + c]) / 255.0f;
      }
      layers[3].values[i] = nearest_[i];
      layers[7].values[i] = static_cast<float>(wanted.depth[i]);
      layers[8].values[i] = static_cast<float>(wanted.hull[i] + 1);
    }
    return layers;
  }

  std::vector<std::string> input_files() const override { return tree_.hulls.files; }

  std::vector<FirmwareImage> firmware() const override {
    std::vector<FirmwareImage> images;
    for (const ProgramImage* image :
         {&programs_.hulls, &programs_.roughen, &programs_.texture, &programs_.colour})
      if (!image->words.empty()) images.push_back({image->name, image->sha256, image->symbols});
    return images;
  }

  std::vector<std::pair<std::string, double>> facts() const override {
    auto facts = hulls_facts(tree_.hulls);
    std::size_t planes = 0, visible = 0;
    for (const Trunk& trunk : tree_.hulls.trunks) {
      const PlaneProgram& program = trunk.hull.program;
      planes += program.back.size() + program.edge_on.size() + program.front.size();
      visible += trunk.visible();
    }
    facts.emplace_back("trunks", static_cast<double>(tree_.hulls.trunks.size()));
    facts.emplace_back("trunks.visible", static_cast<double>(visible));
    facts.emplace_back("trunks.planes", static_cast<double>(planes));
    if (tree_.textured()) {
      facts.emplace_back("texture.side", 1 << tree_.texture.bits);
      facts.emplace_back("texture.level", tree_.colour.level);
    }
    return facts;
  }

 private:
  int width() const { return tree_.hulls.width; }
  int height() const { return tree_.hulls.height; }

  void check_view(const MachineView& machine) const {
    DENDRO_CHECK(machine.width == width() && machine.height == height(), "the monitor shows {}x{}",
                 machine.width, machine.height);
    DENDRO_CHECK(!nearest_.empty(), "the job has not run");
  }

  PreparedTree tree_;
  TreePrograms programs_;
  CubeBytes cube_;
  TreeSite site_;
  std::vector<std::uint8_t> nearest_;  ///< of every pixel, before colour took its place
};

}  // namespace

std::unique_ptr<Job> make_tree_job(const scene::Scene& scene, const ProgramSource& program,
                                   const Site& site) {
  return std::make_unique<TreeJob>(scene, program, site);
}

}  // namespace dendro::half_space
