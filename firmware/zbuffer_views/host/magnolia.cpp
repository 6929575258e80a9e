#include "firmware/zbuffer_views/host/magnolia.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "firmware/zbuffer_views/host/wood.h"
#include "sim/base/random.h"

namespace dendro::zbuffer_views {
namespace {

using base::uniform;

constexpr int kDeepestOrder = 3, kFirstBranches = 4;
/// Radius of this year's shoot, and its growth a year. ASSUMED DEV-161
constexpr double kTwigRadius = 0.004, kTwigYear = 0.0022, kLeaderYear = 0.0045;
constexpr double kPetioleRadius = 0.0025, kPetiole = 0.12;  ///< its length, share of the leaf's

struct Whorl {
  glm::dvec3 at{}, heading{};
  std::uint64_t key = 0;
};

class Magnolia {
 public:
  explicit Magnolia(const MagnoliaParameters& parameters) : p_(parameters) {}

  TreeModel grow() {
    grow_leader();
    double leaves = 0;
    for (const Whorl& whorl : whorls_) leaves += count_leaves(whorl);
    if (p_.triangles > 0) {
      const double each = (p_.triangles - static_cast<double>(tree_.triangles.size())) / leaves - 3;
      p_.leaf_rows = std::clamp(static_cast<int>(std::lround((each + 4) / 4)), 2, 200);
    }
    for (const Whorl& whorl : whorls_) add_whorl(whorl);
    return std::move(tree_);
  }

 private:
  double leader_increment(int year) const {
    return leader_growth(p_.increment, p_.establishment, year);
  }

  static double radius_of(int years, double yearly) { return kTwigRadius + yearly * years; }

  void grow_leader() {
    std::mt19937_64 random(p_.seed);
    std::vector<WoodNode> nodes = {{{0, 0, 0}, radius_of(p_.age, kLeaderYear)}};
    glm::dvec3 at{}, heading = kUp;
    double azimuth = uniform(random, 0, 2 * kPi);
    for (int year = 1; year <= p_.age; ++year) {
      heading = glm::normalize(bent(heading, uniform(random, 0, 6) * kDegree, uniform(random, 0, 2 * kPi)) + kUp);
      at += heading * (leader_increment(year) * uniform(random, 0.85, 1.15));
      const int old = p_.age - year;
      nodes.push_back({at, radius_of(old, kLeaderYear)});
      if (old == 0) break;
      if (year < kFirstBranches) continue;
      const int count = p_.whorl + static_cast<int>(std::floor(uniform(random, -1, 2)));
      azimuth += kGoldenAngle;
      for (int i = 0; i < count; ++i) {
        const glm::dvec3 out = bent(heading, p_.insertion * uniform(random, 0.9, 1.2) * kDegree,
                                    azimuth + 2 * kPi * i / count + uniform(random, -0.3, 0.3));
        grow_axis(1, at, out, year, p_.whorl_share * uniform(random, 0.75, 1.1), random());
      }
    }
    whorls_.push_back({at, heading, random()});
    add_wood(tree_, nodes, 8, Part::kTrunk);
  }

  /// A branch that buds at the end of `year`. Buds too weak to open end it, and low branches that stay behind
  /// die: a branch bears leaves only if it grew this year.
  void grow_axis(int order, glm::dvec3 at, glm::dvec3 heading, int year, double share, std::uint64_t key) {
    std::mt19937_64 random(key);
    std::vector<WoodNode> nodes = {{at, radius_of(p_.age - year, kTwigYear / order)}};
    double turn = uniform(random, 0, 2 * kPi);
    for (int now = year + 1; now <= p_.age; ++now) {
      const double length = leader_increment(now) * share * uniform(random, 0.8, 1.2);
      if (length < p_.shortest_shoot) break;
      share *= p_.vigour;
      heading = glm::normalize(bent(heading, uniform(random, 0, 10) * kDegree, uniform(random, 0, 2 * kPi)) + kUp * p_.rise);
      at += heading * length;
      const int old = p_.age - now;
      nodes.push_back({at, radius_of(old, kTwigYear / order)});
      if (old == 0 || order == kDeepestOrder || uniform(random, 0, 1) > p_.fork_chance) continue;
      turn += kGoldenAngle;
      const glm::dvec3 out = bent(heading, p_.insertion * uniform(random, 0.8, 1.1) * kDegree, turn);
      grow_axis(order + 1, at, out, now, share * p_.fork_share, random());
    }
    if (nodes.size() < 2) return;
    whorls_.push_back({at, heading, random()});
    add_wood(tree_, nodes, order == 1 ? 6 : 4, Part::kBranch);
  }

