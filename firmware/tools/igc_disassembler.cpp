#include "firmware/tools/igc_disassembler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "models/parts/igc/igc_isa.h"
#include "sim/base/error.h"

namespace dendro::tools {
namespace {

using igc::DataOp;
using igc::Function;
using igc::LoopCount;
using igc::MicroWord;
using igc::Operand;
using igc::Source;

std::string place(unsigned number, unsigned offset, bool indexed) {
  if (!indexed) return fmt::format("r{}[{}]", number, offset);
  return offset == 0 ? fmt::format("r{}[i]", number) : fmt::format("r{}[i + {}]", number, offset);
}
std::string port_a(const MicroWord& w) { return place(w.register_a, w.offset_a, w.indexed_a); }
std::string port_b(const MicroWord& w) { return place(w.register_b, w.offset_b, w.indexed_b); }

std::string operand(const MicroWord& w, Operand which) {
  switch (which) {
    case Operand::kOne: return "1";
    case Operand::kTree: return "tree";
    case Operand::kConstant: return w.constant_offset == 0 ? "constant" : fmt::format("constant[i + {}]", w.constant_offset);
    case Operand::kPortA: return port_a(w);
    case Operand::kPortB: return port_b(w);
    case Operand::kData: return "data";
    default: return "0";
  }
}

std::string function_part(const MicroWord& w) {
  const std::string x = operand(w, w.x), y = operand(w, w.y);
  switch (w.function) {
    case Function::kSetEnable: return "enable = 1";
    case Function::kAndCarry: return "enable = enable & carry";
    case Function::kAndNotCarry: return "enable = enable & ~carry";
    case Function::kLoad: return "carry = " + x;
    case Function::kBorrow: return fmt::format("carry = borrow({}, {})", x, y);
    case Function::kCarry: return fmt::format("carry = majority({}, {})", x, y);
    case Function::kEqual: return fmt::format("carry = same({}, {})", x, y);
    default: return "";
  }
}

std::string data_part(const MicroWord& w) {
  switch (w.data) {
    case DataOp::kClear: return "data = 0";
    case DataOp::kTree: return "data = tree";
    case DataOp::kOrTree: return "data = data | tree";
    case DataOp::kPortA: return "data = " + port_a(w);
    default: return "";
  }
}

std::string value_written(const MicroWord& w) {
  const std::string x = operand(w, w.x);
  switch (w.source) {
    case Source::kXOrData: return x + " | data";
    case Source::kXAndNotData: return x + " & ~data";
    case Source::kTree: return "tree";
    case Source::kSum:
      return w.x == Operand::kZero && w.y == Operand::kZero ? "carry" : fmt::format("sum({}, {})", x, operand(w, w.y));
    default: return x;
  }
}

/// The field named first takes port a.
std::string text_of(const MicroWord& w) {
  std::vector<std::string> parts;
  const bool late = w.source == Source::kTree;
  const auto write = [&] {
    if (w.write_a) parts.push_back(port_a(w) + " = " + value_written(w));
    if (w.write_b) parts.push_back(port_b(w) + " = " + value_written(w));
  };
  if (w.write_a && !late) write();
  for (const std::string& part : {data_part(w), function_part(w)})
    if (!part.empty()) parts.push_back(part);
  if (!w.write_a || late) write();
  const std::string all = fmt::format("{}", fmt::join(parts, ", "));
  if (w.tree && all.find("tree") == std::string::npos) parts.push_back("tree");
  return parts.empty() ? "idle" : fmt::format("{}", fmt::join(parts, ", "));
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
