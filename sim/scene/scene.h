#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/scene/options.h"

namespace dendro::scene {

using Vector3 = std::array<double, 3>;

/// Size of the picture in pixels.
struct Image {
  int width = 512;
  int height = 512;
  Where where;
};

/// World space is right-handed, metres, y up.
struct Camera {
  enum class Projection { kParallel, kPerspective };
  Projection projection = Projection::kParallel;
  double height = 0;  ///< parallel: world height of the picture, metres, > 0
  double fov_y = 0;   ///< perspective: full vertical angle, degrees, in (0, 180)
  Vector3 position{0, 0, 1};
  Vector3 target{0, 0, 0};
  Vector3 up{0, 1, 0};
  Where where;
};

/// A light at infinity.
struct Light {
  Vector3 direction{0, -1, 0};  ///< the way the light travels, in world space; any length but zero
  double ambient = 0.3;         ///< share of the shade that does not depend on the normal, 0..1
  Where where;
};

/// n·p <= offset, the normal pointing out; any length but zero.
struct PlaneEntry {
  Vector3 normal{0, 0, 1};
  double offset = 0;
};

/// One object; exactly one of `mesh`, `solid`, `planes`, `tree` is given. A point p of the mesh lands at
/// at + R·(scale · unit · U·p), with U turning `up_axis` to y and R = Ry·Rx·Rz of `rotate`.
struct Object {
  std::string mesh;                ///< path, resolved against the scene file
  std::string solid;               ///< a built-in solid: see solid_names()
  std::vector<PlaneEntry> planes;  ///< an explicit list of half-spaces
  std::string tree;                ///< a grown tree: its kind
  std::map<std::string, OptionValue> tree_parameters;
  std::map<std::string, OptionValue> trunk_parameters;  ///< of any object: the keys that begin with `trunk`
  Vector3 at{0, 0, 0};
  Vector3 rotate{0, 0, 0};                    ///< degrees about x, y, z
  double scale = 1.0;                         ///< > 0
  std::string units = "m";                    ///< m, cm, mm, in, ft
  std::string up_axis = "y";                  ///< x, y or z
  std::map<std::string, std::string> groups;  ///< meaning -> pattern of group names
  Where where;                                ///< of the object
  Where source_where;                         ///< of its mesh, solid, planes or tree key
};

/// A picture to be drawn: what the scene file says, checked for form but not for what the algorithm can do.
struct Scene {
  std::string name;       ///< file name without folder and ending
  std::string file;       ///< path of the scene file, as it appears in error messages
  std::string algorithm;  ///< "half_space"
  std::string machine;    ///< "rds3000:fg86"
  std::uint64_t seed = 1;
  Image image;
  Camera camera;
  std::vector<Light> lights;
  std::vector<Object> objects;
  Options options;  ///< the table named like the algorithm
};

/// Names of the built-in solids, for error messages and checks.
const std::vector<std::string>& solid_names();

}  // namespace dendro::scene
