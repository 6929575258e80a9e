#include "sim/scene/mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <sstream>

#include "sim/base/error.h"
#include "sim/scene/mesh_files.h"

namespace dendro::scene {
namespace {

namespace fs = std::filesystem;

std::string without_gz(const std::string& path) {
  const fs::path p(path);
  return p.extension() == ".gz" ? (p.parent_path() / p.stem()).string() : path;
}

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string first_line(std::string text) {
  const std::size_t end = text.find_first_of("\r\n");
  if (end != std::string::npos) text.resize(end);
  return text;
}

// What the headers of two formats promise, against what is there: the reader would look for the rest for minutes, or
// blame something else.
void check_promised_size(const std::string& path, const std::string& extension, const std::string& bytes) {
  if (extension == ".ply") {
    std::istringstream header(bytes.substr(0, bytes.find("end_header")));
    double elements = 0;
    for (std::string word; header >> word;) {
      double count = 0;
      if (word == "element" && header >> word >> count) elements += count;
    }
    if (elements > static_cast<double>(bytes.size()))
      throw UserError(path, 0, {}, fmt::format("is truncated: its header promises {:.0f} elements", elements));
  }
  if (extension == ".stl" && bytes.size() >= 84 && bytes.compare(0, 5, "solid") != 0) {
    std::uint64_t triangles = 0;
    for (int i = 3; i >= 0; --i) triangles = triangles << 8 | static_cast<unsigned char>(bytes[80 + i]);
    if (84 + 50 * triangles > bytes.size())
      throw UserError(path, 0, {}, fmt::format("is truncated: its header promises {} triangles", triangles));
  }
}

void append_mesh(const aiMesh& part, const aiMatrix4x4& placed, const std::string& node, Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D p = placed * part.mVertices[v];
    mesh.vertices.emplace_back(p.x, p.y, p.z);
  }
  MeshGroup group{part.mName.length != 0 ? part.mName.C_Str() : node, mesh.triangles.size(), 0};
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines have no area
    mesh.triangles.push_back({base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]});
  }
  group.count = mesh.triangles.size() - group.first;
  if (group.count != 0) mesh.groups.push_back(std::move(group));
}

void append_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, Mesh& mesh) {
  const aiMatrix4x4 placed = above * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m)
    append_mesh(*scene.mMeshes[node.mMeshes[m]], placed, node.mName.C_Str(), mesh);
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_node(scene, *node.mChildren[c], placed, mesh);
}

bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const glm::dvec3 a = mesh.vertices[t[0]];
  const glm::dvec3 normal = glm::cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
  return normal.x != 0 || normal.y != 0 || normal.z != 0;
}

void check_mesh(const std::string& path, const Mesh& mesh) {
  const auto finite = [](const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  const auto bad = std::find_if_not(mesh.vertices.begin(), mesh.vertices.end(), finite);
  if (bad != mesh.vertices.end())
    throw UserError(path, 0, {},
                    fmt::format("vertex {} is not finite ({}, {}, {})", bad - mesh.vertices.begin() + 1,
                                bad->x, bad->y, bad->z));
  if (mesh.triangles.empty()) throw UserError(path, 0, {}, "has no faces");
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(),
                   [&](const auto& t) { return has_area(mesh, t); }))
    throw UserError(path, 0, {}, "all faces have zero area");
}

}  // namespace

Mesh load_mesh(const std::string& path, const Where& where, const std::string& key) {
  const std::string plain = without_gz(path);
  const std::string extension = lower_extension(plain);
  const std::vector<std::string> known{".obj", ".ply", ".stl", ".gltf", ".glb"};
  if (std::find(known.begin(), known.end(), extension) == known.end())
    throw UserError(where.file, where.line, key,
                    fmt::format("{} is not .obj, .ply, .stl, .gltf or .glb, plain or .gz", path));

  std::string bytes = read_bytes(path);
  check_promised_size(path, extension, bytes);
  auto files = std::make_unique<MeshFiles>(plain, std::move(bytes));
  const MeshFiles& opened = *files;
  Assimp::Importer importer;
  importer.SetIOHandler(files.release());
  // Without this an OBJ's lines and points would come back as degenerate faces of their own meshes.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(plain, aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = first_line(importer.GetErrorString());
    throw UserError(path, 0, {}, "is not a readable mesh" + (reason.empty() ? "" : ": " + reason));
  }

  Mesh mesh;
  append_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  mesh.files.push_back(fs::absolute(path).lexically_normal().string());
  for (const std::string& other : opened.others())
    mesh.files.push_back(fs::absolute(other).lexically_normal().string());
  std::sort(mesh.files.begin(), mesh.files.end());
  check_mesh(path, mesh);
  return mesh;
}

}  // namespace dendro::scene
