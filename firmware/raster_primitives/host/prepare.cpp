#include "firmware/raster_primitives/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "firmware/raster_primitives/host/patches.h"
#include "firmware/raster_primitives/host/shade.h"
#include "sim/base/error.h"
#include "sim/scene/mesh.h"
#include "sim/scene/view.h"

namespace dendro::raster_primitives {
namespace {

/// A sphere of the scene: world space, metres.
struct Ball {
  glm::dvec3 centre{};
  double radius = 1;
  std::vector<double> colour;
};

/// The paraboloid's factor is a sum of few digits, which can be this much too large.
constexpr double kBulge = 1.25;

/// An object's triangles in world space with a normal at each corner.
struct Shape {
  std::vector<glm::dvec3> corners, normals;  ///< by vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

bool has_ending(const std::string& path, const std::string& ending) {
  return path.size() >= ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

/// Vertices in the same place become one, so that normals are means over all faces around it.
Shape smooth(const scene::Mesh& mesh, const scene::Placement& place) {
  Shape shape;
  std::map<std::tuple<double, double, double>, std::uint32_t> numbers;
  std::vector<std::uint32_t> number_of;
  for (const glm::dvec3& v : mesh.vertices) {
    const auto next = static_cast<std::uint32_t>(shape.corners.size());
    const auto [at, fresh] = numbers.emplace(std::tuple(v.x, v.y, v.z), next);
    if (fresh) shape.corners.push_back(place(v));
    number_of.push_back(at->second);
  }
  shape.normals.resize(shape.corners.size());
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> n = {number_of[t[0]], number_of[t[1]], number_of[t[2]]};
    if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) continue;
    const glm::dvec3 normal =
        glm::cross(shape.corners[n[1]] - shape.corners[n[0]], shape.corners[n[2]] - shape.corners[n[0]]);
    for (const std::uint32_t k : n) shape.normals[k] += normal;
    shape.triangles.push_back(n);
  }
  for (glm::dvec3& normal : shape.normals)
    if (const double length = glm::length(normal); length > 0) normal /= length;
  return shape;
}

/// Pixels that spheres may reach over: the array's, or the picture's on a machine that draws in tiles.
int largest_side(const scene::Scene& scene, const ArraySite& site) {
  const int array = std::max(site.width, site.height);
  return site.draws_tiles() ? std::max({2 * array, scene.image.width, scene.image.height}) : array;
}

class Preparation {
 public:
  Preparation(const scene::Scene& scene, const ArraySite& site)
      : scene_(scene), options_(scene.options), site_(site), shader_(scene) {
    p_.layout = choose_layout(scene, site);
    lib::check_picture_fits(scene.image, site);
    p_.width = scene.image.width, p_.height = scene.image.height;
    p_.rules = {site.width, site.height, p_.layout.depth_bits,
                static_cast<unsigned>(options_.integer("fraction_bits", 10, 6, 14)), 2};
    options_.integer("depth_bits", 16, 12, 24);
    steps_ = static_cast<int>(options_.integer("patch_steps", 8, 1, 64));
    cull_ = options_.boolean("cull", true);
    p_.background = to_bytes(options_.vector("background", {0, 0, 0}, 0, 1));
    colours_ = options_.vectors("colours", 3);
    if (colours_.size() > scene.objects.size())
      options_.fail("colours", fmt::format("{} colours for {} objects", colours_.size(), scene.objects.size()));
    for (const std::vector<double>& colour : colours_) check_colour("colours", colour);
    digits_ = static_cast<int>(options_.integer("sphere_digits", 2, 1, 6));
    read_spheres();
    shadows_ = options_.choice("shadows", "none", {"none", "facing", "all"});
    const std::string kind = options_.choice("texture", "checker", {"checker", "wood"});
    const auto seed = static_cast<std::uint64_t>(options_.integer("texture_seed", 1, 0, INT32_MAX));
    p_.mappings = read_mappings(options_, scene.objects.size());
    if (read_texture_bits(options_) > 0) p_.texture = make_texture(kind, p_.layout.texture_bits, seed);
    options_.finish();
    if (scene.objects.empty() && balls_.empty())
      throw UserError(scene_.file, 0, "object", "the scene has no object and no sphere");
  }

