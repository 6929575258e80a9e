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

void draw_spheres(HostPort& host, lib::IgcDriver& driver, const Prepared& prepared) {
  if (prepared.sphere_set_up.empty()) return;
  SphereSender sender(driver, prepared.layout);
  sender.load_squares(prepared.rules.width, prepared.rules.height);
  for (const SphereSetup& sphere : prepared.sphere_set_up) {
    host.compute(flops(flops_of(sphere)));
    sender.send(sphere);
  }
}

void draw_shadows(HostPort& host, lib::IgcDriver& driver, const Prepared& prepared) {
  if (!prepared.layout.shadows) return;
  driver.run("clear_shadow");
  for (const ShadowSetup& shadow : prepared.shadows) {
    host.compute(flops(kFlopsShadow));
    send(driver, shadow);
  }
  driver.run("darken", prepared.farthest);
}

}  // namespace

std::map<std::string, unsigned> register_values(const Layout& layout) {
  std::map<std::string, unsigned> values = {
      {"depth_bits", layout.depth_bits}, {"depth", layout.depth}, {"flag", layout.flag}, {"colour", layout.colour}};
  if (layout.shadows) values["shadow"] = layout.seen;
  if (!layout.has_spheres()) return values;
  values.insert({{"square", layout.square},
                 {"square_bits", layout.square_bits},
                 {"square_top", layout.square + layout.square_bits - 1},
                 {"seen", layout.seen}});
  return values;
}

void run(HostPort& host, const Prepared& prepared, const lib::IgcPrograms& programs) {
  lib::IgcDriver driver(host, programs);
  host.phase("load_program");
  driver.load();
  host.phase("set_up");
  driver.show(prepared.layout.colour, prepared.width, prepared.height);
  for (const auto& [name, value] : register_values(prepared.layout))
    if (programs.registers.count(name) != 0) driver.set_register(name, value);
  driver.run("clear_picture", clear_constant(prepared));
  // The work on corners, of triangles that are not drawn as well, is spread evenly over those that are.
  const std::uint64_t count = std::max<std::size_t>(1, prepared.set_up.size());
  std::uint64_t done = 0, number = 0;
  for (const TriangleSetup& triangle : prepared.set_up) {
    const std::uint64_t due = prepared.vertex_flops * ++number / count;
    host.compute(flops(due - done + kFlopsTriangle));
    done = due;
    send(driver, triangle);
  }
  draw_spheres(host, driver, prepared);
  draw_shadows(host, driver, prepared);
  host.phase("finish");
  driver.wait();
}

}  // namespace dendro::raster_primitives
