#include "firmware/raster_primitives/host/patches.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

#include "sim/base/error.h"

namespace dendro::raster_primitives {
namespace {

constexpr std::size_t kMostPatches = 10000, kMostPoints = 100000;

/// Lines of numbers with commas between them.
class Reader {
 public:
  Reader(std::istream& in, const std::string& path) : in_(in), path_(path) {}

  std::vector<double> line(std::size_t count, const char* what) {
    std::string text;
    ++number_;
    if (!std::getline(in_, text)) fail(fmt::format("the file ends where {} should stand", what));
    std::vector<double> values;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
      std::size_t used = 0;
      double value = NAN;
      try {
        value = std::stod(part, &used);
      } catch (const std::exception&) {
      }
      if (!std::isfinite(value) || part.find_first_not_of(" \t\r", used) != std::string::npos)
        fail(fmt::format("\"{}\" is no finite number", part));
      values.push_back(value);
    }
    if (values.size() != count) fail(fmt::format("{} {} make {}, not {}", count, count == 1 ? "number" : "numbers", what, values.size()));
    return values;
  }

  std::size_t whole(double value, std::size_t lowest, std::size_t highest, const char* what) {
    if (value != std::floor(value) || value < static_cast<double>(lowest) || value > static_cast<double>(highest))
      fail(fmt::format("{} must be a whole number in {}..{}", what, lowest, highest));
    return static_cast<std::size_t>(value);
  }

  [[noreturn]] void fail(const std::string& message) const { throw UserError(path_, number_, {}, message); }

 private:
  std::istream& in_;
  const std::string& path_;
  int number_ = 0;
};

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

void add_triangle(scene::Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& v = mesh.vertices;
  const glm::dvec3 normal = glm::cross(v[b] - v[a], v[c] - v[a]);
  const double side = glm::length(v[b] - v[a]) + glm::length(v[c] - v[a]);
  if (glm::length(normal) > 1e-12 * side * side) mesh.triangles.push_back({a, b, c});
}

}  // namespace

scene::Mesh load_patches(const std::string& path, int steps, const scene::Where& where, const std::string& key) {
  std::ifstream in(path);
  if (!in) throw UserError(where.file, where.line, key, fmt::format("cannot read {}", path));
  Reader reader(in, path);
  const std::size_t count = reader.whole(reader.line(1, "the number of patches")[0], 1, kMostPatches, "the number of patches");
  std::vector<std::vector<double>> patches;
  for (std::size_t p = 0; p < count; ++p) {
    patches.push_back(reader.line(16, "a patch"));
    for (const double number : patches.back()) reader.whole(number, 1, kMostPoints, "a point's number");
  }
  const std::size_t points = reader.whole(reader.line(1, "the number of points")[0], 1, kMostPoints, "the number of points");
  std::vector<glm::dvec3> control;
  for (std::size_t k = 0; k < points; ++k) {
    const std::vector<double> p = reader.line(3, "a point");
    control.emplace_back(p[0], p[1], p[2]);
  }
  scene::Mesh mesh;
  mesh.files = {std::filesystem::absolute(path).lexically_normal().string()};
  for (const std::vector<double>& patch : patches) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto side = static_cast<std::uint32_t>(steps + 1);
    for (std::uint32_t j = 0; j < side; ++j)
      for (std::uint32_t i = 0; i < side; ++i) {
        const auto u = bernstein(static_cast<double>(i) / steps), v = bernstein(static_cast<double>(j) / steps);
        glm::dvec3 sum{};
        for (std::size_t k = 0; k < 16; ++k) {
          const auto number = static_cast<std::size_t>(patch[k]);
          if (number > control.size()) reader.fail(fmt::format("a patch names point {} of {}", number, control.size()));
          sum += v[k / 4] * u[k % 4] * control[number - 1];
        }
        mesh.vertices.push_back(sum);
      }
    for (std::uint32_t j = 0; j + 1 < side; ++j)
      for (std::uint32_t i = 0; i + 1 < side; ++i) {
        const std::uint32_t a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
        add_triangle(mesh, a, b, d);
        add_triangle(mesh, a, d, c);
      }
  }
  if (mesh.triangles.empty()) throw UserError(path, 0, {}, "has no triangle of non-zero area");
  mesh.groups = {{"patches", 0, mesh.triangles.size()}};
  return mesh;
}

}  // namespace dendro::raster_primitives
