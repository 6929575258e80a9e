#include "tests/support/array_port.h"

#include <fstream>
#include <sstream>

#include "firmware/tools/igc_assembler.h"

namespace dendro::test {

pixel_planes::Spec square_array(int side) {
  pixel_planes::Spec spec;
  spec.array.width = spec.array.height = side;
  return spec;
}

lib::IgcPrograms assemble_files(const std::vector<std::string>& paths, const std::map<std::string, unsigned>& registers,
                                int memory_bits) {
  tools::IgcOptions options;
  options.memory_bits = memory_bits;
  options.registers = registers;
  lib::IgcPrograms all;
  for (const std::string& path : paths) {
    std::ifstream in(path);
    std::stringstream text;
    text << in.rdbuf();
    const tools::IgcImage image = tools::assemble_igc(text.str(), path, options);
    lib::IgcPrograms programs;
    programs.words = image.words, programs.registers = image.registers;
    for (const auto& [program, entry] : image.programs)
      programs.entries[program] = {entry.entry, entry.phase, entry.uses_tree};
    all.append(programs);
  }
  return all;
}

}  // namespace dendro::test
