#include <algorithm>
#include <cmath>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

namespace dendro::zbuffer_views {
namespace {

using Picture = Pictures::Picture;

/// Everything but depth: what a viewer sees.
void expect_same_colours(const Picture& a, const Picture& b, const std::string& what) {
  EXPECT_TRUE(a.red == b.red && a.green == b.green && a.blue == b.blue && a.colour == b.colour) << what;
  EXPECT_GT(a.facts.covered, 300u) << what;
}

int different_pixels(const Picture& a, const Picture& b) {
  int count = 0;
  for (std::size_t k = 0; k < a.red.size(); ++k)
    count += a.red[k] != b.red[k] || a.green[k] != b.green[k] || a.blue[k] != b.blue[k];
  return count;
}

/// V5 and V6 in double precision, parallel: the nearest stored sample of each pixel.
struct Nearest {
  double depth = kZbvFarDepth;
  std::uint8_t latitude = 0, longitude = 0, colour = kZbvEmptyColour;
  bool doubtful = false;  ///< a sample near a pixel's border, or a second one about as near
};

std::vector<std::size_t> chosen(const ViewsFile& views, const zbv_frame& frame) {
  const double x = -frame.frame[6], y = -frame.frame[7], z = -frame.frame[8];
  const double theta = std::atan2(std::hypot(x, z), y), phi = std::atan2(x, z);
  const auto n = views.facts.bands;
  const auto band = std::min(n - 1, static_cast<std::uint32_t>(theta * n / M_PI));
  std::vector<std::size_t> list;
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    const auto& view = views.views[v];
    if (view.circle != band && view.circle != band + 1) continue;
    const double m = view.circle_views, at = (phi < 0 ? phi + 2 * M_PI : phi) * m / (2 * M_PI);
    const auto j = static_cast<std::uint32_t>(at) % view.circle_views;
    if (view.number == j || view.number == (j + 1) % view.circle_views) list.push_back(v);
  }
  return list;
}

std::vector<Nearest> nearest_samples(const ViewsFile& views, const JobFile& job) {
  const zbv_frame& f = job.frames[0];
  std::vector<Nearest> pixels(job.facts.width * job.facts.height);
  for (const std::size_t v : chosen(views, f))
    for (const auto& layer : views.layers[v])
      for (std::size_t at = 0; at < layer.z.size(); ++at) {
        if (layer.colour[at] == kZbvEmptyColour) continue;
        const auto& view = views.views[v];
        const double q[3] = {view.x0 + double(at % views.facts.width) * views.facts.pitch,
                             view.y0 + double(at / views.facts.width) * views.facts.pitch, layer.z[at]};
        double p[3], s[3];
        for (int k = 0; k < 3; ++k)
          p[k] = q[0] * view.frame[k] + q[1] * view.frame[3 + k] + q[2] * view.frame[6 + k] - f.eye[k];
        for (int k = 0; k < 3; ++k)
          s[k] = p[0] * f.frame[3 * k] + p[1] * f.frame[3 * k + 1] + p[2] * f.frame[3 * k + 2];
        const double x = s[0] * job.facts.scale + job.facts.centre_x + 0.5,
                     y = s[1] * job.facts.scale + job.facts.centre_y + 0.5;
        const bool doubtful = std::fabs(x - std::round(x)) < 1e-3 || std::fabs(y - std::round(y)) < 1e-3;
        const auto mark = [&](double column, double row) -> Nearest* {
          if (column < 0 || row < 0 || column >= job.facts.width || row >= job.facts.height) return nullptr;
          return &pixels[(job.facts.height - 1 - std::size_t(row)) * job.facts.width + std::size_t(column)];
        };
        if (doubtful)
          for (const double dx : {-1e-3, 1e-3})
            for (const double dy : {-1e-3, 1e-3})
              if (Nearest* n = mark(std::floor(x + dx), std::floor(y + dy))) n->doubtful = true;
        Nearest* n = mark(std::floor(x), std::floor(y));
        if (!n) continue;
        if (std::fabs(n->depth - s[2]) < 1e-4) n->doubtful = true;
        if (s[2] < n->depth)
          *n = {s[2], layer.latitude[at], layer.longitude[at], layer.colour[at],
                n->doubtful && (doubtful || std::fabs(n->depth - s[2]) < 1e-4)};
      }
  return pixels;
}

class Reconstruction : public testing::Test {
 protected:
  TreeFile tree_ = random_tree(31, 120);
  JobFile job_{tree_};
  std::string views_ = precomputed(tree_, job_);

