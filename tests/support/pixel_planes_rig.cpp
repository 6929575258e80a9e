#include "tests/support/pixel_planes_rig.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace dendro::pixel_planes {
namespace {

std::int64_t uniform(std::mt19937_64& random, std::int64_t low, std::int64_t high) {
  return std::uniform_int_distribution<std::int64_t>(low, high)(random);
}

}  // namespace

std::string shipped_source(const std::string& name) {
  std::ifstream file(std::string(IGC_SOURCES) + "/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

Spec small_spec(int side, int ports, int memory_bits) {
  Spec spec;
  spec.array.width = spec.array.height = side;
  spec.array.ports = ports, spec.array.memory_bits = memory_bits;
  return spec;
}

Programs::Programs(int ports) {
  const char* const names[] = {"half_space.igc", "two_ports.igc"};
  for (int k = 0; k < ports; ++k) {
    const tools::IgcImage image = tools::assemble_igc(shipped_source(names[k]), names[k], {ports, 256, {}});
    for (const auto& [name, program] : image.programs) {
      entries_[name] = program;
      entries_[name].entry += static_cast<unsigned>(words_.size());
    }
    words_.insert(words_.end(), image.words.begin(), image.words.end());
    registers_.insert(image.registers.begin(), image.registers.end());
  }
}

igc::ControllerState Programs::controller(const Layout& layout) const {
  igc::ControllerState state;
  std::copy(words_.begin(), words_.end(), state.store.begin());
  for (const auto& [name, value] : layout.registers())
    if (registers_.count(name) != 0) state.registers[registers_.at(name)] = static_cast<std::uint8_t>(value);
  return state;
}

Step step(const Programs& programs, const std::string& program, std::uint64_t constant) {
  Step out{program, {}};
  out.command.header.entry = programs.entry(program);
  out.command.constant = constant;
  return out;
}

Step step(const Programs& programs, const std::string& program, std::int64_t a, std::int64_t b, std::int64_t c,
          unsigned fraction, unsigned guard, std::uint64_t constant) {
  Step out = step(programs, program, constant);
  out.command.header.expression = true;
  out.command.header.fraction = fraction, out.command.header.guard = guard;
  out.command.a = a, out.command.b = b, out.command.c = c;
  return out;
}

unsigned guard_of(std::int64_t a, std::int64_t b, std::int64_t c, int side, unsigned fraction, unsigned bits) {
  const std::int64_t x = a * (side - 1), y = b * (side - 1);
  const std::int64_t low = c + std::min<std::int64_t>(0, x) + std::min<std::int64_t>(0, y);
  const std::int64_t high = c + std::max<std::int64_t>(0, x) + std::max<std::int64_t>(0, y);
  unsigned guard = 1;
  while (low < -(std::int64_t{1} << (fraction + bits + guard - 1)) || high >= std::int64_t{1} << (fraction + bits + guard - 1))
    ++guard;
  return guard;
}

std::vector<Step> random_stream(std::mt19937_64& random, const Programs& programs, const Layout& layout, int side,
                                int hulls) {
  constexpr unsigned kFraction = 6;
  const bool scratch = layout.scratch;
  const std::int64_t range = std::int64_t{1} << (layout.bits + kFraction);
  std::vector<Step> steps{step(programs, "clear_picture", static_cast<std::uint64_t>(uniform(random, 0, 0xFFFFFF)))};
  for (int h = 0; h < hulls; ++h) {
    steps.push_back(step(programs, "clear_hull"));
    std::vector<Step> fronts;
    const std::int64_t middle_x = uniform(random, 0, side - 1), middle_y = uniform(random, 0, side - 1);
    const std::int64_t depth = uniform(random, range / 8, 7 * range / 8);
    const int planes = static_cast<int>(uniform(random, 1, 9));
    for (int p = 0; p < planes; ++p) {
      const std::int64_t slope = range / (std::int64_t{1} << uniform(random, 0, 12));
      const std::int64_t a = uniform(random, -slope, slope), b = uniform(random, -slope, slope);
      const bool front = uniform(random, 0, 1) == 1;
      // A multiple of 16 or one less: the corner of a tile.
      const bool corner = uniform(random, 0, 2) == 0;
      const std::int64_t x = corner ? middle_x / 16 * 16 - uniform(random, 0, 1) : middle_x;
      const std::int64_t y = corner ? middle_y / 16 * 16 - uniform(random, 0, 1) : middle_y;
      const std::int64_t off = corner ? 0 : uniform(random, 0, range / 16);
      const std::int64_t c = depth - a * x - b * y + (front ? -off : off);
      unsigned guard = guard_of(a, b, c, side, kFraction, layout.bits);
      if (uniform(random, 0, 7) == 0) guard = std::max(1u, guard - 1);  // too short somewhere: values wrap
      const std::string name = std::string(front ? "front_plane" : "back_plane") + (scratch ? "_scratch" : "");
      steps.push_back(step(programs, name, a, b, c, kFraction, guard));
      if (front) {
        fronts.push_back(steps.back());
        fronts.back().command.header.entry = programs.entry("recolour");
        fronts.back().program = "recolour";
        fronts.back().command.constant = static_cast<std::uint64_t>(uniform(random, 0, 0xFFFFFF));
      }
    }
    if (uniform(random, 0, 1) == 1) {
      const std::int64_t a = uniform(random, -64, 64), b = uniform(random, -64, 64);
      const std::int64_t c = -a * middle_x - b * middle_y + uniform(random, 0, 300);
      steps.push_back(step(programs, "edge_on_plane", a, b, c, kFraction, guard_of(a, b, c, side, kFraction, 0)));
    }
    if (uniform(random, 0, 2) == 0) steps.push_back(step(programs, "close_open"));
    steps.push_back(step(programs, "finish"));
    if (uniform(random, 0, 2) == 0)
      steps.push_back(step(programs, "paint", static_cast<std::uint64_t>(uniform(random, 0, 0xFFFFFF))));
    steps.insert(steps.end(), fronts.begin(), fronts.end());
  }
  return steps;
}

}  // namespace dendro::pixel_planes
