#include "sim/scene/hull.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <unordered_map>

#include "sim/base/check.h"

namespace dendro::scene {
namespace {

/// A Qhull run over points it does not own; frees everything at the end.
class QhullRun {
 public:
  QhullRun(std::vector<double>& coordinates, int count) : null_(std::fopen("/dev/null", "w")) {
    DENDRO_CHECK(null_ != nullptr);
    qh_zero(&state_, null_);
    char command[] = "qhull";
    failed_ = qh_new_qhull(&state_, 3, count, coordinates.data(), False, command, nullptr, null_) != 0;
  }
  ~QhullRun() {
    qh_freeqhull(&state_, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&state_, &current, &total);
    std::fclose(null_);
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  bool failed() const { return failed_; }
  qhT* state() { return &state_; }

 private:
  FILE* null_;
  qhT state_{};
  bool failed_ = false;
};

void measure(const std::vector<glm::dvec3>& points, HullFacet& facet) {
  const glm::dvec3 origin = points[facet.corners[0]];
  glm::dvec3 weighted{};
  for (std::size_t i = 1; i + 1 < facet.corners.size(); ++i) {
    const glm::dvec3 b = points[facet.corners[i]] - origin;
    const glm::dvec3 c = points[facet.corners[i + 1]] - origin;
    const double area = 0.5 * glm::dot(glm::cross(b, c), facet.normal);
    facet.area += area;
    weighted += area / 3.0 * (b + c);
  }
  facet.centroid = facet.area > 0 ? origin + weighted / facet.area : origin;
}

}  // namespace

std::optional<Hull> convex_hull(const std::vector<glm::dvec3>& points) {
  if (points.size() < 4) return std::nullopt;
  std::vector<double> coordinates;
  coordinates.reserve(points.size() * 3);
  for (const glm::dvec3& p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  QhullRun run(coordinates, static_cast<int>(points.size()));
  if (run.failed()) return std::nullopt;

  qhT* qh = run.state();
  Hull hull;
  std::unordered_map<unsigned, std::uint32_t> index_of;
  facetT* facet = nullptr;
  vertexT* vertex = nullptr;
  FORALLfacets index_of.emplace(facet->id, static_cast<std::uint32_t>(index_of.size()));
  FORALLvertices hull.vertices.push_back(static_cast<std::uint32_t>(qh_pointid(qh, vertex->point)));
  std::sort(hull.vertices.begin(), hull.vertices.end());
  FORALLfacets {
    HullFacet out;
    out.normal = {facet->normal[0], facet->normal[1], facet->normal[2]};
    out.offset = -facet->offset;
    setT* corners = qh_facet3vertex(qh, facet);
    vertexT** vertexp = nullptr;
    FOREACHvertex_(corners) out.corners.push_back(static_cast<std::uint32_t>(qh_pointid(qh, vertex->point)));
    qh_settempfree(qh, &corners);
    facetT* neighbor = nullptr;
    facetT** neighborp = nullptr;
    FOREACHneighbor_(facet) out.neighbours.push_back(index_of.at(neighbor->id));
    measure(points, out);
    if (out.area < 0) {  // the order of the corners is Qhull's, not the orientation
      std::reverse(out.corners.begin(), out.corners.end());
      out.area = 0;
      measure(points, out);
    }
    hull.facets.push_back(std::move(out));
  }
  return hull;
}

}  // namespace dendro::scene
