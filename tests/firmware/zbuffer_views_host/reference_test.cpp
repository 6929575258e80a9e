#include "firmware/zbuffer_views/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

#include "tests/firmware/zbuffer_views_host/rig.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;

void look_from(Prepared& p, double theta, double phi) {
  const Axes axes = view_axes(theta, phi);
  p.frames = {{p.tree.centre - axes.forward * 20.0, axes, glm::normalize(glm::dvec3(1, 2, 1))}};
}

std::int64_t differing(const ReferencePicture& a, const ReferencePicture& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.colour.size(); ++i)
    count += a.colour[i] != b.colour[i] || a.shadow[i] != b.shadow[i] ||
             (a.colour[i] != kNoColour && std::abs(a.depth[i] - b.depth[i]) > 1e-6);
  return count;
}

ReferencePicture picture_of(const Prepared& p) { return reconstruct(p, make_views(p.tree, p.views), p.frames.front()); }

void add_square(TreeModel& model, const glm::dvec3& middle, const glm::dvec3& a, const glm::dvec3& b, Part part) {
  const std::uint32_t c[] = {model.add_vertex(middle - a - b), model.add_vertex(middle + a - b), model.add_vertex(middle + a + b),
                             model.add_vertex(middle - a + b)};
  model.add_triangle(c[0], c[1], c[2], part);
  model.add_triangle(c[0], c[2], c[3], part);
}

/// A ball of triangles that look outwards.
TreeModel ball(double radius, int rings) {
  TreeModel model;
  std::vector<std::vector<std::uint32_t>> grid;
  for (int i = 0; i <= rings; ++i) {
    grid.emplace_back();
    for (int j = 0; j < 2 * rings; ++j) {
      const double theta = kPi * i / rings, phi = kPi * j / rings;
      grid.back().push_back(model.add_vertex({radius * std::sin(theta) * std::sin(phi), radius * std::cos(theta),
                                              radius * std::sin(theta) * std::cos(phi)}));
    }
  }
  for (std::size_t i = 0; i + 1 < grid.size(); ++i)
    for (std::size_t j = 0; j < grid[i].size(); ++j) {
      const std::size_t next = (j + 1) % grid[i].size();
      model.add_triangle(grid[i][j], grid[i + 1][j], grid[i + 1][next], Part::kTrunk);
      if (i > 0) model.add_triangle(grid[i][j], grid[i + 1][next], grid[i][next], Part::kTrunk);
    }
  model.triangles.erase(std::remove_if(model.triangles.begin(), model.triangles.end(),
                                       [&](const auto& t) {
                                         const glm::dvec3& a = model.vertices[t[0]];
                                         return glm::length(glm::cross(model.vertices[t[1]] - a, model.vertices[t[2]] - a)) < 1e-9;
                                       }),
                        model.triangles.end());
  model.parts.resize(model.triangles.size(), Part::kTrunk);
  return model;
}

// From a preset direction, in the view's own raster, nothing is moved: the picture is that of the polygons.
TEST(Reference, FromAPresetDirectionInTheViewsOwnRasterItIsThePolygons) {
  Prepared p = prepared_of(small_scene());
  p.views.layers = 1;
  p.views.width = 100, p.views.height = 160;
  p.views.pitch = window_pitch(p.tree, p.views);
  p.scale = 1 / p.views.pitch;
  look_from(p, kPi / 2, 0);
  std::vector<StoredView> views = make_views(p.tree, p.views);
  // Only the view itself: the others would add what it does not see.
  const auto own = choose_views(p.views.bands, -p.frames[0].axes.forward).front();
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (static_cast<int>(i) == own) continue;
    for (auto& layer : views[i].layers) std::fill(layer.begin(), layer.end(), Sample{});
  }
  const ReferencePicture wanted = draw_polygons(p, p.frames[0]), found = reconstruct(p, views, p.frames[0]);
  EXPECT_GT(wanted.covered(), 2000);
  EXPECT_EQ(differing(found, wanted), 0);
}

