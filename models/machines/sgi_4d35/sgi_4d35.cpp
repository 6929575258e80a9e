#include "models/machines/sgi_4d35/sgi_4d35.h"

#include "models/machines/sgi_4d35/function.h"
#include "sim/base/error.h"

namespace dendro::sgi_4d35 {

Spec resolve(const config::ParameterSet& parameters) {
  config::ParameterReader reader(parameters);
  Spec spec;
  spec.clock_hz = reader.real("processor.clock_hz", 1e6, 1e9);
  spec.processor.processor_id =
      static_cast<std::uint32_t>(reader.integer("processor.processor_id", 0, 0xFFFF));
  spec.processor.fpu_interrupt = static_cast<unsigned>(reader.integer("processor.fpu_interrupt", 0, 5));
  const std::int64_t bytes = reader.integer("memory.main_bytes", 32 << 20, 256 << 20);
  if (bytes % (1 << 20) != 0) reader.impossible("memory.main_bytes", "must be a multiple of 1048576");
  spec.main_bytes = static_cast<std::uint32_t>(bytes);
  reader.finish();
  return spec;
}

MachineType sgi_4d35_type() {
  MachineType type;
  type.name = "sgi-4d35";
  type.summary = "SGI 4D/35: R3000A and R3010A at 36 MHz, software rendering (MO95); programs by `exec`";
  type.presets = {"4d35"};
  type.levels = {Level::kFunction};
  type.folder = "models/machines/sgi_4d35";
  type.make = [](const config::ParameterSet&, Level, const MachineOptions&) -> std::unique_ptr<Machine> {
    throw UserError("", 0, "sgi-4d35",
                    "runs programs only (dendro exec sgi-4d35 PROGRAM.elf); this command cannot drive it");
  };
  type.check = [](const config::ParameterSet& parameters, Level) { resolve(parameters); };
  type.exec = [](const config::ParameterSet& parameters, Level, const ProgramImage& image,
                 service_block::Services& services,
                 std::uint64_t limit) { return run_function(resolve(parameters), image, services, limit); };
  return type;
}

}  // namespace dendro::sgi_4d35
