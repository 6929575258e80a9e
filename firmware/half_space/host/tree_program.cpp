#include "firmware/half_space/host/tree_program.h"

#include "firmware/half_space/host/host_program.h"
#include "firmware/half_space/host/hulls_program.h"
#include "firmware/half_space/host/texture_program.h"
#include "firmware/lib/rds3000/overlays.h"

namespace dendro::half_space {
namespace {

/// Entry i is grey level i, so that each channel shows its own byte of the pixel.
std::vector<Rgb> straight_table() {
  std::vector<Rgb> levels;
  for (int i = 0; i < 256; ++i) {
    const auto level = static_cast<std::uint8_t>(i);
    levels.push_back({level, level, level});
  }
  return levels;
}

class TreeRun {
 public:
  TreeRun(HostPort& host, const PreparedTree& tree, const TreePrograms& programs, const TreeSite& site)
      : host_(host),
        tree_(tree),
        programs_(programs),
        driver_(host),
        overlays_(driver_, site.control_store_words),
        hulls_(host, driver_, programs.hulls) {}

  void make_texture(const CubeBytes& cube) {
    if (tree_.texture.from_host)
      send(host_, cube, tree_.layout);
    else
      build(host_, driver_, ready(programs_.texture), tree_.texture, tree_.layout);
  }

  void show(bool repeat_field) {
    host_.phase("load_tables");
    driver_.write_look_up_table(look_up_table(tree_.textured() ? straight_table() : tree_.hulls.shades));
    if (tree_.textured())
      driver_.show_colour();
    else
      driver_.show_byte(kNearestLow);
    driver_.set_viewport(tree_.hulls.width, tree_.hulls.height, repeat_field);
  }

  void draw_crowns() {
    activate_hulls();
    hulls_.clear(tree_.hulls.width, tree_.hulls.height, tree_.hulls.maxdepth);
    for (std::size_t i = 0; i < tree_.hulls.hulls.size(); ++i) {
      const Hull& hull = tree_.hulls.hulls[i];
      if (!hull.visible) continue;
      if (!tree_.rough()) {
        hulls_.draw(hull.program, HullAction::kPassesAndMerge);
        continue;
      }
      hulls_.draw(hull.program, HullAction::kPasses);
      const std::optional<Box> box = hulls_.box_left();
      if (!box) continue;
      roughen(tree_.roughenings[i], *box);
      activate_hulls();
      hulls_.merge(hull.program, *box);
    }
  }

  void draw_trunks() {
    for (const Trunk& trunk : tree_.hulls.trunks) {
      if (!trunk.visible()) continue;
      if (trunk.painter)
        hulls_.paint(trunk.trapezium, tree_.hulls.maxdepth);
      else
        hulls_.draw(trunk.hull.program, HullAction::kTrunk);
    }
  }

  void colour() {
    const lib::ProgramImage image = ready(programs_.colour);
    host_.phase("load_colouring");
    run_colour(driver_, image, tree_.colouring);
  }

 private:
  /// The program where it can be started.
  lib::ProgramImage ready(const lib::ProgramImage& image) {
    host_.phase("load_program");
    lib::ProgramImage placed;
    placed.name = image.name, placed.scratch = image.scratch;
    placed.entry = overlays_.activate(image);
    return placed;
  }

  void activate_hulls() { hulls_.set_entry(ready(programs_.hulls).entry); }

  void roughen(Roughening roughening, const Box& box) {
    roughening.box = box;
    const lib::ProgramImage image = ready(programs_.roughen);
    host_.phase("load_roughening");
    run_roughen(driver_, image, roughening);
  }

  HostPort& host_;
  const PreparedTree& tree_;
  const TreePrograms& programs_;
  lib::RdsDriver driver_;
  lib::Overlays overlays_;
  HullsDriver hulls_;
};

}  // namespace

void run(HostPort& host, const PreparedTree& tree, const TreePrograms& programs, const CubeBytes& cube,
         const TreeSite& site, const std::function<void()>& before_colour) {
  TreeRun run(host, tree, programs, site);
  compute_set_up(host, tree.hulls.growth, tree.hulls.setup_flops, "set_up");
  if (tree.textured()) run.make_texture(cube);
  run.show(site.repeat_field);
  run.draw_crowns();
  run.draw_trunks();
  before_colour();
  if (tree.textured()) run.colour();
  host.phase("finish");
}

}  // namespace dendro::half_space
