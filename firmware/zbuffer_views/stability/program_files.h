#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/zbuffer_views/sgi_4d35/format.h"

/// The files of the programs, made and read by hand, apart from what the host does for its runs.
namespace dendro::zbuffer_views {

using Vertex = std::array<float, 3>;

struct TreeFile {
  std::vector<zbv_colour> colours = {{kZbvLeaf, 0x40A030, 1, 0}, {kZbvLeaf, 0xB0C0A0, 0, 0}};
  std::vector<Vertex> vertices;
  std::vector<zbv_triangle> triangles;
  Vertex centre = {0, 0, 0};

  void add(const Vertex& a, const Vertex& b, const Vertex& c, std::uint32_t colour);
  /// With the digest that `facts.head.digest` of its jobs and views must have.
  std::string bytes() const;
  std::array<std::uint32_t, kZbvDigestWords> digest() const;
};

/// Trunk and leaves at random, about 3 high and 2 wide around the origin.
TreeFile random_tree(std::uint32_t seed, int leaves);

struct JobFile {
  zbv_job facts = {};
  std::vector<zbv_placement> trees = {{{0, 0, 0}, 0}};
  std::vector<zbv_frame> frames;

  /// 3 bands, 2 layers of 60 x 80; one picture of 48 x 64 in parallel projection along -z, light from above.
  explicit JobFile(const TreeFile& tree);
  std::string bytes() const;
};

/// A camera at `eye` that looks at `target`, y up.
zbv_frame look(const std::array<double, 3>& eye, const std::array<double, 3>& target,
               const std::array<double, 3>& light);

struct ViewsFile {
  zbv_views facts = {};
  std::vector<zbv_colour> colours;
  std::vector<zbv_view> views;
  struct Layer {
    std::vector<float> z;
    std::vector<std::uint8_t> latitude, longitude, colour;
  };
  std::vector<std::vector<Layer>> layers;  ///< of each view

  static ViewsFile parse(const std::string& bytes);
  std::string bytes() const;
  void make_empty();  ///< every sample
};

struct Pictures {
  zbv_pictures facts = {};
  struct Picture {
    zbv_picture facts = {};
    std::vector<float> depth;
    std::vector<std::uint8_t> red, green, blue, colour;
  };
  std::vector<Picture> pictures;

  static Pictures parse(const std::string& bytes);
};

}  // namespace dendro::zbuffer_views
