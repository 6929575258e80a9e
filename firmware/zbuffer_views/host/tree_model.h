#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace dendro::zbuffer_views {

/// What a triangle belongs to [MO95 7]; a leaf has a colour on its top side and another one below.
enum class Part : std::uint8_t { kTrunk = 0, kBranch = 1, kLeaf = 2 };

/// The nearest number of single precision. By way of memory: GCC 12 at -O2 leaves the rounding of two neighbours out when it
/// vectorises them (std::vector<glm::dvec3> of floats).
inline double single(double value) {
  const volatile float narrow = static_cast<float>(value);
  return static_cast<double>(narrow);
}
inline glm::dvec3 single(const glm::dvec3& v) { return {single(v.x), single(v.y), single(v.z)}; }

/// A tree or any other thing of triangles, metres, y up, the trunk's foot at the origin. Coordinates are
/// numbers of single precision, so that a machine's floats hold the same tree.
struct TreeModel {
  std::vector<glm::dvec3> vertices;
  /// The cross product of (v1 - v0) and (v2 - v0) points to the top side of a leaf, out of wood [MO95 3].
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Part> parts;         ///< one a triangle
  std::vector<std::string> files;  ///< absolute paths of what was read, sorted

  std::uint32_t add_vertex(const glm::dvec3& p) {
    vertices.push_back(single(p));
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Part part) {
    triangles.push_back({a, b, c});
    parts.push_back(part);
  }
};

}  // namespace dendro::zbuffer_views