  void SetUp() override { job_.frames = {look({4, 3, 7}, {0, 0, 0}, {0.5, 0.8, 0.6})}; }
  Picture picture(const JobFile& job) { return reconstructed(views_, job).pictures.at(0); }
};

TEST_F(Reconstruction, PixelsAreTheNearestSamplesAndShadedByLambert) {
  const auto views = ViewsFile::parse(views_);
  const Picture drawn = picture(job_);
  const auto wanted = nearest_samples(views, job_);
  const zbv_frame& f = job_.frames[0];
  int judged = 0, seen_below = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const Nearest& n = wanted[k];
    if (n.doubtful) continue;
    ASSERT_EQ(n.colour == kZbvEmptyColour, drawn.colour[k] == kZbvEmptyColour) << k;
    if (n.colour == kZbvEmptyColour) {
      EXPECT_EQ(kZbvFarDepth, drawn.depth[k]);
      EXPECT_EQ(0x10, drawn.red[k]);
      EXPECT_EQ(0x30, drawn.blue[k]);
      continue;
    }
    EXPECT_NEAR(n.depth, drawn.depth[k], 1e-5);
    const double lat = n.latitude / 255.0 * M_PI - M_PI / 2, lon = n.longitude / 128.0 * M_PI;
    const double normal[3] = {std::cos(lat) * std::sin(lon), std::sin(lat), std::cos(lat) * std::cos(lon)};
    double cosine = 0, side = 0;
    for (int a = 0; a < 3; ++a) {
      cosine += normal[a] * f.light[a];
      side -= normal[a] * f.frame[6 + a];
    }
    if (std::fabs(side) < 1e-5) continue;
    const auto& own = views.colours[n.colour];
    const bool below = own.part == kZbvLeaf && side < 0;
    seen_below += below;
    const std::uint32_t colour = below ? own.below : n.colour, rgb = views.colours[colour].rgb;
    EXPECT_EQ(colour, drawn.colour[k]);
    const double shade = 0.3 + 0.7 * std::max(0.0, below ? -cosine : cosine);
    EXPECT_NEAR((rgb >> 16) * shade, drawn.red[k], 0.51);
    EXPECT_NEAR((rgb >> 8 & 0xFF) * shade, drawn.green[k], 0.51);
    EXPECT_NEAR((rgb & 0xFF) * shade, drawn.blue[k], 0.51);
    ++judged;
  }
  EXPECT_GT(judged, 500);
  EXPECT_GT(seen_below, 50);
  EXPECT_EQ(4u, drawn.facts.camera_views);
}

TEST_F(Reconstruction, OptionsDoNotChangeThePictureBeyondRounding) {
  for (const std::uint32_t projection : {kZbvParallel, kZbvPerspective}) {
    JobFile job = job_;
    job.facts.projection = projection;
    job.facts.scale = projection == kZbvPerspective ? 160 : 20;
    job.facts.shadows = 1;
    const Picture plain = picture(job);
    job.facts.options = kZbvSkipEmpty;
    expect_same_colours(plain, picture(job), "skip empty");
    EXPECT_EQ(plain.depth, picture(job).depth);
    job.facts.options = kZbvFullProduct;
    EXPECT_LE(different_pixels(plain, picture(job)), 12);
  }
}