  Prepared prepare() {
    for (std::size_t k = 0; k < scene_.objects.size(); ++k) shapes_.push_back(load(scene_.objects[k]));
    std::sort(p_.files.begin(), p_.files.end());
    p_.files.erase(std::unique(p_.files.begin(), p_.files.end()), p_.files.end());
    map_depth();
    const scene::Affine view = scene::parallel_view(scene_.camera, scene_.image);
    p_.light = -(view.linear * shader_.to_light());
    p_.light.z *= p_.depth_scale;
    for (std::size_t k = 0; k < shapes_.size(); ++k) project(k);
    for (const Ball& ball : balls_) project(ball);
    for (const ScreenSphere& sphere : p_.spheres)
      p_.sphere_set_up.push_back(dendro::raster_primitives::set_up(sphere, digits_, p_.rules));
    for (const ScreenTriangle& triangle : p_.triangles) {
      const auto made = set_up(triangle, triangle.corners);
      p_.without_area += !made;
      if (!made) continue;
      p_.flat += made->flat;
      p_.set_up.push_back(*made);
    }
    add_tiles();
    return std::move(p_);
  }

 private:
  std::optional<TriangleSetup> set_up(const ScreenTriangle& triangle, const std::array<ScreenVertex, 3>& corners) const {
    auto made = dendro::raster_primitives::set_up(corners, p_.rules);
    if (made && p_.is_textured(triangle)) made->texel = set_up_texture(corners, p_.rules);
    return made;
  }

  void add_tiles() {
    for (const lib::Tile& tile : lib::tiles_of(p_.width, p_.height, site_)) {
      TileDrawing drawing;
      drawing.tile = tile;
      if (site_.draws_tiles()) {
        fill(drawing);
      } else {
        drawing.triangles = p_.set_up, drawing.spheres = p_.sphere_set_up, drawing.shadows = p_.shadows;
      }
      for (const TriangleSetup& triangle : drawing.triangles) drawing.texels = drawing.texels || triangle.texel;
      p_.tiles.push_back(std::move(drawing));
    }
  }

  /// A pixel more on all sides: corners are moved to the grid.
  bool meets(const lib::Tile& tile, double left, double top, double right, double bottom) const {
    return tile.meets(left - 1, top - 1, right + 1, bottom + 1, site_);
  }

  void fill(TileDrawing& drawing) const {
    const lib::Tile& tile = drawing.tile;
    for (const ScreenTriangle& triangle : p_.triangles) {
      const auto& [a, b, c] = triangle.corners;
      const auto [left, right] = std::minmax({a.x, b.x, c.x});
      const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
      if (!meets(tile, left, top, right, bottom)) continue;
      check_reach(triangle, std::max({tile.x0 - left, tile.y0 - top, right - tile.x0, bottom - tile.y0}));
      std::array<ScreenVertex, 3> corners = triangle.corners;
      for (ScreenVertex& corner : corners) corner.x -= tile.x0, corner.y -= tile.y0;
      if (const auto made = set_up(triangle, corners)) drawing.triangles.push_back(*made);
    }
    for (ScreenSphere sphere : p_.spheres) {
      if (!meets(tile, sphere.x - sphere.radius, sphere.y - sphere.radius, sphere.x + sphere.radius, sphere.y + sphere.radius))
        continue;
      sphere.x -= tile.x0, sphere.y -= tile.y0;
      drawing.spheres.push_back(dendro::raster_primitives::set_up(sphere, digits_, p_.rules));
    }
    for (std::array<glm::dvec3, 3> caster : p_.casters) {
      if (!shadow_meets(tile, caster)) continue;
      for (glm::dvec3& corner : caster) corner.x -= tile.x0, corner.y -= tile.y0;
      if (const auto shadow = set_up_shadow(caster, p_.light, p_.rules)) drawing.shadows.push_back(*shadow);
    }
  }

  /// The caster and where the light carries its corners until nothing lies farther.
  bool shadow_meets(const lib::Tile& tile, const std::array<glm::dvec3, 3>& caster) const {
    if (!(p_.light.z > 0)) return true;
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (const glm::dvec3& corner : caster) {
      const double way = std::max(0.0, (p_.farthest - corner.z) / p_.light.z);
      for (const double t : {0.0, way}) {
        const double x = corner.x + t * p_.light.x, y = corner.y + t * p_.light.y;
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
      }
    }
    return meets(tile, left, top, right, bottom);
  }

  static std::array<double, 3> to_bytes(const std::vector<double>& colour) {
    return {std::round(255 * colour[0]), std::round(255 * colour[1]), std::round(255 * colour[2])};
  }

