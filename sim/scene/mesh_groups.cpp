#include "sim/scene/mesh_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>

#include "sim/base/error.h"

namespace dendro::scene {

std::vector<bool> triangles_in_groups(const Mesh& mesh, const Object& object, const std::string& meaning) {
  const std::string& pattern = object.groups.at(meaning);
  std::vector<bool> wanted(mesh.triangles.size(), false);
  for (const MeshGroup& group : mesh.groups)
    if (::fnmatch(pattern.c_str(), group.name.c_str(), 0) == 0)
      std::fill_n(wanted.begin() + static_cast<std::ptrdiff_t>(group.first), group.count, true);
  if (std::find(wanted.begin(), wanted.end(), true) != wanted.end()) return wanted;
  std::vector<std::string> names;
  for (const MeshGroup& group : mesh.groups) names.push_back(group.name);
  throw UserError(object.source_where.file, object.source_where.line, "object.groups",
                  fmt::format("{}: no group is named like {} = \"{}\"; there are {}", object.mesh, meaning, pattern,
                              names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace dendro::scene
