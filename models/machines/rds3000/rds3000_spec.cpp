#include "models/machines/rds3000/rds3000_spec.h"

#include <cmath>

namespace dendro::rds3000 {
namespace {

std::int64_t ps(double value, double picoseconds_per_unit) { return std::llround(value * picoseconds_per_unit); }

int ticks(config::ParameterReader& reader, const char* key, int lowest, int highest) {
  return static_cast<int>(reader.integer(key, lowest, highest));
}

ProcessorSpec resolve_processor(config::ParameterReader& reader) {
  ProcessorSpec spec;
  spec.tick_ps = ps(reader.real("processor.tick_ns", 1, 1e6), 1e3);
  spec.multiply_ticks = ticks(reader, "processor.multiply_ticks", 1, 100);
  spec.taken_branch_ticks = ticks(reader, "processor.taken_branch_ticks", 0, 100);
  spec.scratch_ticks = ticks(reader, "processor.scratch_ticks", 1, 100);
  spec.accesses_in_flight = ticks(reader, "processor.accesses_in_flight", 0, 1);
  spec.steal_ticks = ticks(reader, "processor.steal_ticks", 0, 100);
  spec.scratch_words = static_cast<unsigned>(reader.integer("processor.scratch_words", 16, 8192));
  if ((spec.scratch_words & (spec.scratch_words - 1)) != 0)
    reader.impossible("processor.scratch_words", "must be a power of two");
  spec.control_store_words = static_cast<unsigned>(reader.integer("processor.control_store_words", 4096, 32768));
  if (spec.control_store_words % 4096 != 0)
    reader.impossible("processor.control_store_words", "must be a multiple of 4096, the page a 12-bit address reaches");
  return spec;
}

dr64::Spec resolve_memory(config::ParameterReader& reader) {
  dr64::Spec spec;
  const std::int64_t bits = reader.integer("frame_memory.bits_per_pixel", 24, 48);
  if (bits != 24 && bits != 32 && bits != 48)
    reader.impossible("frame_memory.bits_per_pixel", "must be 24, 32 or 48: whole DR64 cards of 8 bits");
  spec.banks = bits == 48 ? 2 : 1;
  spec.cards_per_bank = bits == 32 ? 4 : 3;
  spec.card_busy_ticks = ticks(reader, "frame_memory.card_busy_ticks", 1, 100);
  spec.read_ticks = ticks(reader, "frame_memory.read_ticks", 1, 100);
  spec.masked_write_extra_ticks = ticks(reader, "frame_memory.masked_write_extra_ticks", 0, 100);
  spec.fetch_bits = ticks(reader, "frame_memory.fetch_bits", 8, 1024);
  if (spec.fetch_bits % 8 != 0) reader.impossible("frame_memory.fetch_bits", "must be a multiple of 8");
  spec.fetch_ticks = ticks(reader, "frame_memory.fetch_ticks", 0, 100);
  spec.refresh_interval_ps = ps(reader.real("frame_memory.refresh_interval_ns", 0, 1e9), 1e3);
  return spec;
}

HostSpec resolve_host(config::ParameterReader& reader) {
  HostSpec spec;
  spec.word_ps = ps(4.0 / reader.real("host.interface_mb_s", 0.001, 1000), 1e6);
  spec.dma_start_ps = ps(reader.real("host.dma_start_ms", 0, 1e4), 1e9);
  spec.register_ps = ps(reader.real("host.register_access_us", 0, 1e6), 1e6);
  spec.program_load_ps = ps(reader.real("host.program_load_s", 0, 1e3), 1e12);
  spec.interrupt_ps = ps(reader.real("host.interrupt_ms", 0, 1e4), 1e9);
  spec.instruction_ps = ps(1.0 / reader.real("host.instructions_m_s", 1e-3, 1e5), 1e6);
  spec.flop_ps = ps(1.0 / reader.real("host.flops_m_s", 1e-3, 1e5), 1e6);
  return spec;
}

}  // namespace

Spec resolve(const config::ParameterSet& parameters) {
  config::ParameterReader reader(parameters);
  Spec spec;
  spec.processor = resolve_processor(reader);
  spec.bus.arbitration_ticks = ticks(reader, "bus.arbitration_ticks", 0, 100);
  spec.bus.write_ticks = ticks(reader, "bus.write_ticks", 1, 100);
  spec.bus.register_read_ticks = ticks(reader, "bus.register_read_ticks", 1, 100);
  spec.memory = resolve_memory(reader);
  spec.host = resolve_host(reader);

  const std::string mode = reader.choice("video.display_mode", {"blanked", "0", "1", "2"});
  spec.video.mode = mode == "blanked" ? video::DisplayMode::kBlanked
                    : mode == "0"     ? video::DisplayMode::kLores30
                    : mode == "1"     ? video::DisplayMode::kLores60
                                      : video::DisplayMode::kHires30;
  spec.video.phase_ps = ps(reader.real("video.phase_ns", 0, 1e9), 1e3);
  const video::Raster raster = video::raster_of(video::power_on(spec.video.mode), spec.video, spec.memory.fetch_bits);
  if (raster.line_ps > 0 && spec.memory.fetch_ticks * spec.processor.tick_ps > raster.fetch_period_ps)
    reader.impossible("frame_memory.fetch_ticks",
                      "a video fetch would take longer than the time between two fetches of this display mode");
  const std::int64_t refresh_ps = spec.memory.refresh_interval_ps;
  if (refresh_ps > 0 && refresh_ps <= 4 * spec.memory.card_busy_ticks * spec.processor.tick_ps)
    reader.impossible("frame_memory.refresh_interval_ns", "refresh alone would take a quarter of the memory's time");

  // Which of the two assembled forms of the firmware is loaded; the machine itself does not care.
  reader.text("microcode.pack", {"none", "full"});
  reader.finish();
  return spec;
}

}  // namespace dendro::rds3000
