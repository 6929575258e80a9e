#include <algorithm>
#include <cmath>
#include <random>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

/// Stored views of triangles whose corners project exactly, against brute force over all triangles and
/// samples.
namespace dendro::zbuffer_views {
namespace {

constexpr int kSide = 32, kUnits = 256;
constexpr double kPitch = 1.0 / 64;

/// A world coordinate `units` 256ths of a sample right of sample 0 of the first view.
float place(int units) { return static_cast<float>((units / double(kUnits) - 0.5 * (kSide - 1)) * kPitch); }

struct Flat {
  std::array<std::array<int, 2>, 3> corner;  ///< 256ths of samples
  std::array<float, 3> z;                    ///< in the first view, from above
};

/// The first view looks down: its x is the world's x, its y is -z, its z is -y.
TreeFile tree_of(const std::vector<Flat>& triangles) {
  TreeFile tree;
  tree.colours.clear();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) tree.colours.push_back({kZbvBranch, i, i, 0});
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Flat& t = triangles[i];
    std::array<Vertex, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = {place(t.corner[k][0]), -t.z[k], -place(t.corner[k][1])};
    tree.add(v[0], v[1], v[2], i);
  }
  return tree;
}

JobFile job_of(const TreeFile& tree, std::uint32_t layers, float threshold, std::uint32_t rule) {
  JobFile job(tree);
  job.facts.bands = 2;
  job.facts.layers = layers;
  job.facts.view_width = job.facts.view_height = kSide;
  job.facts.pitch = static_cast<float>(kPitch);
  job.facts.threshold = threshold;
  job.facts.rule = rule;
  return job;
}

/// Whether a triangle covers a sample; on an edge if it is a left one or the lower end.
bool covers(const Flat& t, int i, int j) {
  std::array<std::array<long, 2>, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = {t.corner[k][0], t.corner[k][1]};
  const auto cross = [](const auto& a, const auto& b, long x, long y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
  };
  if (cross(p[0], p[1], p[2][0], p[2][1]) == 0) return false;
  if (cross(p[0], p[1], p[2][0], p[2][1]) < 0) std::swap(p[1], p[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &a = p[k], &b = p[(k + 1) % 3];
    const long side = cross(a, b, long{i} * kUnits, long{j} * kUnits);
    const bool owns = b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
    if (side < 0 || (side == 0 && !owns)) return false;
  }
  return true;
}

double depth(const Flat& t, int i, int j) {
  const double x = i * kUnits, y = j * kUnits;
  const auto& p = t.corner;
  const double bx = p[1][0] - p[0][0], by = p[1][1] - p[0][1], cx = p[2][0] - p[0][0], cy = p[2][1] - p[0][1];
  const double area = bx * cy - cx * by, u = ((x - p[0][0]) * cy - cx * (y - p[0][1])) / area,
               v = (bx * (y - p[0][1]) - (x - p[0][0]) * by) / area;
  return t.z[0] + u * (double(t.z[1]) - t.z[0]) + v * (double(t.z[2]) - t.z[0]);
}

struct Fragment {
  double z;
  std::uint32_t triangle;
};

std::vector<Fragment> fragments(const std::vector<Flat>& triangles, int i, int j) {
  std::vector<Fragment> all;
  for (std::uint32_t k = 0; k < triangles.size(); ++k)
    if (covers(triangles[k], i, j)) all.push_back({depth(triangles[k], i, j), k});
  return all;
}

/// MO95 5, as written down in V4.
std::vector<Fragment> inserted(const std::vector<Fragment>& all, std::size_t layers, double t) {
  std::vector<Fragment> kept(layers, {kZbvEmptyDepth, kZbvEmptyColour});
  for (const Fragment& f : all)
    for (std::size_t k = 0; k < layers; ++k) {
      if (std::fabs(f.z - kept[k].z) < t) {
        if (f.z < kept[k].z) kept[k] = f;
        break;
      }
      if (f.z < kept[k].z) {
        kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(k), f);
        kept.pop_back();
        break;
      }
    }
  return kept;
}

/// Sorted by depth and number, then greedily from the front.
std::vector<Fragment> peeled(std::vector<Fragment> all, std::size_t layers, double t) {
  std::sort(all.begin(), all.end(), [](const Fragment& a, const Fragment& b) {
    return a.z != b.z ? a.z < b.z : a.triangle < b.triangle;
  });
  std::vector<Fragment> kept;
  for (const Fragment& f : all)
    if (kept.size() < layers && (kept.empty() || f.z - kept.back().z >= t)) kept.push_back(f);
  kept.resize(layers, {kZbvEmptyDepth, kZbvEmptyColour});
  return kept;
}

