#include "firmware/zbuffer_views/stability/support.h"

#include <cmath>

#include "sim/base/check.h"

namespace dendro::zbuffer_views {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::string made_by(const stability::Rig& rig, const char* program, const JobFile& job, const std::string& from) {
  stability::Files files = {{"job", bytes_of(job.bytes())}, {"from", bytes_of(from)}};
  exec(rig, std::string("zbuffer_views_") + program, {"job", "from", "to"}, files);
  const auto& made = files["to"];
  return {made.begin(), made.end()};
}

}  // namespace

std::string exec(const stability::Rig& rig, const std::string& program, const std::vector<std::string>& arguments,
                 stability::Files& files) {
  const auto* workstation = dynamic_cast<const stability::WorkstationRig*>(&rig);
  DENDRO_CHECK(workstation != nullptr, "{} needs a workstation", program);
  return workstation->exec(program, arguments, files);
}

ViewsFile precomputed(const stability::Rig& rig, const TreeFile& tree, const JobFile& job) {
  return ViewsFile::parse(made_by(rig, "precompute", job, tree.bytes()));
}

Pictures reconstructed(const stability::Rig& rig, const ViewsFile& views, const JobFile& job) {
  return Pictures::parse(made_by(rig, "reconstruct", job, views.bytes()));
}

Pictures polygons(const stability::Rig& rig, const TreeFile& tree, const JobFile& job) {
  return Pictures::parse(made_by(rig, "polygons", job, tree.bytes()));
}

Blank blank_views(const stability::Rig& rig, int bands, int side, float pitch) {
  TreeFile tree;
  tree.colours.clear();
  for (std::uint32_t i = 0; i < kZbvMostColours; ++i) tree.colours.push_back({kZbvBranch, 0xFFFFFF, i, 0});
  tree.add({0, -0.01f, 0}, {0.01f, 0.01f, 0}, {0, 0.01f, 0.01f}, 0);
  JobFile job(tree);
  job.facts.bands = static_cast<std::uint32_t>(bands);
  job.facts.layers = 1;
  job.facts.view_width = job.facts.view_height = static_cast<std::uint32_t>(side);
  job.facts.pitch = pitch;
  job.facts.width = job.facts.height = 40;
  job.facts.centre_x = job.facts.centre_y = 19.5f;
  job.facts.scale = 16;
  job.frames.clear();
  ViewsFile views = precomputed(rig, tree, job);
  views.make_empty();
  return {tree, views, job};
}

void put_sample(ViewsFile& views, std::size_t view, int i, int j, float z, std::uint8_t colour) {
  auto& layer = views.layers[view][0];
  const auto at = static_cast<std::size_t>(j) * views.facts.width + static_cast<std::size_t>(i);
  layer.z[at] = z;
  layer.latitude[at] = 255;
  layer.colour[at] = colour;
}

stability::Row no_fault(const char* id, const std::string& what, const Faults& tally, const char* unit, const char* reference) {
  return {id, what, static_cast<double>(tally.count), 0, unit, reference, Bound::kAtMost, tally.first};
}

stability::Row must_show(const char* id, const std::string& what, double measured, const char* unit, const char* reference) {
  return {id, what, measured, 0, unit, reference, Bound::kMoreThan, ""};
}

zbv_frame facing(const std::array<double, 3>& d, double distance) {
  const double level = std::hypot(d[0], d[2]), size = std::hypot(level, d[1]);
  const double st = level / size, ct = d[1] / size, sp = level > 0 ? d[0] / level : 0, cp = level > 0 ? d[2] / level : 1;
  const double rows[9] = {cp, 0, -sp, -ct * sp, st, -ct * cp, -st * sp, -ct, -st * cp};
  zbv_frame frame = {};
  for (std::size_t i = 0; i < 9; ++i) frame.frame[i] = static_cast<float>(rows[i]);
  for (std::size_t i = 0; i < 3; ++i) frame.eye[i] = static_cast<float>(d[i] / size * distance);
  frame.light[1] = 1;
  return frame;
}

}  // namespace dendro::zbuffer_views
