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

}  // namespace

std::map<std::string, unsigned> register_values(const Layout& layout) {
  return {{"depth_bits", layout.depth_bits}, {"depth", layout.depth}, {"flag", layout.flag}, {"colour", layout.colour}};
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
  host.phase("finish");
  driver.wait();
}

}  // namespace dendro::raster_primitives
