#include "firmware/raster_primitives/host/host_program.h"

#include <algorithm>
#include <cmath>

namespace dendro::raster_primitives {
namespace {

std::uint64_t clear_constant(const Prepared& prepared) {
  std::uint64_t bits = static_cast<std::uint64_t>(prepared.farthest) << 24;
  for (std::size_t c = 0; c < 3; ++c) bits |= static_cast<std::uint64_t>(std::lround(prepared.background[c])) << (8 * c);
  return bits;
}

Work flops(std::uint64_t count) {
  Work work;
  work.flops = count;
  return work;
}

/// One tile, piece by piece: triangles, spheres, texels, shadows.
class TileRun {
 public:
  TileRun(HostPort& host, lib::IgcDriver& driver, const Prepared& prepared, const TileDrawing& drawing, bool tiled)
      : host_(host), driver_(driver), prepared_(prepared), drawing_(drawing), tiled_(tiled), spheres_(driver, prepared.layout) {}

  /// Shadows begin with a piece that clears their bit.
  lib::TileWork work() const {
    lib::TileWork work;
    work.pieces = drawing_.triangles.size() + drawing_.spheres.size() + texels();
    work.weight = 7 * drawing_.triangles.size() + 16 * drawing_.spheres.size() + 5 * drawing_.shadows.size() + texels();
    if (prepared_.layout.shadows) work.pieces += 1 + drawing_.shadows.size();
    return work;
  }

  void begin() {
    driver_.run("clear_picture", clear_constant(prepared_));
    if (prepared_.layout.texture_bits > 0) driver_.run("clear_texture");
  }

  void send(std::size_t k) {
    if (k < drawing_.triangles.size()) return triangle(k);
    k -= drawing_.triangles.size();
    if (k < drawing_.spheres.size()) return sphere(k);
    k -= drawing_.spheres.size();
    if (k < texels()) return texel(k);
    k -= texels();
    if (k == 0) driver_.run("clear_shadow");
    if (k > 0) shadow(k - 1);
    if (k == drawing_.shadows.size()) driver_.run("darken", prepared_.farthest);
  }

 private:
  /// The work on corners, of triangles that are not drawn as well, is spread evenly over those that are.
  void triangle(std::size_t k) {
    const std::uint64_t due = prepared_.vertex_flops * (k + 1) / drawing_.triangles.size();
    const TriangleSetup& triangle = drawing_.triangles[k];
    host_.compute(flops(tiled_ ? tile_flops_of(triangle) : due - done_ + flops_of(triangle)));
    done_ = due;
    dendro::raster_primitives::send(driver_, triangle);
    if (!triangle.texel) plain();
  }
  /// Hides the texture where the primitive before is seen.
  void plain() {
    if (prepared_.layout.texture_bits > 0) driver_.run("plain");
  }
  std::size_t texels() const { return drawing_.texels ? prepared_.texture.rgb.size() : 0; }
  void texel(std::size_t k) {
    Work work;
    work.instructions = kInstructionsTexel;
    host_.compute(work);
    send_texel(driver_, prepared_.texture, k);
  }
  void sphere(std::size_t k) {
    if (k == 0) spheres_.load_squares(prepared_.rules.width, prepared_.rules.height);
    host_.compute(flops(tiled_ ? kFlopsTileSphere : flops_of(drawing_.spheres[k])));
    spheres_.send(drawing_.spheres[k]);
    plain();
  }
  void shadow(std::size_t k) {
    host_.compute(flops(tiled_ ? kFlopsTileShadow : kFlopsShadow));
    dendro::raster_primitives::send(driver_, drawing_.shadows[k]);
  }

  HostPort& host_;
  lib::IgcDriver& driver_;
  const Prepared& prepared_;
  const TileDrawing& drawing_;
  bool tiled_;
  SphereSender spheres_;
  std::uint64_t done_ = 0;
};

/// Set-ups once a picture, and the sorting into tiles.
void bin(HostPort& host, const Prepared& prepared) {
  host.phase("bin");
  Work work;
  work.flops = prepared.vertex_flops +
               prepared.shadows.size() * (kFlopsShadow - std::min(kFlopsShadow, kFlopsTileShadow));
  for (const TriangleSetup& triangle : prepared.set_up) work.flops += flops_of(triangle) - tile_flops_of(triangle);
  for (const SphereSetup& sphere : prepared.sphere_set_up) work.flops += flops_of(sphere);
  std::size_t entries = 0;
  for (const TileDrawing& drawing : prepared.tiles)
    entries += drawing.triangles.size() + drawing.spheres.size() + drawing.shadows.size();
  const std::size_t all = prepared.set_up.size() + prepared.spheres.size() + prepared.shadows.size();
  work.instructions = all * lib::kInstructionsBin + entries * lib::kInstructionsBinTile;
  host.compute(work);
  host.phase("set_up");
}

}  // namespace

std::map<std::string, unsigned> register_values(const Layout& layout) {
  std::map<std::string, unsigned> values = {
      {"depth_bits", layout.depth_bits}, {"depth", layout.depth}, {"flag", layout.flag}, {"colour", layout.colour}};
  if (layout.shadows) values["shadow"] = layout.seen;
  if (layout.texture_bits > 0)
    values.insert({{"texel", layout.texel}, {"texel_v", layout.texel_v()}, {"texture_bits", layout.texture_bits}});
  if (!layout.has_spheres()) return values;
  values.insert({{"square", layout.square},
                 {"square_bits", layout.square_bits},
                 {"square_top", layout.square + layout.square_bits - 1},
                 {"seen", layout.seen}});
  return values;
}

void run(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site) {
  lib::IgcDriver driver(host, programs);
  host.phase("load_program");
  driver.load();
  host.phase("set_up");
  driver.show(prepared.layout.colour, prepared.width, prepared.height);
  for (const auto& [name, value] : register_values(prepared.layout))
    if (programs.registers.count(name) != 0) driver.set_register(name, value);
  if (site.draws_tiles()) bin(host, prepared);
  std::vector<TileRun> runs;
  std::vector<lib::Tile> tiles;
  std::vector<lib::TileWork> work;
  for (const TileDrawing& drawing : prepared.tiles) {
    runs.emplace_back(host, driver, prepared, drawing, site.draws_tiles());
    tiles.push_back(drawing.tile), work.push_back(runs.back().work());
  }
  lib::serve(driver, site, tiles, work, [&](std::size_t tile) { runs[tile].begin(); },
             [&](std::size_t tile, std::size_t k) { runs[tile].send(k); });
  host.phase("finish");
  driver.wait();
}

}  // namespace dendro::raster_primitives
