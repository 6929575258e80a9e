#include "models/parts/igc/igc.h"

#include <cmath>

#include "sim/base/error.h"

namespace dendro::igc {
namespace {

constexpr double kLargest = 4611686018427387904.0;  // 2^62

Operand resolve(Operand operand, const MicroWord& word, unsigned turn, std::uint64_t constant) {
  if (operand != Operand::kConstant) return operand;
  const unsigned bit = turn + word.constant_offset;
  return bit < 64 && (constant >> bit & 1) != 0 ? Operand::kOne : Operand::kZero;
}

}  // namespace

std::int64_t translate(float value, unsigned fraction) {
  const double scaled = std::ldexp(static_cast<double>(value), static_cast<int>(fraction));
  if (std::isnan(scaled)) return 0;
  if (scaled >= kLargest) return std::int64_t{1} << 62;
  if (scaled <= -kLargest) return -(std::int64_t{1} << 62);
  const double below = std::floor(scaled);
  const double over = scaled - below;
  const auto whole = static_cast<std::int64_t>(below);
  return whole + (over > 0.5 || (over == 0.5 && (whole & 1) != 0) ? 1 : 0);
}

std::vector<MicroWord> program_at(const ControllerState& state, unsigned entry) {
  std::vector<MicroWord> program;
  for (unsigned n = 0; n < kStoreWords; ++n) {
    program.push_back(unpack(state.store[(entry + n) % kStoreWords]));
    if (program.back().end) return program;
  }
  throw UserError("the micro-program at word " + std::to_string(entry) + " of the control store has no end");
}

unsigned loop_turns(const MicroWord& word, const Header& header, const ControllerState& state, unsigned gap) {
  switch (word.loop) {
    case LoopCount::kFraction: return header.fraction;
    case LoopCount::kGuard: return header.guard;
    case LoopCount::kGuardLessOne: return header.guard > 0 ? header.guard - 1 : 0;
    case LoopCount::kGap: return gap;
    case LoopCount::kRegister: return state.registers[word.loop_number % kRegisters];
    case LoopCount::kNumber: return word.loop_number;
    default: return 1;
  }
}

std::uint64_t count_words(const std::vector<MicroWord>& program, const Header& header, const ControllerState& state,
                          unsigned gap) {
  std::uint64_t count = 0;
  walk(program, header, state, gap, [&](const MicroWord&, unsigned) { ++count; });
  return count;
}

ArrayWord resolve(const MicroWord& word, unsigned turn, const Command& command, const ControllerState& state) {
  ArrayWord out;
  out.function = word.function;
  out.x = resolve(word.x, word, turn, command.constant);
  out.y = resolve(word.y, word, turn, command.constant);
  out.data = word.data, out.source = word.source;
  out.read_a = word.read_a, out.write_a = word.write_a, out.read_b = word.read_b, out.write_b = word.write_b;
  const auto address = [&](unsigned number, unsigned offset, bool indexed) {
    return static_cast<std::uint8_t>(state.registers[number % kRegisters] + offset + (indexed ? turn : 0));
  };
  out.address_a = address(word.register_a, word.offset_a, word.indexed_a);
  out.address_b = address(word.register_b, word.offset_b, word.indexed_b);
  out.tree = word.tree;
  return out;
}

std::vector<ArrayWord> expand(const std::vector<MicroWord>& program, const Command& command,
                              const ControllerState& state, unsigned gap) {
  std::vector<ArrayWord> words;
  walk(program, command.header, state, gap,
       [&](const MicroWord& word, unsigned turn) { words.push_back(resolve(word, turn, command, state)); });
  return words;
}

}  // namespace dendro::igc