TEST_F(Reconstruction, ASequenceIsItsFrames) {
  job_.facts.shadows = 1;
  const std::vector<zbv_frame> frames = {job_.frames[0], look({-4, 1, 7}, {0, 0, 0}, {0.5, 0.8, 0.6}),
                                         look({-4, -2, -7}, {0, 0, 0}, {-0.5, 0.8, 0.6})};
  for (const std::uint32_t options : {0u, std::uint32_t{kZbvReuseLight}}) {
    job_.facts.options = options;
    job_.frames = frames;
    const auto all = reconstructed(views_, job_).pictures;
    ASSERT_EQ(3u, all.size());
    EXPECT_EQ(options == 0, all[1].facts.light_views > 0);
    EXPECT_GT(all[2].facts.light_views, 0u);
    for (std::size_t k = 0; k < 3; ++k) {
      job_.frames = {frames[k]};
      const Picture one = picture(job_);
      expect_same_colours(one, all[k], "frame");
      EXPECT_EQ(one.depth, all[k].depth);
      EXPECT_EQ(one.facts.covered, all[k].facts.covered);
      EXPECT_EQ(one.facts.shadowed, all[k].facts.shadowed);
    }
  }
}

TEST_F(Reconstruction, ATreeTwiceAtOnePlaceIsThatTree) {
  // X5.
  job_.facts.shadows = 1;
  const Picture once = picture(job_);
  job_.trees.push_back(job_.trees[0]);
  expect_same_colours(once, picture(job_), "twice");
}

TEST_F(Reconstruction, TurningTreeCameraAndLightTogetherChangesNothing) {
  // X2, by a quarter: x becomes z, z becomes -x.
  job_.facts.shadows = 1;
  job_.facts.light_scale = 18;
  for (const std::uint32_t projection : {kZbvParallel, kZbvPerspective}) {
    job_.facts.projection = projection;
    job_.facts.scale = projection == kZbvPerspective ? 160 : 20;
    const Picture before = picture(job_);
    JobFile turned = job_;
    const auto turn = [](float* v) {
      const float x = v[0];
      v[0] = v[2];
      v[2] = -x;
    };
    turned.trees[0].turn = 64;
    turn(turned.frames[0].eye);
    for (int row = 0; row < 3; ++row) turn(turned.frames[0].frame + 3 * row);
    turn(turned.frames[0].light);
    const Picture after = picture(turned);
    expect_same_colours(before, after, "turned");
    EXPECT_EQ(before.depth, after.depth);
  }
}

TEST_F(Reconstruction, TwiceTheSizeIsTheSamePicture) {
  // X3.
  const auto scaled = [](float& x) { x *= 2; };
  job_.facts.shadows = 1;
  const Picture before = picture(job_);
  const std::string polygons_from = tree_.bytes();
  JobFile plain = job_;
  plain.facts.shadows = 0;
  const Picture polygons_before = drawn("polygons", polygons_from, plain).pictures.at(0);
  for (auto& v : tree_.vertices)
    for (float& x : v) scaled(x);
  JobFile big(tree_);
  big.facts.shadows = 1;
  big.facts.scale = job_.facts.scale / 2;
  big.facts.threshold = job_.facts.threshold * 2;
  big.frames = job_.frames;
  for (float& x : big.frames[0].eye) scaled(x);
  const Picture after = reconstructed(precomputed(tree_, big), big).pictures.at(0);
  expect_same_colours(before, after, "twice the size");
  for (std::size_t k = 0; k < before.depth.size(); ++k)
    if (before.colour[k] != kZbvEmptyColour) {
      EXPECT_EQ(2 * before.depth[k], after.depth[k]);
    }
  big.facts.shadows = 0;
  expect_same_colours(polygons_before, drawn("polygons", tree_.bytes(), big).pictures.at(0), "polygons");
}

