#include "sim/study/igc_programs.h"

#include "sim/base/check.h"
#include "sim/base/embedded.h"
#include "sim/base/sha256.h"
#include "sim/study/algorithms.h"

namespace dendro::study {

lib::IgcPrograms igc_programs(const std::vector<std::string>& paths, const tools::IgcOptions& options) {
  lib::IgcPrograms all;
  for (const std::string& path : paths) {
    const std::string* text = base::embedded_file(path);
    DENDRO_CHECK(text != nullptr, "{}", path);
    const tools::IgcImage image = tools::assemble_igc(*text, path, options);
    lib::IgcPrograms programs;
    programs.words = image.words, programs.registers = image.registers;
    for (const auto& [name, program] : image.programs)
      programs.entries[name] = {program.entry, program.phase, program.uses_tree};
    all.append(programs);
  }
  std::string bytes;
  for (const std::uint64_t word : all.words) bytes += std::to_string(word) + "\n";
  all.name = paths.back();
  all.sha256 = base::sha256(bytes);
  return all;
}

lib::ArraySite array_site(const config::ParameterSet& parameters) {
  lib::ArraySite site;
  site.width = static_cast<int>(integer_of(parameters, "array.width"));
  site.height = static_cast<int>(integer_of(parameters, "array.height"));
  site.memory_bits = static_cast<int>(integer_of(parameters, "array.memory_bits"));
  site.ports = static_cast<int>(integer_of(parameters, "array.ports"));
  if (parameters.find("renderers.count") == nullptr) return site;
  site.renderers = static_cast<int>(integer_of(parameters, "renderers.count"));
  site.frame_width = static_cast<int>(integer_of(parameters, "frame_buffer.width"));
  site.frame_height = static_cast<int>(integer_of(parameters, "frame_buffer.height"));
  return site;
}

}  // namespace dendro::study