  void check_colour(const char* key, const std::vector<double>& colour) const {
    for (const double part : colour)
      if (!(part >= 0 && part <= 1)) options_.fail(key, "a colour's parts are 0..1");
  }

  void read_spheres() {
    for (const std::vector<double>& row : options_.vectors("spheres", 7)) {
      if (!(row[3] > 0)) options_.fail("spheres", "a sphere is [x, y, z, radius, red, green, blue] with a radius above 0");
      balls_.push_back({{row[0], row[1], row[2]}, row[3], {row[4], row[5], row[6]}});
      check_colour("spheres", balls_.back().colour);
    }
  }

  Shape load(const scene::Object& object) {
    if (object.mesh.empty())
      throw UserError(object.source_where.file, object.source_where.line, "object",
                      "raster_primitives draws meshes: give mesh");
    const scene::Mesh mesh = has_ending(object.mesh, ".patches")
                                 ? load_patches(object.mesh, steps_, object.source_where, "object.mesh")
                                 : scene::load_mesh(object.mesh, object.source_where, "object.mesh");
    p_.files.insert(p_.files.end(), mesh.files.begin(), mesh.files.end());
    return smooth(mesh, scene::Placement(object));
  }

  /// Everything that is given lies in the range, margins kept at both ends.
  void map_depth() {
    const scene::Affine view = scene::parallel_view(scene_.camera, scene_.image);
    double nearest = INFINITY, farthest = -INFINITY;
    for (const Shape& shape : shapes_)
      for (const glm::dvec3& corner : shape.corners) {
        const double depth = view(corner).z;
        nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
      }
    double most_radius = 0;
    for (const Ball& ball : balls_) {
      const double depth = view(ball.centre).z;
      nearest = std::min(nearest, depth - kBulge * ball.radius), farthest = std::max(farthest, depth);
      most_radius = std::max(most_radius, ball.radius);
    }
    // What a sphere adds to a depth for a while must not leave the range either.
    const double headroom = kBulge * most_radius;
    const double margin = depth_margin(p_.rules);
    const std::uint32_t most = (1u << p_.layout.depth_bits) - 1;
    const double range = std::max(farthest - nearest, 1e-9);
    p_.depth_scale = (most - 3 * margin) / (range + headroom);
    p_.farthest = balls_.empty() ? most : static_cast<std::uint32_t>(p_.depth_scale * range + 2 * margin);
    p_.depth_shift = margin - p_.depth_scale * nearest;
  }

  void project(std::size_t number) {
    const Shape& shape = shapes_[number];
    const scene::Affine view = scene::parallel_view(scene_.camera, scene_.image);
    std::vector<double> colour = {0.85, 0.8, 0.7};
    if (number < colours_.size()) colour = colours_[number];
    std::vector<ScreenVertex> vertices;
    for (std::size_t k = 0; k < shape.corners.size(); ++k) {
      const glm::dvec3 s = view(shape.corners[k]);
      vertices.push_back({s.x, s.y, p_.depth_scale * s.z + p_.depth_shift, shader_(shape.normals[k], colour)});
    }
    if (const auto at = p_.mappings.find(number); at != p_.mappings.end()) map(shape, at->second, vertices);
    p_.vertex_flops += shape.corners.size() * (kFlopsTransformVertex + kFlopsRotateNormal + kFlopsShadeVertex);
    p_.vertex_flops += shape.triangles.size() * kFlopsFacing;
    p_.given += shape.triangles.size();
    for (const auto& t : shape.triangles) {
      add({{vertices[t[0]], vertices[t[1]], vertices[t[2]]}, number});
      if (shadows_ == "none") continue;
      const glm::dvec3 normal = glm::cross(shape.corners[t[1]] - shape.corners[t[0]], shape.corners[t[2]] - shape.corners[t[0]]);
      if (shadows_ == "all" || glm::dot(normal, shader_.to_light()) > 0) cast({&vertices[t[0]], &vertices[t[1]], &vertices[t[2]]});
    }
  }

  void map(const Shape& shape, const Mapping& mapping, std::vector<ScreenVertex>& vertices) {
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const glm::dvec2 at = mapping(shape.corners[k]) * static_cast<double>(p_.texture.side());
      if (!(std::abs(at.x) <= kFarthestTexel && std::abs(at.y) <= kFarthestTexel))
        options_.fail("textured", fmt::format("a corner lies farther than {:g} texels from the origin", kFarthestTexel));
      vertices[k].u = at.x, vertices[k].v = at.y;
    }
    p_.vertex_flops += vertices.size() * kFlopsMapVertex;
  }