class Layers : public testing::Test {
 protected:
  std::mt19937 random_{20240611};
  int between(int low, int high) { return low + static_cast<int>(random_() % unsigned(high - low + 1)); }

  /// Corners on whole samples, halves or anywhere, so that edges run through samples.
  Flat flat(float z) {
    Flat t;
    const int grid = std::array<int, 3>{256, 128, 1}[random_() % 3];
    const int reach = between(1, kSide), x = between(0, kSide - 1), y = between(0, kSide - 1);
    for (auto& c : t.corner)
      for (std::size_t axis = 0; axis < 2; ++axis)
        c[axis] = std::clamp((axis ? y : x) * kUnits + between(-reach, reach) * kUnits / 2 / grid * grid +
                                 (grid == 1 ? between(0, 255) : 0),
                             -20 * kUnits, 50 * kUnits);
    t.z = {z, z, z};
    return t;
  }
};

/// All planes of the first view (from above) against a model of the rule.
template <typename Rule>
void expect_layers(const std::vector<Flat>& triangles, const ViewsFile& views, double t, Rule rule) {
  const std::size_t layers = views.facts.layers;
  int differing = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const auto wanted = rule(fragments(triangles, i, j), layers, t);
      const auto at = static_cast<std::size_t>(j * kSide + i);
      for (std::size_t k = 0; k < layers; ++k) {
        const auto& layer = views.layers[0][k];
        if (layer.z[at] != static_cast<float>(wanted[k].z) || layer.colour[at] != wanted[k].triangle)
          ++differing;
      }
    }
  EXPECT_EQ(0, differing);
}

TEST_F(Layers, InsertAndPeelAreThoseOfBruteForce) {
  // Heights are multiples of a quarter of the threshold: ties, equality and order all happen.
  for (int round = 0; round < 6; ++round)
    for (const float threshold : {0.125f, 0.0f}) {
      std::vector<Flat> triangles;
      for (int i = 0; i < 60; ++i) triangles.push_back(flat(static_cast<float>(between(-8, 8)) / 32));
      const TreeFile tree = tree_of(triangles);
      const std::uint32_t layers = 1 + static_cast<std::uint32_t>(round) % 4;
      expect_layers(triangles,
                    ViewsFile::parse(precomputed(tree, job_of(tree, layers, threshold, kZbvInsert))),
                    threshold, inserted);
      expect_layers(triangles, ViewsFile::parse(precomputed(tree, job_of(tree, layers, threshold, kZbvPeel))),
                    threshold, peeled);
    }
}

TEST_F(Layers, TiltedTrianglesCoverExactlyAndInterpolateDepth) {
  std::vector<Flat> triangles;
  for (int i = 0; i < 150; ++i) {
    Flat t = flat(0);
    for (float& z : t.z) z = static_cast<float>(between(-4000, 4000)) / 16384;
    triangles.push_back(t);
  }
  const TreeFile tree = tree_of(triangles);
  const auto views = ViewsFile::parse(precomputed(tree, job_of(tree, 1, 0, kZbvInsert)));
  const auto& layer = views.layers[0][0];
  int covered = 0, judged = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const auto two = peeled(fragments(triangles, i, j), 2, 0);
      const auto at = static_cast<std::size_t>(j * kSide + i);
      ASSERT_EQ(two[0].triangle == kZbvEmptyColour, layer.colour[at] == kZbvEmptyColour) << i << " " << j;
      if (two[0].triangle == kZbvEmptyColour) continue;
      ++covered;
      EXPECT_NEAR(two[0].z, layer.z[at], 1e-6) << i << " " << j;
      if (two[1].z - two[0].z < 2e-6) continue;
      ++judged;
      EXPECT_EQ(two[0].triangle, layer.colour[at]) << i << " " << j;
    }
  EXPECT_GT(covered, 700);
  EXPECT_GT(judged, covered * 9 / 10);
}

