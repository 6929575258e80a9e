#include <cmath>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

/// N-B8: how far behind the light buffer a point must lie to be in shadow.
namespace dendro::zbuffer_views {
namespace {

using Picture = Pictures::Picture;

TreeFile sphere() {
  TreeFile tree;
  tree.colours = {{kZbvTrunk, 0xFFFFFF, 0, 0}};
  const int rows = 24, columns = 48;
  const auto point = [&](int j, int i) -> Vertex {
    const double t = M_PI * j / rows, p = 2 * M_PI * i / columns;
    return {static_cast<float>(std::sin(t) * std::sin(p)), static_cast<float>(std::cos(t)),
            static_cast<float>(std::sin(t) * std::cos(p))};
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (j > 0) tree.add(point(j, i), point(j + 1, i + 1), point(j, i + 1), 0);
      if (j + 1 < rows) tree.add(point(j, i), point(j + 1, i), point(j + 1, i + 1), 0);
    }
  return tree;
}

JobFile job_of(const TreeFile& tree, float epsilon) {
  JobFile job(tree);
  job.facts.view_width = job.facts.view_height = 200;
  job.facts.threshold = 0.01f;
  job.facts.width = job.facts.height = 128;
  job.facts.centre_x = job.facts.centre_y = 63.5f;
  job.facts.scale = 60;
  job.facts.shadows = 1;
  job.facts.light_width = job.facts.light_height = 160;
  job.facts.light_scale = 60;
  job.facts.epsilon = epsilon;
  return job;
}

/// Pixels of a lit side tilted by less than 60 degrees that are in shadow nevertheless.
int wrongly_shadowed(float epsilon, int* lit) {
  const TreeFile tree = sphere();
  JobFile job = job_of(tree, epsilon);
  job.frames = {look({3, 2, 6}, {0, 0, 0}, {-0.3, 0.9, 0.5})};
  const std::string views = precomputed(tree, job);
  const Picture with = reconstructed(views, job).pictures.at(0);
  job.facts.shadows = 0;
  const Picture without = reconstructed(views, job).pictures.at(0);
  int wrong = 0;
  *lit = 0;
  for (std::size_t k = 0; k < with.red.size(); ++k) {
    if (without.colour[k] == kZbvEmptyColour || without.red[k] < 255 * (0.3 + 0.7 * 0.51)) continue;
    ++*lit;
    wrong += with.red[k] != without.red[k];
  }
  return wrong;
}

TEST(Shadows, ALitConvexSolidHasNoneAtTheThresholdForItsTilt) {
  // Half a light pixel's diagonal times tan 60, and half a pixel's diagonal of the picture over cos 60.
  int lit = 0;
  EXPECT_EQ(0, wrongly_shadowed(static_cast<float>(std::sqrt(0.5) * (std::sqrt(3.0) + 2)), &lit));
  EXPECT_GT(lit, 2000);
  // Without a threshold the rounding shows.
  EXPECT_GT(wrongly_shadowed(0, &lit), 100);
}

TEST(Shadows, ASlabTwoThresholdsAboveAnotherShadowsIt) {
  TreeFile tree;
  tree.colours = {{kZbvTrunk, 0xFFFFFF, 0, 0}, {kZbvTrunk, 0xFF0000, 1, 0}};
  const float epsilon = 2.6f, gap = 2 * epsilon / 60;
  const auto slab = [&](float half, float y, std::uint32_t colour) {
    tree.add({-half, y, -half}, {-half, y, half}, {half, y, half}, colour);
    tree.add({-half, y, -half}, {half, y, half}, {half, y, -half}, colour);
  };
  slab(0.8f, 0, 0);
  slab(0.35f, gap, 1);
  // The shadow falls 0.13 beside the upper slab, where the camera sees it.
  const std::array<double, 3> light = {1.5 * gap, gap, 0};
  for (const bool perspective : {false, true}) {
    JobFile job = job_of(tree, epsilon);
    job.frames = {look({1, 7, 2}, {0, 0, 0}, light)};
    if (perspective) {
      job.facts.projection = kZbvPerspective;
      job.facts.scale = 440;
    }
    const Picture picture = reconstructed(precomputed(tree, job), job).pictures.at(0);
    const zbv_frame& f = job.frames[0];
    int shadowed = 0, lit = 0;
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i) {
        const auto at = static_cast<std::size_t>((127 - j) * 128 + i);
        if (picture.colour[at] != 0) continue;
        const double z = picture.depth[at], wide = perspective ? z : 1;
        const double x = (i - 63.5) / job.facts.scale * wide, y = (j - 63.5) / job.facts.scale * wide;
        double p[3];
        for (int k = 0; k < 3; ++k)
          p[k] = f.eye[k] + x * f.frame[k] + y * f.frame[3 + k] + z * f.frame[6 + k];
        // Where the ray to the light passes the upper slab's height.
        const double to_x = p[0] + 1.5 * gap, distance = std::max(std::fabs(to_x), std::fabs(p[2])) - 0.35;
        if (std::fabs(distance) < 3.0 / 60) continue;
        const bool dark = picture.red[at] == 77;
        EXPECT_EQ(distance < 0, dark) << i << " " << j;
        ++(dark ? shadowed : lit);
      }
    EXPECT_GT(shadowed, 80);
    EXPECT_GT(lit, 2000);
  }
}

}  // namespace
}  // namespace dendro::zbuffer_views
