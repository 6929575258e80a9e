#include "firmware/zbuffer_views/host/fir.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "firmware/zbuffer_views/host/wood.h"
#include "sim/base/random.h"

namespace dendro::zbuffer_views {
namespace {

using base::uniform;

constexpr int kDeepestOrder = 3, kBetweenWhorls = 3, kFirstBranches = 3;
/// Radius of a shoot of one year, and its growth a year; the leader's is thicker. ASSUMED DEV-160
constexpr double kTwigRadius = 0.0015, kTwigYear = 0.0011, kLeaderYear = 0.0034;

/// One year's growth of one axis.
struct Shoot {
  glm::dvec3 from{}, to{};
  int years = 0;  ///< old; 0: this year's
  double radius = 0;
  bool upright = false;
};

class Fir {
 public:
  explicit Fir(const FirParameters& parameters) : p_(parameters) {}

  TreeModel grow() {
    std::mt19937_64 random(p_.seed);
    grow_leader(random);
    double metres = 0;
    for (const Shoot& shoot : shoots_) metres += glm::length(shoot.to - shoot.from);
    double density = p_.needles_per_metre;
    if (p_.triangles > 0)
      density = std::max(0.0, (p_.triangles - static_cast<double>(tree_.triangles.size())) / metres);
    for (const Shoot& shoot : shoots_) add_needles(shoot, density, random);
    return std::move(tree_);
  }

 private:
  double leader_increment(int year) const {
    return leader_growth(p_.increment, p_.establishment, year);
  }

  void grow_leader(std::mt19937_64& random) {
    std::vector<WoodNode> nodes = {{{0, 0, 0}, radius_of(p_.age, kLeaderYear)}};
    double azimuth = uniform(random, 0, 2 * kPi);
    glm::dvec3 at{};
    for (int year = 1; year <= p_.age; ++year) {
      const double length = leader_increment(year) * uniform(random, 0.88, 1.12);
      const glm::dvec3 from = at;
      at += bent(kUp, uniform(random, 0, 2) * kDegree, uniform(random, 0, 2 * kPi)) * length;
      const int old = p_.age - year;
      nodes.push_back({at, radius_of(old, kLeaderYear)});
      keep_shoot({from, at, old, radius_of(old, kLeaderYear), true});
      if (old == 0) break;
      if (year < kFirstBranches) continue;
      const int count = p_.whorl + static_cast<int>(std::floor(uniform(random, -1, 2)));
      for (int i = 0; i < count; ++i) {
        azimuth += 2 * kPi / count;
        start_branch(at, azimuth + uniform(random, -0.2, 0.2), year, p_.whorl_share * uniform(random, 0.85, 1.15), random());
      }
      azimuth += kGoldenAngle;
      // Firs also have weaker branches between the whorls.
      for (int i = 0; i < kBetweenWhorls; ++i)
        start_branch(from + (at - from) * uniform(random, 0.25, 0.9), azimuth + kGoldenAngle * i, year,
                     p_.whorl_share * uniform(random, 0.3, 0.6), random());
    }
    add_wood(tree_, nodes, 8, Part::kTrunk);
  }

  static double radius_of(int years, double yearly) { return kTwigRadius + yearly * years; }

  void start_branch(const glm::dvec3& at, double azimuth, int year, double share, std::uint64_t key) {
    const double sagged = p_.sag * (1 - std::exp(-(p_.age - year) / 6.0));
    const double inclination = (p_.insertion + sagged) * kDegree;
    const glm::dvec3 out(std::cos(azimuth), 0, std::sin(azimuth));
    grow_axis(1, at, glm::normalize(kUp * std::cos(inclination) + out * std::sin(inclination)), year, share, key);
  }

  /// A branch or side shoot that buds at the end of `year`; side shoots lie in the plane of their branch.
  void grow_axis(int order, glm::dvec3 at, glm::dvec3 heading, int year, double share, std::uint64_t key) {
    std::mt19937_64 random(key);
    const double yearly = kTwigYear / order;
    std::vector<WoodNode> nodes = {{at, radius_of(p_.age - year, yearly)}};
    for (int now = year + 1; now <= p_.age; ++now) {
      const double length = leader_increment(now) * share * uniform(random, 0.85, 1.15);
      if (length < p_.shortest_shoot) break;
      share *= p_.vigour;
      const glm::dvec3 from = at;
      heading = glm::normalize(heading + kUp * uniform(random, 0.0, 0.05));
      at += heading * length;
      const int old = p_.age - now;
      nodes.push_back({at, radius_of(old, yearly)});
      keep_shoot({from, at, old, radius_of(old, yearly), false});
      if (old == 0 || order == kDeepestOrder) continue;
      const glm::dvec3 side = glm::normalize(glm::cross(heading, kUp));
      for (const double hand : {-1.0, 1.0}) {
        const double angle = p_.fork * uniform(random, 0.85, 1.15) * kDegree;
        const glm::dvec3 out = heading * std::cos(angle) + side * (hand * std::sin(angle)) + kUp * uniform(random, -0.12, 0.06);
        grow_axis(order + 1, at, glm::normalize(out), now, share * p_.fork_share * uniform(random, 0.8, 1.1), random());
      }
    }
    if (nodes.size() < 2) return;
    // Twigs are hidden by their needles: one thin spike is enough.
    if (order >= 2) nodes = {nodes.front(), nodes.back()};
    add_wood(tree_, nodes, order == 1 ? 5 : 3, Part::kBranch);
  }

  void keep_shoot(const Shoot& shoot) {
    if (shoot.years < p_.needle_years) shoots_.push_back(shoot);
  }

  /// Needles stand around an upright shoot and are combed to the sides and up on others.
  void add_needles(const Shoot& shoot, double density, std::mt19937_64& random) {
    const glm::dvec3 along = shoot.to - shoot.from;
    const double length = glm::length(along), expected = length * density;
    const glm::dvec3 heading = along / length;
    const glm::dvec3 side = shoot.upright ? Across(heading).a : glm::normalize(glm::cross(heading, kUp));
    const glm::dvec3 over = glm::cross(side, heading);
    const auto count = static_cast<int>(expected + uniform(random, 0, 1));
    for (int i = 0; i < count; ++i) {
      double around = uniform(random, 0, 2 * kPi);
      if (!shoot.upright && std::sin(around) < -0.35) around = -around;
      const glm::dvec3 out = side * std::cos(around) + over * std::sin(around);
      const double lean = uniform(random, 45, 70) * kDegree;
      const glm::dvec3 direction = heading * std::cos(lean) + out * std::sin(lean);
      const glm::dvec3 foot = shoot.from + along * ((i + uniform(random, 0, 1)) / count) + out * shoot.radius;
      const glm::dvec3 across = glm::normalize(glm::cross(direction, out)) * (p_.needle_width / 2);
      const double reach = p_.needle_length * uniform(random, 0.75, 1.15);
      const std::uint32_t a = tree_.add_vertex(foot - across), b = tree_.add_vertex(foot + across);
      const std::uint32_t tip = tree_.add_vertex(foot + direction * reach);
      // The top side is the one away from the shoot.
      tree_.add_triangle(b, a, tip, Part::kLeaf);
    }
  }

  const FirParameters p_;
  TreeModel tree_;
  std::vector<Shoot> shoots_;
};

}  // namespace

TreeModel grow_fir(const FirParameters& parameters) { return Fir(parameters).grow(); }

}  // namespace dendro::zbuffer_views