TEST(Reference, FromAnywhereMostPixelsAreThePolygonsAndMoreLayersHelp) {
  Prepared p = prepared_of(small_scene());
  p.views.peel = true;
  std::int64_t wrong[4] = {}, covered = 0;
  for (const auto& [theta, phi] : {std::pair(1.3, 0.4), std::pair(1.0, 2.0), std::pair(0.5, 4.4), std::pair(1.8, 5.5)}) {
    look_from(p, theta, phi);
    const ReferencePicture wanted = draw_polygons(p, p.frames[0]);
    covered += wanted.covered();
    for (int layers = 1; layers <= 3; ++layers) {
      p.views.layers = layers;
      const ReferencePicture found = picture_of(p);
      for (std::size_t i = 0; i < wanted.colour.size(); ++i)
        wrong[layers] += wanted.colour[i] != kNoColour && found.depth[i] > wanted.depth[i] + 0.2;
    }
  }
  // A pixel shows what is too far where the nearest surface is hidden in all views.
  EXPECT_LT(wrong[1], covered / 10);
  EXPECT_LT(wrong[2], wrong[1]);
  EXPECT_LE(wrong[3], wrong[2]);
}

TEST(Reference, PeeledPicturesDoNotDependOnTheOrderOfTheTriangles) {
  Prepared p = prepared_of(small_scene());
  p.views.peel = true;
  look_from(p, 1.2, 0.5);
  const ReferencePicture wanted = picture_of(p);
  std::vector<std::size_t> order(p.tree.model.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(6));
  Prepared shuffled = p;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.tree.model.triangles[i] = p.tree.model.triangles[order[i]];
    shuffled.tree.colour_of[i] = p.tree.colour_of[order[i]];
  }
  EXPECT_EQ(differing(picture_of(shuffled), wanted), 0);
}

TEST(Reference, ATreeTwiceInOnePlaceIsOneTree) {
  Prepared p = prepared_of(small_scene());
  p.shadows = true;
  p.light_width = p.light_height = 128, p.light_scale = 20;
  look_from(p, 1.2, 0.5);
  const ReferencePicture wanted = picture_of(p);
  p.placements.push_back(p.placements.front());
  EXPECT_EQ(differing(picture_of(p), wanted), 0);
}

TEST(Reference, AQuarterTurnOfTreeCameraAndLightChangesNothing) {
  Prepared p = prepared_of(small_scene());
  p.shadows = true;
  p.light_width = p.light_height = 128, p.light_scale = 20;
  look_from(p, 1.2, 0.5);
  const ReferencePicture wanted = picture_of(p);
  p.placements[0].turn = 64;
  look_from(p, 1.2, 0.5 + kPi / 2);
  p.frames[0].to_light = glm::normalize(glm::dvec3(1, 2, -1));
  const ReferencePicture found = picture_of(p);
  // Points on the border of two pixels may fall to either side.
  EXPECT_LE(differing(found, wanted), wanted.covered() / 500);
}

TEST(Reference, TwiceTheSizeAtHalfTheScaleIsTheSamePicture) {
  Prepared p = prepared_of(small_scene());
  look_from(p, 1.0, 0.7);
  const ReferencePicture wanted = picture_of(p);
  Prepared big = p;
  for (glm::dvec3& v : big.tree.model.vertices) v *= 2.0;
  big.tree = [&] {
    Tree tree = big.tree;
    tree.centre *= 2.0, tree.radius *= 2, tree.half_height *= 2;
    return tree;
  }();
  big.views.threshold *= 2, big.scale /= 2, big.placements[0].at *= 2.0;
  big.frames[0].eye *= 2.0;
  ReferencePicture found = picture_of(big);
  for (double& depth : found.depth) depth /= 2;
  EXPECT_EQ(differing(found, wanted), 0);
}

// N-B8, first direction: on a convex solid a pixel that looks at the sun is lit.
TEST(Reference, AConvexSolidShadowsOnlyWhatIsAlmostEdgeOnToTheSun) {
  Prepared p = prepared_of(ball(1, 40));
  p.views.layers = 1, p.views.threshold = 0.01;
  p.views.width = p.views.height = 256;
  p.shadows = true, p.light_width = p.light_height = 128, p.light_scale = 60;
  p.width = p.height = 100, p.scale = 40;
  p.centre_x = p.centre_y = 49.5;
  p.epsilon = 2.6 + 1;  // N-B8 at 75 degrees, and the source views' own reprojection error
  look_from(p, 1.1, 0.3);
  const ReferencePicture found = picture_of(p);
  const auto views = make_views(p.tree, p.views);
  std::int64_t lit = 0, wrong = 0;
  for (std::size_t i = 0; i < found.colour.size(); ++i) {
    if (found.colour[i] == kNoColour) continue;
    const auto column = static_cast<double>(i % 100), row = 99 - static_cast<double>(i / 100);
    const Axes& axes = p.frames[0].axes;
    const glm::dvec3 point = p.frames[0].eye + axes.inverse({(column - 49.5) / 40, (row - 49.5) / 40, found.depth[i]});
    if (glm::dot(glm::normalize(point - p.tree.centre), p.frames[0].to_light) < std::cos(75 * kPi / 180)) continue;
    ++lit;
    wrong += found.shadow[i];
  }
  EXPECT_GT(lit, 1500);
  EXPECT_EQ(wrong, 0);
}

