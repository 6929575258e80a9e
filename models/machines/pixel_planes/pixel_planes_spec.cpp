#include "models/machines/pixel_planes/pixel_planes_spec.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "models/parts/igc/igc_isa.h"

namespace dendro::pixel_planes {
namespace {

std::int64_t ps(double value, double picoseconds_per_unit) { return std::llround(value * picoseconds_per_unit); }

int log2_of(int value) {
  int log = 0;
  while (1 << log < value) ++log;
  return log;
}

int side(config::ParameterReader& reader, const char* key) {
  const auto value = static_cast<int>(reader.integer(key, 64, 1024));
  if ((value & (value - 1)) != 0) reader.impossible(key, "must be a power of two");
  return value;
}

std::int64_t interval(config::ParameterReader& reader, const char* key, std::int64_t tick_ps) {
  const std::int64_t value = ps(reader.real(key, 0, 1e9), 1e3);
  if (value > 0 && value < 4 * tick_ps)
    reader.impossible(key, "must be 0 (none) or at least 4 clocks: the array would stand still");
  return value;
}

/// A machine that draws pictures larger than its arrays has these.
void read_renderers(config::ParameterReader& reader, Spec& spec) {
  spec.renderers.count = static_cast<int>(reader.integer("renderers.count", 1, 64));
  spec.renderers.copy_clocks = static_cast<int>(reader.integer("renderers.copy_clocks", 0, 1 << 24));
  spec.frame.width = static_cast<int>(reader.integer("frame_buffer.width", 1, 4096));
  spec.frame.height = static_cast<int>(reader.integer("frame_buffer.height", 1, 4096));
  for (const auto& [key, side, tile] : {std::tuple("frame_buffer.width", spec.frame.width, spec.array.width),
                                        {"frame_buffer.height", spec.frame.height, spec.array.height}})
    if (side % tile != 0) reader.impossible(key, "must be whole tiles, " + std::to_string(tile) + " pixels each");
}

}  // namespace

int Spec::levels_x() const { return log2_of(array.width); }
int Spec::levels_y() const { return log2_of(array.height); }
int Spec::least_gap() const { return std::max(levels_x(), levels_y()) - 1; }

Spec resolve(const config::ParameterSet& parameters) {
  config::ParameterReader reader(parameters);
  Spec spec;
  spec.tick_ps = ps(1.0 / reader.real("array.clock_mhz", 0.1, 1000), 1e6);
  spec.array.width = side(reader, "array.width");
  spec.array.height = side(reader, "array.height");
  spec.array.memory_bits = static_cast<int>(reader.integer("array.memory_bits", 8, igc::kMostMemoryBits));
  spec.array.ports = static_cast<int>(reader.integer("array.ports", 1, 2));
  spec.refresh_interval_ps = interval(reader, "array.refresh_interval_ns", spec.tick_ps);
  spec.video_interval_ps = interval(reader, "array.video_interval_ns", spec.tick_ps);
  spec.tree.masked = reader.boolean("tree.masked");
  spec.tree.gap_clocks = static_cast<int>(reader.integer("tree.gap_clocks", 0, 63));
  spec.setup_clocks = static_cast<int>(reader.integer("translator.setup_clocks", 0, 1000));
  spec.fifo_words = static_cast<int>(reader.integer("fifo.depth_words", 8, 1 << 20));
  spec.host.word_ps = ps(reader.real("host.word_ns", 0.1, 1e9), 1e3);
  spec.host.flop_ps = ps(1.0 / reader.real("host.flops_m_s", 1e-3, 1e6), 1e6);
  spec.host.instruction_ps = ps(1.0 / reader.real("host.instructions_m_s", 1e-3, 1e6), 1e6);
  spec.host.program_load_ps = ps(reader.real("host.program_load_ms", 0, 1e6), 1e9);
  spec.host.interrupt_ps = ps(reader.real("host.interrupt_us", 0, 1e9), 1e6);
  if (parameters.find("renderers.count")) read_renderers(reader, spec);
  reader.finish();
  return spec;
}

}  // namespace dendro::pixel_planes
