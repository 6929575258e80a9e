#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "sim/base/check.h"
#include "sim/scene/plane_set.h"

// max r with normal_i·p + r <= offset_i has the dual  min sum(offset_i y_i)  with  sum(y_i normal_i) = 0,
// sum(y_i) = 1, y >= 0: four rows whatever the number of planes. The simplex method on the dual ends with
// multipliers of the rows that are the wanted (p, r).

namespace dendro::scene {
namespace {

using Column = std::array<double, 4>;

constexpr double kReducedCostTolerance = 1e-12;
constexpr double kPivotTolerance = 1e-11;

class DualSimplexTableau {
 public:
  DualSimplexTableau(const PlaneSet& planes, double unit) {
    for (const HalfSpace& plane : planes) {
      columns_.push_back({plane.normal.x, plane.normal.y, plane.normal.z, 1.0});
      costs_.push_back(plane.offset / unit);
    }
    real_columns_ = columns_.size();
    for (int row = 0; row < 4; ++row) {  // artificial columns: the first basis
      Column unit_column{};
      unit_column[row] = 1.0;
      columns_.push_back(unit_column);
      costs_.push_back(0.0);
      inverse_[row] = unit_column;
      basis_[row] = real_columns_ + row;
    }
    values_ = {0, 0, 0, 1};
  }

  /// Multipliers of the rows at the optimum: (p, r) in units.
  Column solve() {
    std::vector<double> phase_one(columns_.size(), 0.0);
    for (std::size_t i = real_columns_; i < columns_.size(); ++i) phase_one[i] = 1.0;
    minimise(phase_one);
    return minimise(costs_);
  }

 private:
  Column multipliers(const std::vector<double>& costs) const {
    Column result{};
    for (int row = 0; row < 4; ++row)
      for (int k = 0; k < 4; ++k) result[k] += costs[basis_[row]] * inverse_[row][k];
    return result;
  }

  /// Bland's rule: the lowest column that improves, so no cycling among the many ties of regular solids.
  Column minimise(const std::vector<double>& costs) {
    for (std::size_t steps = 0; steps < 100 * columns_.size() + 1000; ++steps) {
      const Column y = multipliers(costs);
      std::size_t enters = real_columns_;
      for (std::size_t j = 0; j < real_columns_ && enters == real_columns_; ++j) {
        double reduced = costs[j];
        for (int k = 0; k < 4; ++k) reduced -= y[k] * columns_[j][k];
        if (reduced < -kReducedCostTolerance * (1.0 + std::abs(costs[j]))) enters = j;
      }
      if (enters == real_columns_ || !pivot(enters)) return y;
    }
    return multipliers(costs);
  }

  bool pivot(std::size_t enters) {
    Column direction{};
    for (int row = 0; row < 4; ++row)
      for (int k = 0; k < 4; ++k) direction[row] += inverse_[row][k] * columns_[enters][k];
    int leaves = -1;
    for (int row = 0; row < 4; ++row) {
      const bool artificial = basis_[row] >= real_columns_;
      // An artificial column left over at zero must go as soon as a pivot touches it, in either direction.
      const bool usable =
          direction[row] > kPivotTolerance ||
          (artificial && values_[row] <= kPivotTolerance && std::abs(direction[row]) > kPivotTolerance);
      if (!usable) continue;
      if (leaves < 0 || ratio(row, direction) < ratio(leaves, direction) ||
          (ratio(row, direction) == ratio(leaves, direction) && basis_[row] < basis_[leaves]))
        leaves = row;
    }
    if (leaves < 0) return false;
    const double by = direction[leaves];
    for (int k = 0; k < 4; ++k) inverse_[leaves][k] /= by;
    values_[leaves] /= by;
    for (int row = 0; row < 4; ++row) {
      if (row == leaves) continue;
      for (int k = 0; k < 4; ++k) inverse_[row][k] -= direction[row] * inverse_[leaves][k];
      values_[row] -= direction[row] * values_[leaves];
    }
    basis_[leaves] = enters;
    return true;
  }

  double ratio(int row, const Column& direction) const {
    return direction[row] > 0 ? values_[row] / direction[row] : 0.0;
  }

  std::vector<Column> columns_;
  std::vector<double> costs_;
  std::size_t real_columns_ = 0;
  std::array<Column, 4> inverse_{};
  std::array<std::size_t, 4> basis_{};
  Column values_{};
};

}  // namespace

Ball chebyshev_ball(const PlaneSet& planes) {
  DENDRO_CHECK(!planes.empty());
  double unit = 0;
  for (const HalfSpace& plane : planes) unit = std::max(unit, std::abs(plane.offset));
  if (unit == 0) return {};
  const Column y = DualSimplexTableau(planes, unit).solve();
  Ball ball{glm::dvec3(y[0], y[1], y[2]) * unit, INFINITY};
  for (const HalfSpace& plane : planes)
    ball.radius = std::min(ball.radius, plane.offset - glm::dot(plane.normal, ball.centre));
  if (ball.radius < 1e-9 * unit) ball.radius = std::min(ball.radius, 0.0);
  return ball;
}

}  // namespace dendro::scene
