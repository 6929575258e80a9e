#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <map>
#include <queue>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "sim/scene/hull.h"
#include "sim/scene/plane_set.h"

namespace dendro::scene {
namespace {

/// Below this number of planes every replacement is tested for boundedness.
constexpr std::size_t kTestBounded = 256;

/// A connected set of hull facets that one plane stands for.
struct Cluster {
  glm::dvec3 area{};     ///< sum of the facets' area times normal
  glm::dmat3 moment{0};  ///< sum of area times normal times centroid transposed
  HalfSpace plane;
  double volume = 0;  ///< between the facets and the plane, seen along the plane's normal
  std::set<std::size_t> neighbours;
  bool alive = true;
};

/// One possible replacement; stale when a cluster has died since.
struct Candidate {
  double added = 0;
  std::size_t first = 0, second = 0;
  bool operator>(const Candidate& other) const {
    return std::tie(added, first, second) > std::tie(other.added, other.first, other.second);
  }
};

class Merger {
 public:
  Merger(const std::vector<glm::dvec3>& points, const Hull& hull) {
    for (const std::uint32_t v : hull.vertices) corners_.push_back(points[v]);
    for (const HullFacet& facet : hull.facets) {
      Cluster cluster;
      cluster.area = facet.normal * facet.area;
      cluster.moment = glm::outerProduct(cluster.area, facet.centroid);
      cluster.plane = {facet.normal, facet.offset};
      cluster.neighbours.insert(facet.neighbours.begin(), facet.neighbours.end());
      clusters_.push_back(std::move(cluster));
    }
    alive_ = clusters_.size();
    for (std::size_t i = 0; i < clusters_.size(); ++i)
      for (const std::size_t j : clusters_[i].neighbours)
        if (i < j) propose(i, j);
  }

  PlaneSet reduce(std::size_t count) {
    while (alive_ > count) {
      if (candidates_.empty())
        throw std::invalid_argument("cannot be bounded by " + std::to_string(count) +
                                    " merged planes; the fewest is " + std::to_string(alive_));
      const Candidate best = candidates_.top();
      candidates_.pop();
      if (!clusters_[best.first].alive || !clusters_[best.second].alive) continue;
      replace(best);
    }
    return planes();
  }

 private:
  PlaneSet planes() const {
    PlaneSet result;
    for (const Cluster& cluster : clusters_)
      if (cluster.alive) result.push_back(cluster.plane);
    return result;
  }

  /// The union of two clusters; false when their planes do not face the same way.
  bool unite(const Cluster& a, const Cluster& b, Cluster& united) const {
    united.area = a.area + b.area;
    united.moment = a.moment + b.moment;
    const double length = glm::length(united.area);
    if (!(length > 0)) return false;
    const glm::dvec3 normal = united.area / length;
    if (glm::dot(normal, a.plane.normal) <= 0 || glm::dot(normal, b.plane.normal) <= 0) return false;
    double offset = -INFINITY;
    for (const glm::dvec3& corner : corners_) offset = std::max(offset, glm::dot(normal, corner));
    united.plane = {normal, offset};
    united.volume = offset * length - glm::dot(normal, united.moment * normal);
    return true;
  }

  void propose(std::size_t i, std::size_t j) {
    Cluster united;
    if (unite(clusters_[i], clusters_[j], united))
      candidates_.push(
          {united.volume - clusters_[i].volume - clusters_[j].volume, std::min(i, j), std::max(i, j)});
  }

  void replace(const Candidate& pair) {
    Cluster& a = clusters_[pair.first];
    Cluster& b = clusters_[pair.second];
    Cluster united;
    if (!unite(a, b, united)) return;
    a.alive = b.alive = false;
    if (alive_ <= kTestBounded) {
      PlaneSet rest = planes();
      rest.push_back(united.plane);
      if (!is_bounded(rest)) {
        a.alive = b.alive = true;
        return;
      }
    }
    const std::size_t index = clusters_.size();
    std::set_union(a.neighbours.begin(), a.neighbours.end(), b.neighbours.begin(), b.neighbours.end(),
                   std::inserter(united.neighbours, united.neighbours.end()));
    united.neighbours.erase(pair.first);
    united.neighbours.erase(pair.second);
    clusters_.push_back(std::move(united));
    --alive_;
    for (const std::size_t n : clusters_[index].neighbours) {
      clusters_[n].neighbours.erase(pair.first);
      clusters_[n].neighbours.erase(pair.second);
      clusters_[n].neighbours.insert(index);
      propose(index, n);
    }
  }

  std::vector<glm::dvec3> corners_;
  std::vector<Cluster> clusters_;
  std::size_t alive_ = 0;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

}  // namespace

PlaneSet hull_planes(const std::vector<glm::dvec3>& points, std::size_t count) {
  const std::optional<Hull> hull = convex_hull(points);
  if (!hull) throw std::invalid_argument("spans no volume, so it has no hull");
  if (count > hull->facets.size())
    throw std::invalid_argument(std::to_string(count) + " planes are wanted but the hull has only " +
                                std::to_string(hull->facets.size()) + " facets");
  Merger merger(points, *hull);
  return merger.reduce(count == 0 ? hull->facets.size() : count);
}

}  // namespace dendro::scene
