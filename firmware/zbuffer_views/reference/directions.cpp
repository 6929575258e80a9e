#include "firmware/zbuffer_views/reference/directions.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"

namespace dendro::zbuffer_views {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

int views_on_circle(int bands, int circle) {
  DENDRO_CHECK(bands >= 2 && circle >= 0 && circle <= bands, "circle {} of {} bands", circle, bands);
  if (circle == 0 || circle == bands) return 1;
  // The sine of a rational part of a half turn is rational at the sixths only (Niven); there the product is whole.
  if (6 * circle == bands || 6 * circle == 5 * bands) return bands + 1;
  if (2 * circle == bands) return 2 * bands + 1;
  const double product = 2 * bands * std::sin(kPi * circle / bands);
  DENDRO_CHECK(std::abs(product - std::round(product)) > 1e-9, "{} is too close to tell", product);
  return static_cast<int>(std::floor(product)) + 1;
}

std::vector<Direction> view_directions(int bands) {
  std::vector<Direction> all;
  for (int circle = 0; circle <= bands; ++circle) {
    const int count = views_on_circle(bands, circle);
    for (int j = 0; j < count; ++j)
      all.push_back({circle, j, count, kPi * circle / bands, 2 * kPi * j / count});
  }
  return all;
}

std::vector<int> choose_views(int bands, const glm::dvec3& to_viewer) {
  const double level = std::hypot(to_viewer.x, to_viewer.z);
  const double theta = std::atan2(level, to_viewer.y);
  // At a pole every longitude is right; signed zeros must not choose one.
  double phi = level == 0 ? 0 : std::atan2(to_viewer.x, to_viewer.z);
  if (phi < 0) phi += 2 * kPi;
  const int band = std::min(static_cast<int>(std::floor(theta * bands / kPi)), bands - 1);
  std::vector<int> chosen;
  for (int circle = band, first = 0, at = 0; circle <= band + 1; ++circle) {
    for (; at < circle; ++at) first += views_on_circle(bands, at);
    const int count = views_on_circle(bands, circle);
    const int j = static_cast<int>(std::floor(phi * count / (2 * kPi))) % count;
    chosen.push_back(first + j);
    chosen.push_back(first + (j + 1) % count);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace dendro::zbuffer_views