TEST_F(Reconstruction, TilesMakeUpThePicture) {
  // X6; the sums with another centre round differently, so that a sample on a border may move.
  const Picture whole = picture(job_);
  int different = 0;
  for (std::uint32_t tile = 0; tile < 4; ++tile) {
    JobFile part = job_;
    part.facts.width = 24;
    part.facts.height = 32;
    part.facts.centre_x -= tile & 1 ? 24 : 0;
    part.facts.centre_y -= tile & 2 ? 32 : 0;
    const Picture drawn = picture(part);
    for (std::uint32_t j = 0; j < 32; ++j)
      for (std::uint32_t i = 0; i < 24; ++i)
        different +=
            drawn.red[j * 24 + i] != whole.red[(j + (tile & 2 ? 0 : 32)) * 48 + i + (tile & 1 ? 24 : 0)];
  }
  EXPECT_LE(different, 2);
}

TEST_F(Reconstruction, SmallStepsOverAPoleACircleOrTheWrapChangeLittle) {
  // N-B2, MO95-B16: other views are chosen, the picture stays about the same.
  const auto at = [&](double latitude, double longitude) {
    const double t = latitude * M_PI / 180, p = longitude * M_PI / 180;
    job_.frames = {look({9 * std::cos(t) * std::sin(p), 9 * std::sin(t), 9 * std::cos(t) * std::cos(p)},
                        {0, 0, 0}, {0.5, 0.8, 0.6})};
    return picture(job_);
  };
  struct Case {
    double latitude, longitude, latitude2, longitude2;
  };
  for (const Case& c : {Case{30.001, 20, 29.999, 20}, Case{10, 359.999, 10, 0.001},
                        Case{0.001, 40, -0.001, 40}, Case{60, 59.999, 60, 60.001}}) {
    const Picture a = at(c.latitude, c.longitude), b = at(c.latitude2, c.longitude2);
    int coverage = 0;
    for (std::size_t k = 0; k < a.colour.size(); ++k)
      coverage += (a.colour[k] == kZbvEmptyColour) != (b.colour[k] == kZbvEmptyColour);
    EXPECT_LE(coverage, static_cast<int>(a.facts.covered / 6)) << c.latitude << " " << c.longitude;
  }
}

TEST_F(Reconstruction, AgreesWithPolygonsInsideSurfaces) {
  JobFile job = job_;
  job.facts.layers = 3;
  job.facts.view_width = 240;
  job.facts.view_height = 320;
  job.facts.scale = 60;
  job.facts.width = 144;
  job.facts.height = 192;
  job.facts.centre_x = 71.5f;
  job.facts.centre_y = 95.5f;
  job.frames = {look({4, 3, 7}, {0, 0, 0}, {0.5, 0.8, 0.6})};
  const Picture views = reconstructed(precomputed(tree_, job), job).pictures.at(0),
                polygons = drawn("polygons", tree_.bytes(), job).pictures.at(0);
  int inside = 0, wrong = 0;
  const auto w = static_cast<int>(job.facts.width), h = static_cast<int>(job.facts.height);
  for (int j = 1; j + 1 < h; ++j)
    for (int i = 1; i + 1 < w; ++i) {
      const auto at = static_cast<std::size_t>(j * w + i);
      bool one_surface = polygons.colour[at] != kZbvEmptyColour;
      for (int dj = -1; dj <= 1 && one_surface; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const auto near = static_cast<std::size_t>((j + dj) * w + i + di);
          one_surface &= polygons.colour[near] == polygons.colour[at] &&
                         polygons.red[near] == polygons.red[at] &&
                         std::fabs(polygons.depth[near] - polygons.depth[at]) < 0.15;
        }
      if (!one_surface) continue;
      ++inside;
      wrong +=
          views.colour[at] != polygons.colour[at] || std::fabs(views.depth[at] - polygons.depth[at]) > 0.1;
    }
  EXPECT_GT(inside, 100);
  EXPECT_LE(wrong, inside / 20);
}

}  // namespace
}  // namespace dendro::zbuffer_views
