#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "sim/scene/options.h"

namespace dendro::scene {

/// Triangles of one named part of a mesh file: [first, first + count).
struct MeshGroup {
  std::string name;
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Triangles in the file's own units and axes; every index is valid and every coordinate finite.
struct Mesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<MeshGroup> groups;
  std::vector<std::string> files;  ///< absolute paths of everything that was read, sorted
};

/// Reads OBJ, PLY, STL, glTF or GLB, plain or .gz; polygons become triangles, node transforms are applied.
/// Throws UserError naming the file for anything unreadable, truncated, of unknown type, with coordinates
/// that are not finite, without faces, or with no face of non-zero area. `where` and `key` say who asked for
/// the file.
Mesh load_mesh(const std::string& path, const Where& where = {}, const std::string& key = {});

}  // namespace dendro::scene
