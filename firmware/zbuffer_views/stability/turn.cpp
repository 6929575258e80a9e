#include "firmware/zbuffer_views/stability/turn.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "firmware/zbuffer_views/host/prepare.h"
#include "firmware/zbuffer_views/stability/support.h"
#include "sim/base/check.h"

namespace dendro::zbuffer_views {
namespace {

const stability::WorkstationRig& workstation_of(const stability::Rig& rig) {
  const auto* workstation = dynamic_cast<const stability::WorkstationRig*>(&rig);
  DENDRO_CHECK(workstation != nullptr, "a turn needs a workstation");
  return *workstation;
}

/// The pixel of a frame that shows a point, the highest row first, or -1; its depth.
std::int64_t pixel_of(const Prepared& p, const Frame& frame, const glm::dvec3& point, double& depth) {
  const glm::dvec3 q = frame.axes(point - frame.eye);
  depth = q.z;
  const double column = std::floor(p.scale * q.x + p.centre_x + 0.5), row = std::floor(p.scale * q.y + p.centre_y + 0.5);
  if (!(column >= 0 && column < p.width && row >= 0 && row < p.height)) return -1;
  return (p.height - 1 - static_cast<std::int64_t>(row)) * p.width + static_cast<std::int64_t>(column);
}

glm::dvec3 point_of(const Prepared& p, const Frame& frame, std::size_t pixel, double depth) {
  const auto column = static_cast<double>(pixel % static_cast<std::size_t>(p.width));
  const auto row = static_cast<double>(p.height - 1) - static_cast<double>(pixel / static_cast<std::size_t>(p.width));
  return frame.eye + frame.axes.inverse({(column - p.centre_x) / p.scale, (row - p.centre_y) / p.scale, depth});
}

template <class Channel>
double brightness(const std::vector<Channel>& rgb, std::size_t pixel) {
  return (static_cast<double>(rgb[3 * pixel]) + rgb[3 * pixel + 1] + rgb[3 * pixel + 2]) / 3;
}

}  // namespace

Turn::Turn(const stability::Rig& rig, const std::string& scene, int most_layers, const std::vector<std::string>& settings) : rig_(rig) {
  std::vector<std::string> all = {"zbuffer_views.frames=1", "zbuffer_views.skip_empty=true",
                                  "zbuffer_views.layers=" + std::to_string(most_layers)};
  all.insert(all.end(), settings.begin(), settings.end());
  RunSettings run;
  prepared_ = prepare(workstation_of(rig).scene(scene, all), run);
  DENDRO_CHECK(!prepared_.perspective && prepared_.placements.size() == 1, "{}", scene);
  tree_ = tree_file(prepared_.tree);
  digest_ = digest_of(tree_);
  stability::Files files = {{"job", job_file(prepared_, digest_, 0, 1)}, {"tree", tree_}};
  exec(rig, "zbuffer_views_precompute", {"job", "tree", "views"}, files);
  views_ = std::move(files["views"]);
  check_views(views_, prepared_, digest_, "views");
}

std::vector<Pair> Turn::pairs(const std::vector<double>& degrees, double step) const {
  std::vector<Pair> pairs;
  const auto at = [&](double angle) { return turned(prepared_.frames.front(), prepared_.placements.front().at, -angle, true); };
  for (const double angle : degrees) pairs.push_back({angle, {at(angle - step / 2), at(angle + step / 2)}});
  return pairs;
}

std::vector<DrawnPicture> Turn::draw(const std::vector<Pair>& pairs, int layers) const {
  ViewsFile views = ViewsFile::parse({views_.begin(), views_.end()});
  views.facts.layers = static_cast<std::uint32_t>(layers);
  for (auto& view : views.layers) view.resize(static_cast<std::size_t>(layers));
  const std::string bytes = views.bytes();
  Prepared p = prepared_;
  p.views.layers = layers;
  p.frames.clear();
  for (const Pair& pair : pairs) p.frames.insert(p.frames.end(), std::begin(pair.frames), std::end(pair.frames));
  stability::Files files = {{"job", job_file(p, digest_, 0, p.frames.size())}, {"views", {bytes.begin(), bytes.end()}}};
  exec(rig_, "zbuffer_views_reconstruct", {"job", "views", "pictures"}, files);
  return read_pictures(files["pictures"], p, digest_);
}

std::vector<ReferencePicture> Turn::polygons(const std::vector<Pair>& pairs) const {
  std::vector<ReferencePicture> pictures;
  for (const Pair& pair : pairs)
    for (const Frame& frame : pair.frames) pictures.push_back(draw_polygons(prepared_, frame));
  return pictures;
}

std::vector<PairGlitches> Turn::glitches(const std::vector<Pair>& pairs, const std::vector<DrawnPicture>& drawn,
                                         const std::vector<ReferencePicture>& polygons) const {
  DENDRO_CHECK(drawn.size() == 2 * pairs.size() && polygons.size() == drawn.size(), "{} {}", drawn.size(), polygons.size());
  std::vector<PairGlitches> all;
  for (std::size_t k = 0; k < pairs.size(); ++k) all.push_back(compare(pairs[k], &drawn[2 * k], &polygons[2 * k]));
  return all;
}

PairGlitches Turn::compare(const Pair& pair, const DrawnPicture* drawn, const ReferencePicture* polygons) const {
  const double threshold = prepared_.views.threshold;
  const auto hole = [&](int k, std::size_t i) { return drawn[k].colour[i] == kNoColour; };
  const auto behind = [&](int k, std::size_t i) { return !hole(k, i) && drawn[k].depth[i] > polygons[k].depth[i] + threshold; };
  PairGlitches glitches;
  for (std::size_t i = 0; i < polygons[0].colour.size(); ++i) {
    if (polygons[0].colour[i] == kNoColour) {
      glitches.beside += !hole(0, i);
      continue;
    }
    ++glitches.tree;
    glitches.holes += hole(0, i);
    glitches.behind += behind(0, i);
    double depth = 0;
    const std::int64_t next = pixel_of(prepared_, pair.frames[1], point_of(prepared_, pair.frames[0], i, polygons[0].depth[i]), depth);
    if (next < 0) continue;
    const auto j = static_cast<std::size_t>(next);
    if (polygons[1].colour[j] == kNoColour || !(std::abs(polygons[1].depth[j] - depth) <= threshold)) continue;
    ++glitches.points;
    glitches.flicker += (hole(0, i) || behind(0, i)) != (hole(1, j) || behind(1, j));
    glitches.change += std::abs(brightness(drawn[0].rgb, i) - brightness(drawn[1].rgb, j));
    glitches.polygon_change += std::abs(brightness(polygons[0].rgb, i) - brightness(polygons[1].rgb, j));
  }
  glitches.change /= static_cast<double>(glitches.points);
  glitches.polygon_change /= static_cast<double>(glitches.points);
  return glitches;
}

}  // namespace dendro::zbuffer_views
