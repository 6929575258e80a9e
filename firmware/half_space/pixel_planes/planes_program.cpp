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
    driver_.run("clear_picture", bits_of(prepared_.background));
  }

  void draw(const StreamHull& hull) {
    const bool index = prepared_.layout.colouring == Colouring::kIndex;
    driver_.run(index ? "clear_hull_index" : "clear_hull");
    std::uint64_t number = 0;
    for (const StreamPlane& plane : hull.planes) {
      set_up_plane();
      if (plane.kind == PlaneKind::kFront && index)
        stream("front_plane_index", plane, number++);
      else
        stream(program_of(plane.kind), plane, std::nullopt);
    }
    if (!hull.bounded) driver_.run("close_open");
    driver_.run("finish");
    if (hull.before_screen && !index) driver_.run("paint", bits_of(hull.first_shade));
    index ? colour_by_index(hull) : colour_again(hull);
  }

  void wait() {
    host_.phase("finish");
    driver_.wait();
  }

 private:
  void set_up_plane() {
    Work work;
    work.flops = kFlopsStreamPlane;
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
  void colour_again(const StreamHull& hull) {
    for (auto plane = hull.planes.rbegin(); plane != hull.planes.rend(); ++plane)
      if (plane->kind == PlaneKind::kFront)
        stream("recolour", *plane, bits_of(prepared_.faces[static_cast<std::size_t>(plane->face)]));
  }

  void colour_by_index(const StreamHull& hull) {
    std::uint64_t number = 0;
    for (const StreamPlane& plane : hull.planes)
      if (plane.kind == PlaneKind::kFront)
        driver_.run("recolour_index",
                    number++ | bits_of(prepared_.faces[static_cast<std::size_t>(plane.face)]) << kIndexBits);
  }

  HostPort& host_;
  lib::IgcDriver driver_;
  const PreparedPlanes& prepared_;
  const lib::IgcPrograms& programs_;
};

}  // namespace

void run(HostPort& host, const PreparedPlanes& prepared, const lib::IgcPrograms& programs) {
  PlanesRun run(host, prepared, programs);
  run.load();
  for (const StreamHull& hull : prepared.hulls)
    if (hull.visible) run.draw(hull);
  run.wait();
}

}  // namespace dendro::half_space
