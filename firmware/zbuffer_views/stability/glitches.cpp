#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/support.h"
#include "firmware/zbuffer_views/stability/turn.h"

// MO95-B15 and MO95-B16 on the films of the magnolia: what one, two and three layers miss, what of it flickers from picture to
// picture, and what jumps where the camera passes a longitude of stored views.

namespace dendro::zbuffer_views {
namespace {

using stability::Result;

constexpr const char* kScene = "video-4";  ///< three layers; the third segment is the same tree with one
constexpr int kLayers = 3;
constexpr double kFilmStep = 1;  ///< degrees from picture to picture: 360 of them
constexpr int kPairs = 24;
/// Both circles beside the camera's latitude have six views, the first of them where the scene's camera stands.
constexpr int kExchanges = 6;
constexpr double kSmallStep = 0.002;  ///< degrees; what is drawn of the tree hardly moves
constexpr int kShownPair = 2, kZoom = 3, kGap = 4;

std::vector<double> around(int count, double first) {
  std::vector<double> degrees;
  for (int k = 0; k < count; ++k) degrees.push_back(first + 360.0 * k / count);
  return degrees;
}

std::string layers_of(int layers) { return layers == 1 ? "1 layer" : fmt::format("{} layers", layers); }

template <class Figure>
double mean(const std::vector<PairGlitches>& all, const Figure& figure) {
  return std::accumulate(all.begin(), all.end(), 0.0, [&](double sum, const PairGlitches& g) { return sum + figure(g); }) /
         static_cast<double>(all.size());
}

double wrong(const PairGlitches& g) { return g.wrong_percent(); }
double flicker(const PairGlitches& g) { return g.flicker_percent(); }
double beside(const PairGlitches& g) { return 100 * static_cast<double>(g.beside) / static_cast<double>(g.tree); }
double change(const PairGlitches& g) { return g.change; }

/// One layer has to show it; every further one may not make it worse.
void add_by_layers(Result& result, const char* id, const std::string& what, const char* unit, const std::vector<double>& by_layers) {
  for (std::size_t k = 0; k < by_layers.size(); ++k) {
    const std::string named = fmt::format("{}: {}", layers_of(static_cast<int>(k) + 1), what);
    if (k == 0)
      result.rows.push_back(must_show(id, named, by_layers[0], unit, "polygons"));
    else
      result.rows.push_back({id, named, by_layers[k], by_layers[k - 1], unit, "polygons", Bound::kAtMost,
                             fmt::format("{} have {:.4g}", layers_of(static_cast<int>(k)), by_layers[k - 1])});
  }
}

using ByLayers = std::vector<std::vector<PairGlitches>>;

template <class Figure>
stability::Curve curve_of(const std::string& name, const std::string& title, const std::string& label, const std::vector<Pair>& pairs,
                          const ByLayers& by_layers, const Figure& figure) {
  stability::Curve curve = {name, title, {"degrees around the tree"}, {}, false, label};
  for (std::size_t l = 0; l < by_layers.size(); ++l) curve.columns.push_back(layers_of(static_cast<int>(l) + 1));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    curve.rows.push_back({pairs[k].degrees});
    for (const auto& glitches : by_layers) curve.rows.back().push_back(figure(glitches[k]));
  }
  return curve;
}

/// Pictures of one size beside each other, below them their middle thirds enlarged.
class Panels {
 public:
  Panels(int width, int height, int count)
      : width_(width), height_(height), image_{count * (width + kGap) - kGap, 2 * height + kGap, {}} {
    image_.rgb.assign(static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height) * 3, 255);
  }
  template <class Channel>
  void add(const std::vector<Channel>& rgb) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        copy(rgb, x, y, y);
        copy(rgb, x, y, height_ + kGap + y, (width_ - width_ / kZoom) / 2 + x / kZoom, (height_ - height_ / kZoom) / 2 + y / kZoom);
      }
    left_ += width_ + kGap;
  }
  scene::RgbImage take() { return std::move(image_); }

 private:
  template <class Channel>
  void copy(const std::vector<Channel>& rgb, int x, int, int to_y, int from_x, int from_y) {
    for (int c = 0; c < 3; ++c)
      image_.rgb[static_cast<std::size_t>((to_y * image_.width + left_ + x) * 3 + c)] = static_cast<std::uint8_t>(
          static_cast<double>(rgb[static_cast<std::size_t>((from_y * width_ + from_x) * 3 + c)]) + 0.5);
  }
  template <class Channel>
  void copy(const std::vector<Channel>& rgb, int x, int y, int to_y) {
    copy(rgb, x, y, to_y, x, y);
  }

  int width_, height_, left_ = 0;
  scene::RgbImage image_;
};

}  // namespace

