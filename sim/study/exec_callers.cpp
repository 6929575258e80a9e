#include "sim/study/exec_callers.h"

#include <optional>

namespace dendro::study {
namespace {

constexpr unsigned kMostCallers = 8;
constexpr std::uint32_t kAddiuSp = 0x27BD0000, kSwRaSp = 0xAFBF0000, kUpper = 0xFFFF0000;

std::uint32_t word_of(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 4; ++i) word = word << 8 | bytes[at + i];
  return word;
}

std::optional<std::uint32_t> code_at(const ElfProgram& program, std::uint32_t address) {
  for (const ElfProgram::Segment& segment : program.segments)
    if (address >= segment.address && std::uint64_t{address} + 4 <= segment.address + segment.bytes.size())
      return word_of(segment.bytes, address - segment.address);
  return std::nullopt;
}

bool is_call(std::uint32_t word) {
  const std::uint32_t major = word >> 26;
  return major == 3 || (major == 0 && (word & 0x3F) == 9) || (major == 1 && (word >> 20 & 1));  // jal, jalr, b..al
}

/// What the prologue before `pc` has done.
struct Frame {
  std::uint32_t bytes = 0;
  std::optional<std::uint32_t> return_at;  ///< from the stack pointer
};

Frame frame_at(const ElfProgram& program, std::uint32_t pc) {
  Frame frame;
  const ElfProgram::Symbol* function = program.function_of(pc);
  if (function == nullptr) return frame;
  for (std::uint32_t at = function->address; at < pc; at += 4) {
    const auto word = code_at(program, at);
    if (!word) break;
    const auto amount = static_cast<std::int16_t>(*word & 0xFFFF);
    if ((*word & kUpper) == kAddiuSp && amount < 0 && frame.bytes == 0) frame.bytes = static_cast<std::uint32_t>(-amount);
    if ((*word & kUpper) == kSwRaSp && amount >= 0) frame.return_at = static_cast<std::uint32_t>(amount);
  }
  return frame;
}

}  // namespace

std::string callers_text(const ElfProgram& program, const ProgramResult& result, std::uint32_t pc) {
  std::string text;
  std::uint32_t sp = 0;  // in result.stack
  for (unsigned i = 0; i < kMostCallers; ++i) {
    const Frame frame = frame_at(program, pc);
    std::uint32_t back = result.return_address;
    if (frame.return_at && !(i == 0 && result.stack.empty())) {  // a stack that overflows: its call was the last
      if (std::uint64_t{sp} + *frame.return_at + 4 > result.stack.size()) return text;
      back = word_of(result.stack, sp + *frame.return_at);
    } else if (i != 0) {
      return text;
    }
    pc = back - 8;
    const auto call = code_at(program, pc);
    if (!call || !is_call(*call)) return text;
    text += (i == 0 ? ", called from " : ", ") + program.place(pc);
    sp += frame.bytes;
  }
  return text + " and so on";
}

}  // namespace dendro::study
