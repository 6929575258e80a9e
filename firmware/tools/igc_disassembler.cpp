#include "firmware/tools/igc_disassembler.h"

#include <fmt/format.h>

#include "models/parts/igc/igc_disasm.h"
#include "sim/base/error.h"

namespace dendro::tools {
namespace {

using igc::LoopCount;
using igc::MicroWord;

std::string place(unsigned number, unsigned offset, bool indexed) {
  if (!indexed) return fmt::format("r{}[{}]", number, offset);
  return offset == 0 ? fmt::format("r{}[i]", number) : fmt::format("r{}[i + {}]", number, offset);
}

std::string text_of(const MicroWord& w) {
  const auto offset = w.constant_offset;
  return igc::text_of(w, {place(w.register_a, w.offset_a, w.indexed_a), place(w.register_b, w.offset_b, w.indexed_b),
                          offset == 0 ? "constant" : fmt::format("constant[i + {}]", offset)});
}

std::string count_of(const MicroWord& w) {
  switch (w.loop) {
    case LoopCount::kFraction: return "fraction";
    case LoopCount::kGuard: return "guard";
    case LoopCount::kGuardLessOne: return "guard - 1";
    case LoopCount::kGap: return "gap";
    case LoopCount::kRegister: return fmt::format("r{}", w.loop_number);
    default: return fmt::format("{}", w.loop_number);
  }
}

}  // namespace

Ucode igc_ucode(const IgcImage& image) {
  Ucode ucode;
  ucode.machine = "pixel-planes";
  ucode.isa_version = igc::kIsaVersion;
  ucode.words = image.words;
  for (const auto& [name, program] : image.programs) ucode.symbols[name] = program.entry;
  return ucode;
}

std::string disassemble_igc(const Ucode& ucode) {
  std::string text;
  for (unsigned r = 0; r < igc::kRegisters; ++r) text += fmt::format("register r{} = {};\n", r, r);
  bool begins = true, in_loop = false;
  for (std::uint32_t at = 0; at < ucode.words.size(); ++at) {
    const MicroWord word = igc::unpack(ucode.words[at]);
    if (begins) {
      std::string name = fmt::format("p{}", at);
      for (const auto& [symbol, address] : ucode.symbols)
        if (address == at) name = symbol;
      text += fmt::format("\nprogram {} {{\n", name);
    }
    if (word.loop != LoopCount::kNone && !in_loop) text += fmt::format("  loop {} {{\n", count_of(word));
    in_loop = word.loop != LoopCount::kNone;
    text += fmt::format("  {}{};\n", in_loop ? "  " : "", text_of(word));
    if (in_loop && word.loop_end) text += "  }\n", in_loop = false;
    begins = word.end;
    if (word.end) text += "}\n";
  }
  if (assemble_igc(text, "disassembly", {2, 256, {}}).words != ucode.words)
    throw UserError("the program holds words that the language of the assembler cannot say");
  return text;
}

}  // namespace dendro::tools