  int count_leaves(const Whorl& whorl) const {
    std::mt19937_64 random(whorl.key);
    return std::max(1, static_cast<int>(std::lround(p_.leaves * uniform(random, 0.75, 1.25))));
  }

  void add_whorl(const Whorl& whorl) {
    std::mt19937_64 random(whorl.key);
    const int count = count_leaves(whorl);
    random();  // the draw that counted the leaves
    const double start = uniform(random, 0, 2 * kPi);
    for (int i = 0; i < count; ++i) {
      const double azimuth = start + 2 * kPi * i / count + uniform(random, -0.15, 0.15);
      const glm::dvec3 out = bent(whorl.heading, uniform(random, 55, 85) * kDegree, azimuth);
      add_leaf(whorl.at - whorl.heading * uniform(random, 0, 0.05), out, uniform(random, 0.7, 1.15),
               uniform(random, 0.3, 1.0), random);
    }
  }

  /// Half the width of the blade at `along` (0 the foot, 1 the tip), share of the greatest: widest above the middle.
  static double outline(double along) {
    return std::pow(std::sin(kPi * std::pow(along, 1.35)), 0.8);
  }

  void add_leaf(const glm::dvec3& foot, const glm::dvec3& out, double size, double droop, std::mt19937_64& random) {
    const double length = p_.leaf_length * size, half = p_.leaf_width * size / 2;
    const glm::dvec3 level = glm::length(glm::cross(out, kUp)) > 1e-3 ? glm::normalize(glm::cross(out, kUp)) : Across(out).a;
    const glm::dvec3 side = bent(level, uniform(random, 0, 15) * kDegree, uniform(random, 0, 2 * kPi));
    glm::dvec3 at = foot + out * (kPetiole * length), heading = out;
    add_wood(tree_, {{foot, kPetioleRadius}, {at, kPetioleRadius}}, 3, Part::kBranch);
    // Three vertices a row: left edge, midrib, right edge; foot and tip are one.
    std::uint32_t left = tree_.add_vertex(at), mid = left, right = left;
    for (int row = 1; row <= p_.leaf_rows; ++row) {
      heading = glm::normalize(heading - kUp * (droop / p_.leaf_rows));
      at += heading * (length / p_.leaf_rows);
      const bool tip = row == p_.leaf_rows;
      const double width = half * outline(double(row) / p_.leaf_rows);
      const glm::dvec3 across = glm::normalize(side - heading * glm::dot(side, heading));
      const glm::dvec3 fold = glm::cross(across, heading) * (0.25 * width);
      const std::uint32_t next_mid = tree_.add_vertex(at);
      const std::uint32_t next_left = tip ? next_mid : tree_.add_vertex(at - across * width + fold);
      const std::uint32_t next_right = tip ? next_mid : tree_.add_vertex(at + across * width + fold);
      add_strip(mid, right, next_right, next_mid);
      add_strip(left, mid, next_mid, next_left);
      left = next_left, mid = next_mid, right = next_right;
    }
  }

  /// A quadrilateral seen from above, counter-clockwise; corners that coincide leave one triangle.
  void add_strip(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    if (a != b && b != c) tree_.add_triangle(a, b, c, Part::kLeaf);
    if (c != d && d != a) tree_.add_triangle(a, c, d, Part::kLeaf);
  }

  MagnoliaParameters p_;
  TreeModel tree_;
  std::vector<Whorl> whorls_;
};

}  // namespace

TreeModel grow_magnolia(const MagnoliaParameters& parameters) { return Magnolia(parameters).grow(); }

}  // namespace dendro::zbuffer_views
