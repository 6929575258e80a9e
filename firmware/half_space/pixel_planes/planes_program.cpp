#include "firmware/half_space/pixel_planes/planes_program.h"

namespace dendro::half_space {
namespace {

constexpr unsigned kIndexBits = 12;

std::uint64_t bits_of(const Rgb& rgb) {
  return rgb[0] | static_cast<std::uint64_t>(rgb[1]) << 8 | static_cast<std::uint64_t>(rgb[2]) << 16;
}

class PlanesRun {
 public:
  PlanesRun(HostPort& host, const PreparedPlanes& prepared, const lib::IgcPrograms& programs)
      : host_(host), driver_(host, programs), prepared_(prepared), programs_(programs) {}

  void load() {
    host_.phase("load_program");
    driver_.load();
    if (prepared_.growth.flops > 0) {
      host_.phase("grow");
      host_.compute(prepared_.growth);
    }
    host_.phase("set_up");
    driver_.show(prepared_.layout.colour, prepared_.width, prepared_.height);
    for (const auto& [name, value] : prepared_.layout.registers())
      if (programs_.registers.count(name) != 0) driver_.set_register(name, value);
  }

  /// What is done once a picture is done before the tiles.
  void bin(const lib::ArraySite& site) {
    if (!site.draws_tiles()) return;
    host_.phase("bin");
    std::size_t entries = 0, planes = 0, hulls = 0;
    for (const TilePlanes& tile : prepared_.tiles) entries += tile.hulls.size();
    for (const StreamHull& hull : prepared_.hulls)
      if (hull.visible) planes += hull.planes.size(), ++hulls;
    Work work;
    work.flops = planes * (kFlopsStreamPlane - kFlopsTilePlane);
    work.instructions = hulls * lib::kInstructionsBin + entries * lib::kInstructionsBinTile;
    host_.compute(work);
    host_.phase("set_up");
  }

  void draw(const lib::ArraySite& site) {
    flops_of_plane_ = site.draws_tiles() ? kFlopsTilePlane : kFlopsStreamPlane;
    std::vector<lib::Tile> tiles;
    std::vector<lib::TileWork> work;
    for (const TilePlanes& tile : prepared_.tiles) {
      lib::TileWork one;
      one.pieces = tile.hulls.size();
      for (const auto& hull : tile.hulls) one.weight += hull.second.size() + 1;
      tiles.push_back(tile.tile), work.push_back(one);
    }
    lib::serve(driver_, site, tiles, work,
               [&](std::size_t) { driver_.run("clear_picture", bits_of(prepared_.background)); },
               [&](std::size_t tile, std::size_t k) {
                 const auto& [hull, planes] = prepared_.tiles[tile].hulls[k];
                 draw(prepared_.hulls[hull], planes);
               });
  }

  void draw(const StreamHull& hull, const std::vector<StreamPlane>& planes) {
    const bool index = prepared_.layout.colouring == Colouring::kIndex;
    driver_.run(index ? "clear_hull_index" : "clear_hull");
    std::uint64_t number = 0;
    for (const StreamPlane& plane : planes) {
      set_up_plane();
      if (plane.kind == PlaneKind::kFront && index)
        stream("front_plane_index", plane, number++);
      else
        stream(program_of(plane.kind), plane, std::nullopt);
    }
    if (!hull.bounded) driver_.run("close_open");
    driver_.run("finish");
    if (hull.before_screen && !index) driver_.run("paint", bits_of(hull.first_shade));
    index ? colour_by_index(planes) : colour_again(planes);
  }

  void wait() {
    host_.phase("finish");
    driver_.wait();
  }

 private:
  void set_up_plane() {
    Work work;
    work.flops = flops_of_plane_;
    host_.compute(work);
  }

  std::string program_of(PlaneKind kind) const {
    if (kind == PlaneKind::kEdgeOn) return "edge_on_plane";
    const std::string name = kind == PlaneKind::kFront ? "front_plane" : "back_plane";
    return prepared_.layout.variant == StreamVariant::kScratch ? name + "_scratch" : name;
  }

  void stream(const std::string& program, const StreamPlane& plane, std::optional<std::uint64_t> constant) {
    driver_.run(program, plane.expression, plane.fraction, plane.guard, constant);
  }

  /// From the last to the first: of planes that tie, the first one's colour stays.
  void colour_again(const std::vector<StreamPlane>& planes) {
    for (auto plane = planes.rbegin(); plane != planes.rend(); ++plane)
      if (plane->kind == PlaneKind::kFront)
        stream("recolour", *plane, bits_of(prepared_.faces[static_cast<std::size_t>(plane->face)]));
  }

  void colour_by_index(const std::vector<StreamPlane>& planes) {
    std::uint64_t number = 0;
    for (const StreamPlane& plane : planes)
      if (plane.kind == PlaneKind::kFront)
        driver_.run("recolour_index",
                    number++ | bits_of(prepared_.faces[static_cast<std::size_t>(plane.face)]) << kIndexBits);
  }

  HostPort& host_;
  lib::IgcDriver driver_;
  const PreparedPlanes& prepared_;
  const lib::IgcPrograms& programs_;
  std::uint64_t flops_of_plane_ = 0;
};

}  // namespace

void run(HostPort& host, const PreparedPlanes& prepared, const lib::IgcPrograms& programs, const lib::ArraySite& site) {
  PlanesRun run(host, prepared, programs);
  run.load();
  run.bin(site);
  run.draw(site);
  run.wait();
}

}  // namespace dendro::half_space
