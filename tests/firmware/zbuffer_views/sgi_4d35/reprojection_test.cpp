#include <cmath>
#include <random>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

/// Single samples in views made by hand, whose places in the picture are exact.
namespace dendro::zbuffer_views {
namespace {

constexpr int kSide = 32;
constexpr float kPitch = 1.0f / 64;

/// All views empty, sample (0, 0) on the trunk's axis.
ViewsFile empty_views(const TreeFile& tree) {
  JobFile job(tree);
  job.facts.layers = 1;
  job.facts.view_width = job.facts.view_height = kSide;
  ViewsFile views = ViewsFile::parse(precomputed(tree, job));
  views.make_empty();
  views.facts.pitch = kPitch;
  views.facts.radius = views.facts.half_height = 0.5f;
  for (auto& view : views.views) view.x0 = view.y0 = 0;
  return views;
}

void put(ViewsFile& views, std::size_t view, int i, int j, float z, std::uint8_t colour) {
  auto& layer = views.layers[view][0];
  const auto at = static_cast<std::size_t>(j * kSide + i);
  layer.z[at] = z;
  layer.latitude[at] = 255;
  layer.colour[at] = colour;
}

/// Looks down on the tree, as the first view does, from `height`.
JobFile from_above(const TreeFile& tree, float height) {
  JobFile job(tree);
  job.frames = {{{0, height, 0}, {1, 0, 0, 0, 0, -1, 0, -1, 0}, {0, 1, 0}, 0}};
  job.facts.width = job.facts.height = 40;
  job.facts.centre_x = 9;
  job.facts.centre_y = 5;
  job.facts.scale = 32;
  return job;
}

class Reprojection : public testing::Test {
 protected:
  const TreeFile tree_ = random_tree(21, 10);
};

TEST_F(Reprojection, HalfPixelsGoUpAndTheNearestSampleStays) {
  // N-B6: at half the samples' scale every second one lies on a half pixel.
  std::mt19937 random(5);
  ViewsFile views = empty_views(tree_);
  std::vector<float> wanted(40 * 40, kZbvFarDepth);
  std::vector<int> colours(40 * 40, kZbvEmptyColour);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      if (random() % 3 == 0) continue;
      const float z = static_cast<float>(static_cast<int>(random() % 512) - 256) / 1024;
      const auto colour = static_cast<std::uint8_t>(random() % 3);
      put(views, 0, i, j, z, colour);
      const int column = static_cast<int>(std::floor(i / 2.0 + 9.5)),
                row = static_cast<int>(std::floor(j / 2.0 + 5.5));
      const auto at = static_cast<std::size_t>((39 - row) * 40 + column);
      if (z + 4 < wanted[at]) {
        wanted[at] = z + 4;
        colours[at] = colour == 1 ? 0 : colour == 0 ? 0 : 2;
      }
    }
  for (const std::uint32_t options : {0u, std::uint32_t{kZbvFullProduct}, std::uint32_t{kZbvSkipEmpty}}) {
    JobFile job = from_above(tree_, 4);
    job.facts.options = options;
    const auto picture = reconstructed(views.bytes(), job).pictures.at(0);
    EXPECT_EQ(wanted, picture.depth);
    for (std::size_t k = 0; k < colours.size(); ++k)
      EXPECT_EQ(colours[k] == kZbvEmptyColour, picture.colour[k] == kZbvEmptyColour);
  }
}

TEST_F(Reprojection, PerspectiveDividesByTheDistanceAndKeepsTheDepth) {
  ViewsFile views = empty_views(tree_);
  struct Case {
    int i, j;
    float z;
  };
  // Distances 2, 4 and 8 from an eye at height 4, with 128 pixels a unit at distance 1.
  const std::vector<Case> cases = {{3, 1, -2}, {7, 9, 0}, {10, 20, 4}};
  for (const Case& c : cases) put(views, 0, c.i, c.j, c.z, 2);
  JobFile job = from_above(tree_, 4);
  job.facts.projection = kZbvPerspective;
  job.facts.scale = 128;
  const auto picture = reconstructed(views.bytes(), job).pictures.at(0);
  EXPECT_EQ(cases.size(), picture.facts.covered);
  for (const Case& c : cases) {
    const double distance = 4 + c.z;
    const int column = static_cast<int>(std::floor(128 * c.i / 64.0 / distance + 9.5)),
              row = static_cast<int>(std::floor(128 * c.j / 64.0 / distance + 5.5));
    EXPECT_EQ(distance, picture.depth[static_cast<std::size_t>((39 - row) * 40 + column)]);
  }
}

TEST_F(Reprojection, TheLowerViewNumberStaysOnATie) {
  // N-B4: the tree's centre has the same depth from every view; directions from above choose views 0, 1, 2.
  for (std::size_t first = 0; first < 3; ++first)
    for (std::size_t second = first + 1; second < 3; ++second) {
      ViewsFile views = empty_views(tree_);
      views.colours[0] = {kZbvBranch, 0xFF0000, 0, 0};
      views.colours[1] = {kZbvBranch, 0x00FF00, 1, 0};
      put(views, first, 0, 0, 0, 1);
      put(views, second, 0, 0, 0, 0);
      const auto picture = reconstructed(views.bytes(), from_above(tree_, 4)).pictures.at(0);
      EXPECT_EQ(3u, picture.facts.camera_views);
      EXPECT_EQ(1u, picture.facts.covered);
      EXPECT_EQ(1, picture.colour[(39 - 5) * 40 + 9]) << first << second;
    }
}

TEST_F(Reprojection, NothingAtOrBehindTheNearPlaneIsDrawn) {
  // N-B7: distances -2, 0, near, and twice near.
  ViewsFile views = empty_views(tree_);
  int i = 0;
  for (const float z : {-3.0f, -1.0f, -0.75f, -0.5f}) put(views, 0, i++, 0, z, 2);
  JobFile job = from_above(tree_, 1);
  job.facts.projection = kZbvPerspective;
  job.facts.near = 0.25f;
  for (const std::uint32_t options : {0u, std::uint32_t{kZbvSkipEmpty}}) {
    job.facts.options = options;
    const auto picture = reconstructed(views.bytes(), job).pictures.at(0);
    EXPECT_EQ(1u, picture.facts.covered);
    EXPECT_EQ(0.5f, picture.depth[static_cast<std::size_t>((39 - 5) * 40 + 9 + 3)]);
  }
}

TEST_F(Reprojection, EmptySamplesLeaveNoTraceFromAnyDirection) {
  ViewsFile views = empty_views(tree_);
  std::mt19937 random(8);
  JobFile job(tree_);
  job.frames.clear();
  for (int k = 0; k < 24; ++k) {
    const auto coordinate = [&]() { return static_cast<double>(random() % 2001) / 1000 - 1; };
    const double x = coordinate(), y = coordinate(), z = coordinate(), size = std::hypot(x, y, z) / 6;
    job.frames.push_back(look({x / size, y / size, z / size}, {0, 0, 0}, {coordinate(), 1.1, coordinate()}));
  }
  job.facts.shadows = 1;
  for (const std::uint32_t projection : {kZbvParallel, kZbvPerspective}) {
    job.facts.projection = projection;
    job.facts.scale = projection == kZbvPerspective ? 100 : 20;
    for (const auto& picture : reconstructed(views.bytes(), job).pictures)
      EXPECT_EQ(0u, picture.facts.covered);
  }
}

TEST_F(Reprojection, DirectionsChooseThreeViewsInTheCapsAndFourElsewhere) {
  // N-B2: poles, circles and the wrap of longitudes.
  ViewsFile views = empty_views(tree_);
  JobFile job(tree_);
  struct Case {
    double latitude, longitude;
    std::uint32_t views;
  };
  const std::vector<Case> cases = {{89.999, 0, 3},  {89.999, 200, 3}, {31, 359.9999, 3},
                                   {29, 0.0001, 4}, {0, 0, 4},        {0, 359.9999, 4},
                                   {-29, 123, 4},   {-31, 123, 3},    {-89.999, 77, 3}};
  job.frames.clear();
  for (const Case& c : cases) {
    const double t = c.latitude * M_PI / 180, p = c.longitude * M_PI / 180;
    job.frames.push_back(look({9 * std::cos(t) * std::sin(p), 9 * std::sin(t), 9 * std::cos(t) * std::cos(p)},
                              {0, 0, 0}, {1, 2, 3}));
  }
  const auto pictures = reconstructed(views.bytes(), job).pictures;
  for (std::size_t k = 0; k < cases.size(); ++k)
    EXPECT_EQ(cases[k].views, pictures[k].facts.camera_views)
        << cases[k].latitude << " " << cases[k].longitude;
}

}  // namespace
}  // namespace dendro::zbuffer_views
