#include <gmpxx.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/firmware/half_space/scenes.h"

// The same pictures in exact rationals, per pixel and without stepping.

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr unsigned kSeed = 1986;

struct ExactHit {
  int face = 0;
  mpq_class depth;
};

ExactHit exact_hit(const std::vector<ScreenPlane>& planes, int x, int y, int maxdepth) {
  mpq_class back = maxdepth;
  ExactHit front;
  for (const ScreenPlane& plane : planes) {
    const mpq_class rest = mpq_class(plane.a) * x + mpq_class(plane.b) * y + mpq_class(plane.d);
    if (plane.c == 0) {
      if (rest > 0) return {};
      continue;
    }
    const mpq_class z = -rest / mpq_class(plane.c);
    if (plane.c > 0 && z < back) back = z;
    if (plane.c < 0 && (front.face == 0 || z > front.depth)) front = {plane.face, z};
  }
  return front.face != 0 && back < maxdepth && front.depth < back ? front : ExactHit{};
}

void expect_reference_is_exact(const Prepared& prepared, int pixels) {
  const ReferencePicture reference = reference_of(prepared);
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> column(0, reference.width - 1), row(0, reference.height - 1);
  int covered = 0;
  for (int i = 0; i < pixels; ++i) {
    const int x = column(random), y = row(random);
    const ExactHit exact = exact_hit(prepared.screen, x, y, prepared.program.maxdepth);
    ASSERT_EQ(reference.face[reference.at(x, y)], exact.face) << "seed " << kSeed << " at " << x << "," << y;
    if (exact.face == 0) continue;
    ++covered;
    ASSERT_NEAR(reference.depth[reference.at(x, y)], exact.depth.get_d(), 1e-8) << x << "," << y;
  }
  EXPECT_GT(covered, pixels / 8);
}

TEST(Exact, ReferenceOfTheIcosahedronAgreesWithRationals) {
  expect_reference_is_exact(prepare(icosahedron()), 800);
  scene::Scene turned = icosahedron();
  turned.objects[0].rotate = {17, 41, 5};
  expect_reference_is_exact(prepare(turned), 800);
}

TEST(Exact, ReferenceOfATreesHullAgreesWithRationals) { expect_reference_is_exact(prepare(pine(32)), 800); }

TEST(Exact, EdgeOnFacesCutTheSilhouetteLikeTheExactHalfPlanes) {  // N-A3
  const Prepared prepared = prepare(icosahedron(128));
  const FixedPointPicture picture = run_fixed_point(prepared.program);
  int emptied = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      bool outside = false;
      for (const ScreenPlane& plane : prepared.screen)
        if (plane.kind == PlaneKind::kEdgeOn)
          outside = outside || mpq_class(plane.a) * x + mpq_class(plane.b) * y + mpq_class(plane.d) > 0;
      const std::uint32_t word = picture.pixels[128 * y + x];
      ASSERT_TRUE(!outside || (word >> kFaceLow & kFaceMask) == 0) << x << "," << y;
      emptied += outside;
    }
  EXPECT_GT(emptied, 1000);
}

/// A back plane almost edge-on before a flat one: it empties pixels on one side of a line.
PlaneProgram steep_program(double slope, SteepPolicy policy) {
  PlaneProgram program;
  program.width = program.height = 512;
  program.box = {0, 0, 511, 511};
  program.steep = policy;
  const ScreenPlane back{0, 0, 1, -4000, PlaneKind::kBack, 0};
  const ScreenPlane steep{-slope, slope / 7, 1, slope * 250.3, PlaneKind::kBack, 0};
  const ScreenPlane screen{0, 0, -1, 5, PlaneKind::kFront, 1};
  for (const ScreenPlane& plane : {back, steep})
    program.back.push_back(make_record(plane, program.box, policy, 2047));
  program.front.push_back(make_record(screen, program.box, policy, 2047));
  return program;
}

int wrong_against_rationals(const PlaneProgram& program, double slope) {
  const FixedPointPicture picture = run_fixed_point(program);
  int wrong = 0;
  for (int y = 0; y < 512; y += 3)
    for (int x = 0; x < 512; ++x) {
      const mpq_class z = mpq_class(slope) * x - mpq_class(slope / 7) * y - mpq_class(slope * 250.3);
      const bool covered = z >= 6;  // floor(z) > 5, the front plane's depth
      wrong += covered != (picture.pixels[512 * y + x] != kBackgroundWord);
    }
  return wrong;
}

TEST(Exact, ASteepPlaneIsRightOnlyInAWideRecord) {  // N-A1
  for (const double slope : {200.0, 1000.0, 123456.789}) {
    EXPECT_TRUE(steep_program(slope, SteepPolicy::kWide).back[1].wide);
    EXPECT_EQ(wrong_against_rationals(steep_program(slope, SteepPolicy::kWide), slope), 0) << slope;
  }
  EXPECT_GT(wrong_against_rationals(steep_program(1000, SteepPolicy::kWrap), 1000), 100);
  EXPECT_GT(wrong_against_rationals(steep_program(1000, SteepPolicy::kSaturate), 1000), 100);
}

TEST(Exact, EveryDepthOfThePassesIsTheFloorOfTheRecordsRationalDepth) {
  const PlaneProgram program = prepare(pine(32, 256)).program;
  const FixedPointPicture picture = run_fixed_point(program);
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> column(program.box.x0, program.box.x1),
      row(program.box.y0, program.box.y1);
  const auto depth = [&](const PlaneRecord& plane, int x, int y) {
    const mpq_class z = mpq_class(mpz_class(static_cast<long>(plane.start))) +
                        mpq_class(mpz_class(static_cast<long>(plane.step_x))) * (x - program.box.x0) +
                        mpq_class(mpz_class(static_cast<long>(plane.step_y))) * (y - program.box.y0);
    mpz_class floor;
    const mpq_class scaled = z / 65536;
    mpz_fdiv_q(floor.get_mpz_t(), scaled.get_num().get_mpz_t(), scaled.get_den().get_mpz_t());
    if (plane.kind == PlaneKind::kEdgeOn) return z > 0 ? 1 : 0;
    return static_cast<int>(
        std::clamp<long>(floor.fits_slong_p() ? floor.get_si() : sgn(floor) * 100000L, 0, program.maxdepth));
  };
  for (int i = 0; i < 1000; ++i) {
    const int x = column(random), y = row(random);
    int back = program.maxdepth, front = 0, face = 0;
    bool outside = false;
    for (const PlaneRecord& plane : program.back) back = std::min(back, depth(plane, x, y));
    for (const PlaneRecord& plane : program.edge_on) outside = outside || depth(plane, x, y) != 0;
    for (const PlaneRecord& plane : program.front)
      if (const int z = depth(plane, x, y); face == 0 || z > front) front = z, face = plane.face;
    const bool covered = !outside && front < back && back < program.maxdepth;
    const std::uint32_t wanted =
        covered ? static_cast<std::uint32_t>(face << kFaceLow | front) : kBackgroundWord;
    ASSERT_EQ(picture.pixels[256 * y + x], wanted) << "seed " << kSeed << " at " << x << "," << y;
  }
}

}  // namespace
}  // namespace dendro::half_space