  void cast(const std::array<const ScreenVertex*, 3>& corners) {
    std::array<glm::dvec3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = {corners[k]->x, corners[k]->y, corners[k]->depth};
    const auto shadow = set_up_shadow(at, p_.light, p_.rules);
    if (!shadow) return;
    p_.shadows.push_back(*shadow);
    p_.casters.push_back(at);
  }

  void project(const Ball& ball) {
    ++p_.spheres_given;
    const scene::Affine view = scene::parallel_view(scene_.camera, scene_.image);
    const scene::CameraAxes axes(scene_.camera);
    const glm::dvec3 s = view(ball.centre), light = shader_.to_light();
    ScreenSphere sphere;
    sphere.x = s.x, sphere.y = s.y, sphere.depth = p_.depth_scale * s.z + p_.depth_shift;
    sphere.radius = ball.radius * scene_.image.height / scene_.camera.height;
    sphere.depth_radius = ball.radius * p_.depth_scale;
    sphere.light = {glm::dot(light, axes.right), -glm::dot(light, axes.up), -glm::dot(light, axes.forward)};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [level, swing] = shader_.level_and_swing(ball.colour[c]);
      sphere.level[c] = level, sphere.swing[c] = swing;
    }
    if (s.x + sphere.radius < -0.5 || s.y + sphere.radius < -0.5 || s.x - sphere.radius > p_.width - 0.5 ||
        s.y - sphere.radius > p_.height - 0.5)
      return;
    const double side = largest_side(scene_, site_);
    if (sphere.radius > side || std::min(s.x, s.y) < -side / 2 || std::max(s.x, s.y) > 1.5 * side)
      options_.fail("spheres", fmt::format("sphere {} is too large for the numbers in a pixel, or its centre too far outside",
                                           p_.spheres_given));
    p_.spheres.push_back(sphere);
  }

  void add(const ScreenTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    // Counter-clockwise seen from outside; rows go down.
    const bool away = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) >= 0;
    if (cull_ && away) {
      ++p_.facing_away;
      return;
    }
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
    if (right < -0.5 || bottom < -0.5 || left > p_.width - 0.5 || top > p_.height - 0.5) {
      ++p_.outside;
      return;
    }
    check_reach(triangle, std::max({-left, -top, right, bottom}));
    p_.triangles.push_back(triangle);
  }

  void check_reach(const ScreenTriangle& triangle, double reach) const {
    const double most = farthest_corner(p_.rules);
    if (reach <= most) return;
    const scene::Object& object = scene_.objects[triangle.object];
    throw UserError(object.source_where.file, object.source_where.line, "object.mesh",
                    fmt::format("a triangle that is in the picture reaches beyond {:g} pixels from its corner, where its "
                                "edges are not exact: cut it into smaller ones",
                                most));
  }

  const scene::Scene& scene_;
  scene::Options options_;
  ArraySite site_;
  Shader shader_;
  int steps_ = 8;
  bool cull_ = true;
  int digits_ = 2;
  std::string shadows_;
  std::vector<Ball> balls_;
  std::vector<std::vector<double>> colours_;
  std::vector<Shape> shapes_;
  Prepared p_;
};

}  // namespace

Layout choose_layout(const scene::Scene& scene, const ArraySite& site) {
  scene::Options options = scene.options;
  Layout layout(static_cast<unsigned>(options.integer("depth_bits", 16, 12, 24)));
  if (!options.vectors("spheres", 7).empty()) layout.square_bits = square_bits_for(largest_side(scene, site), 1);
  layout.shadows = options.choice("shadows", "none", {"none", "facing", "all"}) != "none";
  if (const unsigned bits = read_texture_bits(options); bits > 0) layout.place_texture(bits);
  if (layout.used() > static_cast<unsigned>(site.memory_bits))
    options.fail(layout.texture_bits > 0 ? "texture_size" : "depth_bits", fmt::format("the picture takes {} bits of a pixel; its memory has {}", layout.used(),
                                           site.memory_bits));
  return layout;
}

Prepared prepare(const scene::Scene& scene, const ArraySite& site) { return Preparation(scene, site).prepare(); }

}  // namespace dendro::raster_primitives
