#include "models/parts/igc/igc_disasm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace dendro::igc {
namespace {

std::string operand(const WordNames& names, Operand which) {
  switch (which) {
    case Operand::kOne: return "1";
    case Operand::kTree: return "tree";
    case Operand::kConstant: return names.constant;
    case Operand::kPortA: return names.port_a;
    case Operand::kPortB: return names.port_b;
    case Operand::kData: return "data";
    default: return "0";
  }
}

std::string function_part(const MicroWord& w, const WordNames& names) {
  const std::string x = operand(names, w.x), y = operand(names, w.y);
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

std::string data_part(const MicroWord& w, const WordNames& names) {
  switch (w.data) {
    case DataOp::kClear: return "data = 0";
    case DataOp::kTree: return "data = tree";
    case DataOp::kOrTree: return "data = data | tree";
    case DataOp::kPortA: return "data = " + names.port_a;
    default: return "";
  }
}

std::string value_written(const MicroWord& w, const WordNames& names) {
  const std::string x = operand(names, w.x);
  switch (w.source) {
    case Source::kXOrData: return x + " | data";
    case Source::kXAndNotData: return x + " & ~data";
    case Source::kTree: return "tree";
    case Source::kSum:
      return w.x == Operand::kZero && w.y == Operand::kZero ? "carry"
                                                            : fmt::format("sum({}, {})", x, operand(names, w.y));
    default: return x;
  }
}

}  // namespace

std::string text_of(const MicroWord& w, const WordNames& names) {
  std::vector<std::string> parts;
  const bool late = w.source == Source::kTree;
  const auto write = [&] {
    if (w.write_a) parts.push_back(names.port_a + " = " + value_written(w, names));
    if (w.write_b) parts.push_back(names.port_b + " = " + value_written(w, names));
  };
  if (w.write_a && !late) write();
  for (const std::string& part : {data_part(w, names), function_part(w, names)})
    if (!part.empty()) parts.push_back(part);
  if (!w.write_a || late) write();
  const std::string all = fmt::format("{}", fmt::join(parts, ", "));
  if (w.tree && all.find("tree") == std::string::npos) parts.push_back("tree");
  return parts.empty() ? "idle" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const ArrayWord& word) {
  MicroWord w;
  w.function = word.function, w.x = word.x, w.y = word.y, w.data = word.data, w.source = word.source;
  w.write_a = word.write_a, w.write_b = word.write_b, w.tree = word.tree;
  return text_of(w, {fmt::format("m[{}]", word.address_a), fmt::format("m[{}]", word.address_b), "constant"});
}

std::string text_of(const Command& command) {
  const Header& h = command.header;
  if (h.register_write) return fmt::format("register {} = {}", h.register_number, h.value);
  std::string text = fmt::format("program at word {}, fraction {}, guard {}", h.entry, h.fraction, h.guard);
  if (h.expression) text += fmt::format(", A {}, B {}, C {}", command.a, command.b, command.c);
  if (h.constant || h.long_constant) text += fmt::format(", constant 0x{:x}", command.constant);
  return text;
}

}  // namespace dendro::igc