TEST_F(Layers, ThresholdMakesInsertDependOnTheOrderAndPeelNot) {
  // MO95-K3: z = 0, 0.6 t, 1.2 t.
  std::array<int, 3> order = {0, 1, 2};
  std::vector<std::size_t> depths_by_insert;
  do {
    std::vector<Flat> triangles;
    for (const int k : order) {
      Flat t = {{{{0, 0}, {20 * kUnits, 0}, {0, 20 * kUnits}}}, {}};
      t.z.fill(0.15f * static_cast<float>(k));
      triangles.push_back(t);
    }
    const TreeFile tree = tree_of(triangles);
    const auto filled = [&](std::uint32_t rule) {
      const auto views = ViewsFile::parse(precomputed(tree, job_of(tree, 3, 0.25f, rule)));
      const auto at = static_cast<std::size_t>(3 * kSide + 3);
      std::vector<float> z;
      for (const auto& layer : views.layers[0])
        if (layer.colour[at] != kZbvEmptyColour) z.push_back(layer.z[at]);
      EXPECT_EQ(0.0f, z.at(0));
      return z;
    };
    EXPECT_EQ((std::vector<float>{0.0f, 0.15f * 2}), filled(kZbvPeel));
    const auto z = filled(kZbvInsert);
    if (z.size() == 2) {
      EXPECT_EQ(0.15f * 2, z[1]);
    }
    depths_by_insert.push_back(z.size());
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(1u, *std::min_element(depths_by_insert.begin(), depths_by_insert.end()));
  EXPECT_EQ(2u, *std::max_element(depths_by_insert.begin(), depths_by_insert.end()));
}

TEST_F(Layers, InsertEqualsPeelWhereLayersAreSeparated) {
  std::vector<Flat> triangles;
  for (int i = 0; i < 40; ++i) triangles.push_back(flat(static_cast<float>(i) / 8));
  std::shuffle(triangles.begin(), triangles.end(), random_);
  const TreeFile tree = tree_of(triangles);
  auto insert = ViewsFile::parse(precomputed(tree, job_of(tree, 3, 0.125f, kZbvInsert)));
  insert.facts.rule = kZbvPeel;
  EXPECT_EQ(insert.bytes(), precomputed(tree, job_of(tree, 3, 0.125f, kZbvPeel)));
}

TEST_F(Layers, PeelDoesNotDependOnTheOrderOfTriangles) {
  TreeFile tree = random_tree(11, 80);
  JobFile job(tree);
  job.facts.rule = kZbvPeel;
  const auto before = ViewsFile::parse(precomputed(tree, job));
  std::shuffle(tree.triangles.begin(), tree.triangles.end(), random_);
  JobFile other(tree);
  other.facts.rule = kZbvPeel;
  auto after = ViewsFile::parse(precomputed(tree, other));
  after.facts.head = before.facts.head;
  EXPECT_EQ(before.bytes(), after.bytes());
}

TEST_F(Layers, NormalsInTwoBytesAreAsNearAsTheyCanBe) {
  TreeFile tree;
  tree.colours.clear();
  std::vector<std::array<double, 3>> normals;
  for (std::uint32_t i = 0; i < 250; ++i) {
    tree.colours.push_back({kZbvBranch, i, i, 0});
    const float size = 0.05f;
    std::array<Vertex, 3> v;
    for (auto& p : v)
      for (float& c : p) c = size * static_cast<float>(between(-1000, 1000)) / 1000;
    if (i < 8) {  // exactly up, down and level
      v = {Vertex{-size, 0, -size}, Vertex{-size, 0, size}, Vertex{size, 0, 0}};
      if (i & 1) std::swap(v[1], v[2]);
    }
    for (auto& p : v) {  // a place of its own in a square
      p[0] += 0.12f * (static_cast<float>(i % 16) - 7.5f);
      p[2] += 0.12f * (static_cast<float>(i / 16) - 7.5f);
    }
    const auto &a = v[0], &b = v[1], &c = v[2];
    const double ux = double(b[0]) - a[0], uy = double(b[1]) - a[1], uz = double(b[2]) - a[2];
    const double wx = double(c[0]) - a[0], wy = double(c[1]) - a[1], wz = double(c[2]) - a[2];
    std::array<double, 3> n = {uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& x : n) x /= length;
    normals.push_back(n);
    tree.add(v[0], v[1], v[2], i);
  }
  JobFile job(tree);
  job.facts.bands = 2;
  job.facts.layers = 4;
  job.facts.view_width = job.facts.view_height = 400;
  job.facts.pitch = 0.005f;
  const auto views = ViewsFile::parse(precomputed(tree, job));
  constexpr double kDegrees = 57.29577951308232;
  std::vector<bool> seen(normals.size());
  double worst = 0, worst_at_poles = 0;
  for (const auto& layer : views.layers[0])
    for (std::size_t at = 0; at < layer.z.size(); ++at) {
      if (layer.colour[at] == kZbvEmptyColour) continue;
      seen[layer.colour[at]] = true;
      const auto& n = normals[layer.colour[at]];
      const double latitude = layer.latitude[at] / 255.0 * M_PI - M_PI / 2,
                   longitude = layer.longitude[at] / 256.0 * 2 * M_PI;
      const double product = std::cos(latitude) * (std::sin(longitude) * n[0] + std::cos(longitude) * n[2]) +
                             std::sin(latitude) * n[1];
      const double angle = std::acos(std::min(1.0, product)) * kDegrees;
      worst = std::max(worst, angle);
      if (std::fabs(n[1]) == 1) worst_at_poles = std::max(worst_at_poles, angle);
    }
  EXPECT_GT(std::count(seen.begin(), seen.end(), true), 230);
  EXPECT_LE(worst, 0.783);
  EXPECT_GT(worst, 0.5);
  EXPECT_LE(worst_at_poles, 1e-5);
}

TEST_F(Layers, LongitudesWrapAndLeavesAreTurnedEarlyOrLate) {
  TreeFile tree;
  // A leaf that faces up, and a branch whose normal is level, 0.1 degrees short of a full turn.
  tree.add({-0.2f, 0, -0.2f}, {-0.2f, 0, 0.2f}, {0.2f, 0, 0}, 0);
  tree.colours.push_back({kZbvBranch, 1, 2, 0});
  const float x = 0.2f, slope = 0.2f * static_cast<float>(std::tan(0.1 / 57.29577951308232));
  tree.add({-x, 0.05f, -slope}, {x, 0.05f, slope}, {-x, 0.24f, -slope}, 2);
  for (const std::uint32_t side : {kZbvLate, kZbvEarly}) {
    JobFile job = job_of(tree, 1, 0, kZbvInsert);
    job.facts.leaf_side = side;
    const auto views = ViewsFile::parse(precomputed(tree, job));
    const auto at = static_cast<std::size_t>(16 * kSide + 16);
    const auto &above = views.layers.front()[0], &below = views.layers.back()[0], &front = views.layers[1][0];
    EXPECT_EQ(0, above.colour[at]);
    EXPECT_EQ(255, above.latitude[at]);
    EXPECT_EQ(side == kZbvEarly ? 1 : 0, below.colour[at]);
    EXPECT_EQ(side == kZbvEarly ? 0 : 255, below.latitude[at]);
    int level = 0;
    for (std::size_t k = 0; k < front.z.size(); ++k)
      if (front.colour[k] == 2) {
        ++level;
        EXPECT_EQ(128, front.latitude[k]);
        EXPECT_EQ(0, front.longitude[k]);
      }
    EXPECT_GT(level, 20);
  }
}

TEST(Views, FramesAndPitchAreThoseOfTheDefinition) {
  const TreeFile tree = random_tree(12, 50);
  const JobFile job(tree);
  const auto views = ViewsFile::parse(precomputed(tree, job));
  ASSERT_EQ(14u, views.facts.views);
  double radius = 0, height = 0;
  for (const auto& v : tree.vertices) radius = std::max<double>(radius, std::hypot(v[0], v[2]));
  for (const auto& view : views.views) {
    const double t = view.circle * M_PI / 3, p = 2 * M_PI * view.number / view.circle_views;
    EXPECT_NEAR(t, view.theta, 1e-6);
    EXPECT_NEAR(p, view.phi, 1e-6);
    const double rows[9] = {std::cos(p),
                            0,
                            -std::sin(p),
                            -std::cos(t) * std::sin(p),
                            std::sin(t),
                            -std::cos(t) * std::cos(p),
                            -std::sin(t) * std::sin(p),
                            -std::cos(t),
                            -std::sin(t) * std::cos(p)};
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(rows[k], view.frame[k], 1e-7);
    for (const auto& v : tree.vertices)
      height = std::max<double>(height, std::abs(rows[3] * v[0] + rows[4] * v[1] + rows[5] * v[2]));
  }
  EXPECT_NEAR(std::max(2 * radius * 1.02 / 60, 2 * height * 1.02 / 80), views.facts.pitch, 1e-6);
  EXPECT_NEAR(radius, views.facts.radius, 1e-6);
  EXPECT_FLOAT_EQ(-29.5f * views.facts.pitch, views.views[5].x0);
  // Nothing is cut off: no sample on the border.
  for (const auto& view : views.layers)
    for (std::size_t i = 0; i < 60; ++i) {
      EXPECT_EQ(kZbvEmptyColour, view[0].colour[i]);
      EXPECT_EQ(kZbvEmptyColour, view[0].colour[79 * 60 + i]);
    }
}

}  // namespace
}  // namespace dendro::zbuffer_views