// The other direction: what lies behind another surface by twice the threshold is dark.
TEST(Reference, ASlabShadowsTheOneBehindIt) {
  TreeModel model;
  add_square(model, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}, Part::kTrunk);
  add_square(model, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, Part::kTrunk);
  Prepared p = prepared_of(std::move(model));
  p.shadows = true, p.light_width = p.light_height = 96, p.light_scale = 30, p.epsilon = 2.6;
  p.width = p.height = 96, p.scale = 20, p.centre_x = p.centre_y = 47.5;
  // From the side both are seen: the lower one below the upper one's edge.
  look_from(p, 1.25, 0);
  p.frames[0].to_light = {0, 1, 0};
  const ReferencePicture found = picture_of(p);
  std::int64_t upper = 0, lower = 0, upper_dark = 0, lower_lit = 0;
  for (std::size_t i = 0; i < found.colour.size(); ++i) {
    if (found.colour[i] == kNoColour) continue;
    const double row = 95 - static_cast<double>(i / 96);
    const glm::dvec3 point =
        p.frames[0].eye + p.frames[0].axes.inverse({0, (row - 47.5) / 20, found.depth[i]});
    const bool top = point.y > 0.5;
    (top ? upper : lower) += 1;
    if (top) upper_dark += found.shadow[i];
    if (!top) lower_lit += !found.shadow[i];
  }
  EXPECT_GT(upper, 200);
  EXPECT_GT(lower, 200);
  EXPECT_EQ(upper_dark, 0);
  // The lower one's outermost pixels may lie outside of the upper one's shadow by a light pixel.
  EXPECT_LT(lower_lit, lower / 5);
}

TEST(Reference, ALeafShowsTheColourOfTheSideThatIsSeen) {
  TreeModel model;
  add_square(model, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}, Part::kLeaf);
  add_square(model, {0, 0.5, 0}, {0.1, 0, 0}, {0, 0.1, 0}, Part::kTrunk);
  Prepared p = prepared_of(std::move(model));
  p.ambient = 1, p.diffuse = 0;
  for (const bool early : {false, true})
    for (const bool above : {true, false}) {
      p.views.early = early;
      look_from(p, above ? 0.9 : kPi - 0.9, 0.2);
      const ReferencePicture found = picture_of(p);
      std::int64_t top = 0, below = 0;
      for (std::size_t i = 0; i < found.colour.size(); ++i) {
        top += found.colour[i] != kNoColour && found.rgb[3 * i] == 60;
        below += found.colour[i] != kNoColour && found.rgb[3 * i] == 220;
      }
      EXPECT_GT(above ? top : below, 1000) << early;
      EXPECT_EQ(above ? below : top, 0) << early;
    }
}

TEST(Reference, PerspectiveIsThePolygonsToo) {
  scene::Scene scene = small_scene();
  scene.camera.projection = scene::Camera::Projection::kPerspective;
  scene.camera.fov_y = 15;
  Prepared p = prepared_of(scene);
  p.views.layers = 3;
  const ReferencePicture wanted = draw_polygons(p, p.frames[0]), found = picture_of(p);
  EXPECT_GT(wanted.covered(), 2000);
  std::int64_t same = 0, both = 0;
  for (std::size_t i = 0; i < wanted.colour.size(); ++i) {
    if (wanted.colour[i] == kNoColour || found.colour[i] == kNoColour) continue;
    ++both;
    same += std::abs(wanted.depth[i] - found.depth[i]) < 0.1;
  }
  EXPECT_GT(both, wanted.covered() * 9 / 10);
  // Thin leaves at pixel borders differ; a wrong projection would leave next to nothing.
  EXPECT_GT(same, both * 3 / 4);
}

}  // namespace
}  // namespace dendro::zbuffer_views
