#include "firmware/half_space/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

TEST(Reference, ABoxCoversItsRectangleAtItsDepth) {
  const std::vector<ScreenPlane> box{
      {1, 0, 0, -20.5, PlaneKind::kEdgeOn, 0}, {-1, 0, 0, 9.5, PlaneKind::kEdgeOn, 0},
      {0, 1, 0, -30, PlaneKind::kEdgeOn, 0},   {0, -1, 0, 15, PlaneKind::kEdgeOn, 0},
      {0, 0, -2, 200, PlaneKind::kFront, 1},   {0, 0, 1, -300, PlaneKind::kBack, 0}};
  const ReferencePicture picture = render_reference(box, {{0, 0, 9}, {1, 2, 3}}, 40, 40, 4095);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool covered =
          x >= 10 && x <= 20 && y >= 15 && y <= 30;  // a line through a pixel's centre is inside
      ASSERT_EQ(picture.face[picture.at(x, y)], covered ? 1 : 0) << x << "," << y;
      ASSERT_EQ(picture.depth[picture.at(x, y)], covered ? 100.0 : 0.0);
      ASSERT_EQ(picture.rgb[3 * picture.at(x, y) + 2], covered ? 3 : 9);
    }
}

TEST(Reference, WithoutBackPlaneOrWithFrontBehindBackIsBackground) {
  const ScreenPlane front{0, 0, -1, 100, PlaneKind::kFront, 1}, back{0, 0, 1, -50, PlaneKind::kBack, 0};
  for (const auto& planes : {std::vector<ScreenPlane>{front}, {front, back}})
    for (const std::uint8_t face : render_reference(planes, {{}, {}}, 4, 4, 4095).face) EXPECT_EQ(face, 0);
}

TEST(Reference, TheLowestFaceNumberWinsATie) {
  const std::vector<ScreenPlane> planes{{0, 0, 1, -50, PlaneKind::kBack, 0},
                                        {0, 0, -1, 20, PlaneKind::kFront, 1},
                                        {0, 0, -3, 60, PlaneKind::kFront, 2}};
  for (const std::uint8_t face : render_reference(planes, {{}, {}, {}}, 4, 4, 4095).face) EXPECT_EQ(face, 1);
}

TEST(Reference, AMirroredHullGivesTheMirroredPicture) {
  Prepared prepared = prepare(pine(32));
  const ReferencePicture picture = reference_of(prepared);
  // x -> 511 - x
  for (ScreenPlane& plane : prepared.screen) plane.d += 511 * plane.a, plane.a = -plane.a;
  const ReferencePicture mirrored = reference_of(prepared);
  int different = 0;
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x)
      different += picture.face[picture.at(x, y)] != mirrored.face[mirrored.at(511 - x, y)];
  EXPECT_EQ(different, 0);
}

TEST(Compare, IdenticalPicturesHaveNoError) {
  const Prepared prepared = prepare(icosahedron(64));
  const ReferencePicture reference = reference_of(prepared);
  SimulatedPicture same{reference.face, {}};
  for (const double z : reference.depth) same.front.push_back(static_cast<std::uint16_t>(z));
  const ErrorReport report = compare(reference, same, reference.rgb.data());
  EXPECT_FALSE(report.psnr_db);
  EXPECT_EQ(report.wrong_pixels, 0);
  EXPECT_LE(report.max_depth_error, 0.5);
  EXPECT_GT(report.covered_pixels, 500);
}

TEST(Compare, SeesOneWrongPixelAndHowFarItIsFromAnEdge) {
  const Prepared prepared = prepare(icosahedron(64));
  const ReferencePicture reference = reference_of(prepared);
  SimulatedPicture simulated{reference.face, {}};
  for (const double z : reference.depth) simulated.front.push_back(static_cast<std::uint16_t>(z));
  simulated.face[0] = 1;  // a corner of the picture, far from everything
  std::vector<std::uint8_t> rgb = reference.rgb;
  rgb[0] ^= 0x80;
  const ErrorReport far_away = compare(reference, simulated, rgb.data());
  EXPECT_EQ(far_away.wrong_pixels, 1);
  EXPECT_EQ(extra(far_away, "wrong_pixels_far"), 1);
  EXPECT_NEAR(*far_away.psnr_db, 10 * std::log10(255.0 * 255.0 * 64 * 64 * 3 / (128.0 * 128.0)), 1e-9);

  simulated.face[0] = 0;
  const auto edge = std::find_if(reference.face.begin(), reference.face.end(), [](int f) { return f != 0; });
  simulated.face[static_cast<std::size_t>(edge - reference.face.begin())] = 0;
  const ErrorReport at_edge = compare(reference, simulated, rgb.data());
  EXPECT_EQ(at_edge.wrong_pixels, 1);
  EXPECT_EQ(extra(at_edge, "wrong_pixels_far"), 0);
}

TEST(Compare, NamesThePixelOfTheLargestDepthError) {
  const Prepared prepared = prepare(icosahedron(64));
  const ReferencePicture reference = reference_of(prepared);
  SimulatedPicture simulated{reference.face, {}};
  for (const double z : reference.depth) simulated.front.push_back(static_cast<std::uint16_t>(z));
  ASSERT_NE(reference.face[reference.at(30, 33)], 0);
  simulated.front[reference.at(30, 33)] += 7;
  const ErrorReport report = compare(reference, simulated, reference.rgb.data());
  EXPECT_NEAR(report.max_depth_error, 7, 0.5);
  EXPECT_EQ(extra(report, "worst_x"), 30);
  EXPECT_EQ(extra(report, "worst_y"), 33);
}

}  // namespace
}  // namespace dendro::half_space
