#include "models/machines/sgi_4d35/sgi_4d35.h"

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/clocked.h"
#include "models/machines/sgi_4d35/cycle.h"
#include "models/machines/sgi_4d35/estimate.h"
#include "models/machines/sgi_4d35/function.h"
#include "models/machines/sgi_4d35/recorder.h"
#include "sim/base/error.h"

namespace dendro::sgi_4d35 {
namespace {

std::uint32_t power_of_two(config::ParameterReader& reader, const char* key, std::int64_t lowest,
                           std::int64_t highest) {
  const std::int64_t value = reader.integer(key, lowest, highest);
  if ((value & (value - 1)) != 0) reader.impossible(key, "must be a power of two");
  return static_cast<std::uint32_t>(value);
}

void resolve_caches(config::ParameterReader& reader, Spec& spec) {
  spec.instruction_cache.size_bytes = power_of_two(reader, "instruction_cache.size_bytes", 1024, 1 << 20);
  spec.instruction_cache.refill_words = power_of_two(reader, "instruction_cache.refill_words", 1, 32);
  spec.instruction_cache.streaming = reader.boolean("instruction_cache.streaming");
  spec.data_cache.size_bytes = power_of_two(reader, "data_cache.size_bytes", 1024, 1 << 20);
  spec.data_cache.refill_words = power_of_two(reader, "data_cache.refill_words", 1, 32);
  spec.data_cache.store_partial = reader.boolean("data_cache.store_partial");
  spec.data_cache.partial_store_cycles =
      static_cast<unsigned>(reader.integer("data_cache.partial_store_cycles", 0, 16));
}

}  // namespace

Spec resolve(const config::ParameterSet& parameters) {
  config::ParameterReader reader(parameters);
  Spec spec;
  spec.clock_hz = reader.real("processor.clock_hz", 1e6, 1e9);
  spec.processor.processor_id =
      static_cast<std::uint32_t>(reader.integer("processor.processor_id", 0, 0xFFFF));
  spec.processor.fpu_interrupt = static_cast<unsigned>(reader.integer("processor.fpu_interrupt", 0, 5));
  const auto count = [&reader](const char* key, std::int64_t lowest, std::int64_t highest) {
    return static_cast<unsigned>(reader.integer(key, lowest, highest));
  };
  spec.pipeline.multiply_cycles = count("processor.multiply_cycles", 1, 64);
  spec.pipeline.divide_cycles = count("processor.divide_cycles", 1, 64);
  spec.pipeline.exception_cycles = count("processor.exception_cycles", 2, 8);
  spec.fpu.add = count("fpu.add_cycles", 1, 16);
  spec.fpu.compare = count("fpu.compare_cycles", 1, 16);
  spec.fpu.multiply_single = count("fpu.multiply_single_cycles", 1, 32);
  spec.fpu.multiply_double = count("fpu.multiply_double_cycles", 1, 32);
  spec.fpu.divide_single = count("fpu.divide_single_cycles", 1, 64);
  spec.fpu.divide_double = count("fpu.divide_double_cycles", 1, 64);
  spec.fpu.move = count("fpu.move_cycles", 1, 16);
  spec.fpu.single_to_double = count("fpu.single_to_double_cycles", 1, 16);
  spec.fpu.double_to_single = count("fpu.double_to_single_cycles", 1, 16);
  spec.fpu.word_to_float = count("fpu.word_to_float_cycles", 1, 16);
  spec.fpu.float_to_word = count("fpu.float_to_word_cycles", 1, 16);
  spec.fpu.rounding = count("fpu.rounding_cycles", 0, 1);
  resolve_caches(reader, spec);
  spec.bus.entries = count("write_buffer.entries", 1, 64);
  spec.bus.read_bypass = reader.boolean("write_buffer.read_bypass");
  spec.bus.first_word_cycles = count("memory.first_word_cycles", 1, 200);
  spec.bus.word_cycles = count("memory.word_cycles", 1, 16);
  spec.bus.write_cycles = count("memory.write_cycles", 1, 200);
  spec.bus.page_write_cycles = count("memory.page_write_cycles", 1, 200);
  spec.bus.page_bytes = power_of_two(reader, "memory.page_bytes", 64, 1 << 20);
  const std::int64_t bytes = reader.integer("memory.main_bytes", 32 << 20, 256 << 20);
  if (bytes % (1 << 20) != 0) reader.impossible("memory.main_bytes", "must be a multiple of 1048576");
  spec.main_bytes = static_cast<std::uint32_t>(bytes);
  reader.finish();
  return spec;
}

std::vector<UnitStats> units_of(const Counters& c, const r3000::Counters& events) {
  const auto cache = [&c](const char* name, std::uint64_t accesses, std::uint64_t misses) -> UnitStats {
    return {name,
            {{"cycles", c.cycles}, {"busy", accesses}, {"idle", c.cycles - accesses}, {"misses", misses}}};
  };
  return {{"sgi_4d35.processor",
           {{"cycles", c.cycles},
            {"busy", c.busy},
            {"stall_exception", c.stall_exception},
            {"stall_fp", c.stall_fp},
            {"stall_multiply_divide", c.stall_multiply_divide},
            {"stall_instruction_miss", c.stall_instruction_miss},
            {"stall_data_miss", c.stall_data_miss},
            {"stall_uncached", c.stall_uncached},
            {"stall_partial_store", c.stall_partial_store},
            {"stall_write_buffer", c.stall_write_buffer},
            {"idle", 0},
            {"instructions", events.instructions},
            {"nops", c.nops},
            {"exceptions", events.exceptions},
            {"tlb_refills", events.tlb_refills},
            {"tlb_refill_cycles", c.tlb_refill_cycles}}},
          cache("sgi_4d35.instruction_cache", c.instruction_accesses, c.instruction_misses),
          cache("sgi_4d35.data_cache", c.data_accesses, c.data_misses),
          {"sgi_4d35.memory",
           {{"cycles", c.cycles},
            {"busy", c.memory.busy},
            {"idle", c.cycles - c.memory.busy},
            {"reads", c.memory.reads},
            {"read_words", c.memory.read_words},
            {"writes", c.memory.writes},
            {"page_writes", c.memory.page_writes},
            {"overtaken", c.memory.overtaken}}}};
}

MachineType sgi_4d35_type() {
  MachineType type;
  type.name = "sgi-4d35";
  type.summary = "SGI 4D/35: R3000A and R3010A at 36 MHz, software rendering (MO95); programs by `exec`";
  type.presets = {"4d35"};
  type.levels = {Level::kFunction, Level::kEstimate, Level::kCycle, Level::kClocked};
  type.folder = "models/machines/sgi_4d35";
  type.make = [](const config::ParameterSet&, Level, const MachineOptions&) -> std::unique_ptr<Machine> {
    throw UserError("", 0, "sgi-4d35",
                    "runs programs only (dendro exec sgi-4d35 PROGRAM.elf); this command cannot drive it");
  };
  type.check = [](const config::ParameterSet& parameters, Level) { resolve(parameters); };
  type.exec = [](const config::ParameterSet& parameters, Level level, const ProgramImage& image,
                 service_block::Services& services, std::uint64_t limit, const MachineOptions& options) {
    const Spec spec = resolve(parameters);
    if (level == Level::kFunction) return run_function(spec, image, services, limit, options);
    if (level == Level::kEstimate) return run_estimate(spec, image, services, limit, options);
    if (options.recorder != nullptr && level == Level::kCycle)
      return run_recorded(spec, image, services, limit, *options.recorder);
    RunOptions run;
    run.machine = options;
    return level == Level::kCycle ? run_cycle(spec, image, services, limit, run)
                                  : run_clocked(spec, image, services, limit, run);
  };
  type.boundaries = boundaries();
  type.replay = [](const config::ParameterSet& parameters, Level level, trace::Reader& trace) {
    return replay(resolve(parameters), level, trace);
  };
  type.plain_boundary = kProcessorBoundary;
  type.replay_plain = [](const config::ParameterSet& parameters, Level level, trace::PlainReader& trace) {
    return replay_plain(resolve(parameters), level, trace);
  };
  return type;
}

}  // namespace dendro::sgi_4d35
