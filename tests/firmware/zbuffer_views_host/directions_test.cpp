#include "firmware/zbuffer_views/reference/directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "sim/base/random.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;

// N-B1, with MO95's own 14 and 23 among them.
TEST(ViewDirections, AreAsManyAsTheExactRuleSays) {
  const std::size_t wanted[] = {7, 14, 23, 34, 51, 66, 87, 108, 135, 160, 191};
  for (int bands = 2; bands <= 12; ++bands) EXPECT_EQ(view_directions(bands).size(), wanted[bands - 2]) << bands;
}

TEST(ViewDirections, AreOnTheirCircleCloserThanTheBandsButNoneIsSpare) {
  for (int bands = 2; bands <= 32; ++bands)
    for (int circle = 1; circle < bands; ++circle) {
      const int count = views_on_circle(bands, circle);
      const double around = 2 * kPi * std::sin(kPi * circle / bands);
      EXPECT_LT(around / count, kPi / bands + 1e-12);
      // With one view fewer the arc would not be below pi/n (at a tie it would be equal).
      EXPECT_GE(around / (count - 1), kPi / bands - 1e-12) << bands << " " << circle;
    }
}

TEST(ViewDirections, ChosenOnesAreThreeInTheCapsAndFourBetween) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const int bands = 2 + static_cast<int>(random() % 8);
    const double theta = base::uniform(random, 0.001, kPi - 0.001), phi = base::uniform(random, 0, 2 * kPi);
    const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
    const bool cap = theta < kPi / bands || theta > kPi - kPi / bands;
    const std::vector<int> chosen = choose_views(bands, d);
    ASSERT_EQ(chosen.size(), cap ? 3u : 4u) << bands << " " << theta << " " << phi;
    const std::vector<Direction> all = view_directions(bands);
    for (const int number : chosen) {
      const Direction& view = all[static_cast<std::size_t>(number)];
      EXPECT_LE(std::abs(view.theta - theta), kPi / bands + 1e-9);
      if (view.circle_views == 1) continue;
      EXPECT_LE(std::abs(std::remainder(view.phi - phi, 2 * kPi)), 2 * kPi / view.circle_views + 1e-9);
    }
  }
}

// N-B2: on a preset direction a set of views is chosen that has the direction's own among them, whatever rounding does.
TEST(ViewDirections, APresetDirectionAndItsNeighbourhoodChooseItsOwnView) {
  for (const int bands : {2, 3, 4, 6}) {
    const std::vector<Direction> all = view_directions(bands);
    for (std::size_t number = 0; number < all.size(); ++number)
      for (const double nudge : {-1e-9, 0.0, 1e-9}) {
        const double theta = all[number].theta + nudge, phi = all[number].phi + nudge;
        const glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
        const std::vector<int> chosen = choose_views(bands, d);
        EXPECT_TRUE(std::count(chosen.begin(), chosen.end(), static_cast<int>(number))) << bands << " " << number << " " << nudge;
      }
  }
}

}  // namespace
}  // namespace dendro::zbuffer_views