Result turn_glitches(const stability::Rig& rig, std::uint64_t) {
  const Turn turn(rig, kScene, kLayers);
  const std::vector<Pair> pairs = turn.pairs(around(kPairs, 0), kFilmStep);
  const std::vector<ReferencePicture> polygons = turn.polygons(pairs);
  Panels panels(turn.prepared().width, turn.prepared().height, kLayers + 1);
  panels.add(polygons[2 * kShownPair].rgb);
  ByLayers by_layers;
  std::vector<double> wrongs, flickers;
  for (int layers = 1; layers <= kLayers; ++layers) {
    const std::vector<DrawnPicture> drawn = turn.draw(pairs, layers);
    panels.add(drawn[2 * kShownPair].rgb);
    by_layers.push_back(turn.glitches(pairs, drawn, polygons));
    wrongs.push_back(mean(by_layers.back(), wrong));
    flickers.push_back(mean(by_layers.back(), flicker));
  }
  Result result;
  add_by_layers(result, "B15", "pixels of the tree that are empty or show what lies behind", "percent", wrongs);
  add_by_layers(result, "B15", "surface points that are missing in one of two pictures a degree apart", "percent", flickers);
  // A sample covers its pixel wherever in it the surface lies, a triangle only where it holds the middle.
  result.rows.push_back(must_show("B15", "3 layers: pixels covered beyond the tree's own", mean(by_layers.back(), beside), "percent", "polygons"));
  result.curves = {curve_of("B15", "magnolia: pixels of the tree that are empty or show what lies behind", "percent of the tree's pixels",
                            pairs, by_layers, wrong),
                   curve_of("B15-flicker", "magnolia: surface points missing in one of two pictures a degree apart",
                            "percent of the points in both", pairs, by_layers, flicker),
                   curve_of("B15-change", "magnolia: change of a surface point's brightness in a degree", "levels of 255", pairs, by_layers,
                            change)};
  result.curves[0].logarithmic = result.curves[1].logarithmic = true;
  stability::Curve& last = result.curves.back();
  last.columns.push_back("polygons");
  last.reach = 20;
  for (std::size_t k = 0; k < pairs.size(); ++k) last.rows[k].push_back(by_layers[0][k].polygon_change);
  result.pictures.push_back({"B15-pictures", panels.take()});
  return result;
}

Result view_exchanges(const stability::Rig& rig, std::uint64_t) {
  const Turn turn(rig, kScene, kLayers);
  const std::vector<double> borders = around(kExchanges, 0);
  const std::vector<double> between = {borders[0] + 30, borders[1] + 30};
  const std::vector<Pair> across = turn.pairs(borders, kSmallStep), beside = turn.pairs(between, kSmallStep),
                          film = turn.pairs(between, kFilmStep);
  const std::vector<ReferencePicture> polygons_across = turn.polygons(across), polygons_beside = turn.polygons(beside);
  std::vector<double> jumps, changes;
  double without = 0;
  for (int layers = 1; layers <= kLayers; ++layers) {
    const auto jump = turn.glitches(across, turn.draw(across, layers), polygons_across);
    const auto still = turn.glitches(beside, turn.draw(beside, layers), polygons_beside);
    jumps.push_back(mean(jump, flicker));
    changes.push_back(mean(jump, change));
    without = std::max(without, mean(still, change));
  }
  Result result;
  add_by_layers(result, "B16", "surface points that are missing on one side of an exchange of views", "percent", jumps);
  add_by_layers(result, "B16", "change of a point's brightness at an exchange", "levels of 255", changes);
  const double film_change = mean(turn.glitches(film, turn.draw(film, kLayers), turn.polygons(film)), change);
  result.rows.push_back({"B16", "3 layers: that change, against the change in a degree of the film without an exchange", changes.back(),
                         film_change, "levels of 255", "polygons", Bound::kAtMost, "all exchanges"});
  result.rows.push_back({"B16", "change in the same 0.002 degrees without an exchange", without, changes.back(), "levels of 255", "polygons",
                         Bound::kAtMost, ""});
  return result;
}

}  // namespace dendro::zbuffer_views
