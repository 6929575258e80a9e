#include <gtest/gtest.h>

#include <cmath>

#include "firmware/half_space/stability/support.h"

namespace dendro::half_space {
namespace {

constexpr std::uint64_t kSeed = 4;

Prepared hull(int cuts, int side = 90) {
  std::mt19937_64 random(kSeed);
  return prepare(looking_at(random_hull(random, cuts), side, 3.0));
}

TEST(ExactPlane, IsTheFloorOfTheRationalValueInUnitsOfTwoToTheMinus32) {
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> coefficient(-3, 3);
  for (int i = 0; i < 200; ++i) {
    ScreenPlane p{coefficient(random), coefficient(random), coefficient(random), 100 * coefficient(random)};
    p.kind = p.c > 0 ? PlaneKind::kBack : PlaneKind::kFront;
    ExactPlane exact(p);
    const int x = static_cast<int>(random() % 512), y = static_cast<int>(random() % 512);
    const mpq_class z = -(mpq_class(p.a) * x + mpq_class(p.b) * y + mpq_class(p.d)) / mpq_class(p.c);
    const mpq_class low =
        mpq_class(mpz_class(static_cast<long>(exact.floor32(x, y)))) / mpq_class(4294967296.0);
    ASSERT_LE(low, z) << "seed " << kSeed << " number " << i;
    ASSERT_LT(z, low + mpq_class(0x1p-32)) << "seed " << kSeed << " number " << i;
  }
}

TEST(ExactRecordWords, AreThoseOfTheSteppedIntegersAndNotThoseOfAWrappingAdder) {
  const Prepared prepared = hull(12);
  ASSERT_GT(prepared.program.wide_records(), 0u);
  EXPECT_EQ(run_fixed_point(prepared.program).pixels, exact_record_words(prepared.program));
  std::mt19937_64 random(kSeed);
  const scene::Scene scene = looking_at(random_hull(random, 12), 512, 3.0);
  const Prepared wrap = prepare(with(scene, "steep", {std::string("wrap"), {"t", 0}}));
  EXPECT_NE(run_fixed_point(wrap.program).pixels, exact_record_words(wrap.program));
}

TEST(Enclosure, HoldsEveryWordOfThePassesAndObjectsToEveryOtherWordWhereItIsDecided) {
  const Prepared prepared = hull(12);
  const Words words = run_fixed_point(prepared.program).pixels;
  Enclosure enclosure(prepared);
  int decided = 0, faces = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 90; ++x) {
      const std::uint32_t word = words[static_cast<std::size_t>(90 * y + x)];
      ASSERT_EQ("", enclosure.objection(x, y, word));
      if (!enclosure.decided(x, y)) continue;
      ++decided;
      const bool covered = face_of(word) != 0;
      faces += covered;
      ASSERT_NE("", enclosure.objection(x, y, covered ? kBackgroundWord : 1u << kFaceLow | 2000))
          << x << "," << y;
      if (!covered) continue;
      ASSERT_NE("", enclosure.objection(x, y, word + 1)) << x << "," << y;
      ASSERT_NE("", enclosure.objection(x, y, word + (1u << kFaceLow))) << x << "," << y;
    }
  EXPECT_GT(decided, 7000);
  EXPECT_GT(faces, 1000);
}

TEST(Enclosure, SaysWhichPixelWhichPlaneAndWhichStep) {
  const Prepared prepared = from_screen({{0, 0, 1, -900}, {0.5, 0, -1, 100}}, 64, 64);
  Enclosure enclosure(prepared);
  const std::string objection = enclosure.objection(20, 7, 1u << kFaceLow | 300);
  for (const char* part :
       {"pixel (20, 7)", "face 1 at depth 300", "plane 2 (front, face 1)", "step 20 of line 7", "110.000000"})
    EXPECT_NE(std::string::npos, objection.find(part)) << part << " in: " << objection;
  EXPECT_EQ("", enclosure.objection(21, 7, 1u << kFaceLow | 110));
}

TEST(Enclosure, AllowsTwiceAsMuchForTruncatedRecordsAsForRoundedOnes) {
  const Prepared prepared = hull(3);
  const Enclosure rounded(prepared, Rounding::kNearest), truncated(prepared, Rounding::kTruncated);
  const double ratio =
      static_cast<double>(truncated.slack(0, 80, 80)) / static_cast<double>(rounded.slack(0, 80, 80));
  EXPECT_NEAR(ratio, 2.0, 1e-3);
  EXPECT_NEAR(static_cast<double>(rounded.slack(0, 80, 80)) * 0x1p-32, 161 * 0x1p-17, 1e-6);
}

TEST(ExactPlane, TruncatedRecordsLieBelowRoundedOnesByLessThanOneStep) {
  const Prepared prepared = hull(12);
  const Box& box = prepared.program.box;
  for (const ScreenPlane& plane : prepared.screen) {
    if (plane.kind == PlaneKind::kEdgeOn) continue;
    const PlaneRecord nearest = make_record(plane, box, SteepPolicy::kWide, 0);
    const PlaneRecord down = ExactPlane(plane).truncated(box);
    for (const auto& [a, b] : {std::pair(nearest.start, down.start),
                               {nearest.step_x, down.step_x},
                               {nearest.step_y, down.step_y}}) {
      EXPECT_GE(a - b, 0);
      EXPECT_LE(a - b, 1);
    }
  }
}

}  // namespace
}  // namespace dendro::half_space
