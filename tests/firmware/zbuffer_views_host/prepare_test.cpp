#include <gtest/gtest.h>

#include <functional>

#include "firmware/zbuffer_views/host/files.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"
#include "sim/base/error.h"
#include "tests/firmware/zbuffer_views_host/rig.h"

namespace dendro::zbuffer_views {
namespace {

std::string complaint(const std::function<void(scene::Scene&)>& change) {
  scene::Scene scene = small_scene();
  change(scene);
  try {
    prepared_of(scene);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Prepare, RefusesWhatTheProgramsCannotDoAndNamesTheKey) {
  const std::pair<const char*, std::function<void(scene::Scene&)>> cases[] = {
      {"test.toml:7: zbuffer_views.layers: ", [](auto& s) { set(s, "layers", std::int64_t{0}); }},
      {"test.toml:7: zbuffer_views.layers: ", [](auto& s) { set(s, "layers", std::int64_t{5}); }},
      {"test.toml:7: zbuffer_views.threshold: ", [](auto& s) { set(s, "threshold", -0.01); }},
      {"test.toml:7: zbuffer_views.bands: ", [](auto& s) { set(s, "bands", std::int64_t{1}); }},
      {"test.toml:7: zbuffer_views.view_width: ", [](auto& s) { set(s, "view_width", std::int64_t{302}); }},
      {"test.toml:7: zbuffer_views.layer: ", [](auto& s) { set(s, "layer", std::int64_t{2}); }},
      {"camera.position: is inside the tree",
       [](auto& s) {
         s.camera.projection = scene::Camera::Projection::kPerspective;
         s.camera.fov_y = 40;
         s.camera.position = {0.2, 1, 0.1};
       }},
      {"object.tree: \"oak\" is not known", [](auto& s) { s.objects[0].tree = "oak"; }},
      {"object.rotate: ", [](auto& s) { s.objects[0].rotate = {10, 0, 0}; }},
      {"object: all objects must be the same tree",
       [](auto& s) {
         s.objects.push_back(s.objects[0]);
         s.objects[1].scale = 2;
       }},
      {"object.age: ", [](auto& s) { s.objects[0].tree_parameters["age"].value = std::int64_t{0}; }},
      {"object.needles: ", [](auto& s) { s.objects[0].tree_parameters["needles"].value = std::int64_t{3}; }},
      {"zbuffer_views.draw: polygons are drawn without shadows",
       [](auto& s) {
         set(s, "draw", std::string("polygons"));
         set(s, "shadows", true);
       }},
  };
  for (const auto& [wanted, change] : cases) EXPECT_NE(complaint(change).find(wanted), std::string::npos) << wanted << " | " << complaint(change);
}

TEST(Prepare, RotationsAreRoundedToTheStepsOfAByteAndTheCentreGoesAlong) {
  scene::Scene scene = small_scene();
  scene.objects[0].rotate = {0, -90, 0};
  scene.objects[0].at = {1, 2, 3};
  const Prepared p = prepared_of(scene);
  EXPECT_EQ(p.placements[0].turn, 192);
  EXPECT_EQ(p.placements[0].at, single(glm::dvec3(1, 2 + p.tree.centre.y, 3)));
  scene.objects[0].rotate = {0, 360, 0};
  EXPECT_EQ(prepared_of(scene).placements[0].turn, 0);
}

TEST(Files, ATreesDigestIsThatOfWhatItHoldsAndAJobHasAllFrames) {
  scene::Scene scene = small_scene();
  set(scene, "frames", std::int64_t{5});
  const Prepared p = prepared_of(scene);
  const Bytes tree = tree_file(p.tree);
  const auto &model = p.tree.model;
  EXPECT_EQ(tree.size(), 4 * 13 + 16 * 4 + 12 * model.vertices.size() + 16 * model.triangles.size());
  scene.objects[0].tree_parameters["seed"].value = std::int64_t{9};
  EXPECT_NE(digest_of(tree_file(prepared_of(scene).tree)), digest_of(tree));
  EXPECT_EQ(digest_of(tree_file(prepared_of(small_scene()).tree)), digest_of(tree));
  EXPECT_EQ(job_file(p, digest_of(tree), 0, 5).size(), sizeof(zbv_job) + sizeof(zbv_placement) + 5 * sizeof(zbv_frame));
  EXPECT_NE(job_file(p, digest_of(tree), 1, 1), job_file(p, digest_of(tree), 2, 1));
}

TEST(Files, ViewsThatAreNoneOrOldOrCutAreRefusedInOneLine) {
  const Prepared p = prepared_of(small_scene());
  const Digest digest = digest_of(tree_file(p.tree));
  const auto complaint_of = [&](const Bytes& bytes) -> std::string {
    try {
      check_views(bytes, p, digest, "saved.views");
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint_of({}), "saved.views: is no file of stored views");
  EXPECT_EQ(complaint_of(tree_file(p.tree)), "saved.views: is no file of stored views");
  Bytes views(76, 0);
  for (std::size_t i = 0; i < 4; ++i) views[i] = static_cast<std::uint8_t>(kZbvViewsMagic >> (24 - 8 * i));
  views[7] = 2;
  EXPECT_EQ(complaint_of(views), "saved.views: has version 2, this dendro reads 1");
  views[7] = 1, views[11] = 80;
  EXPECT_EQ(complaint_of(views), "saved.views: is truncated or damaged: 76 bytes instead of 80");
  views[11] = 76;
  EXPECT_EQ(complaint_of(views), "saved.views: holds views of another tree than the scene's");
}

}  // namespace
}  // namespace dendro::zbuffer_views
