#include "models/machines/pixel_planes/macro.h"

#include <algorithm>

#include "models/machines/pixel_planes/macro_pattern.h"

namespace dendro::pixel_planes {
namespace {

using igc::LoopCount;
using igc::MicroWord;

constexpr unsigned kMostBits = 30;        ///< of a field in word arithmetic
constexpr unsigned kMostStreamBits = 62;
constexpr std::int64_t kMostCoefficient = std::int64_t{1} << 50;  ///< so that sums over an array stay below 2^62

/// Binds the pattern's roles to registers; false when a word differs.
class Matcher {
 public:
  bool match(const Pattern& pattern, const std::vector<MicroWord>& program) {
    if (pattern.words.size() != program.size()) return false;
    for (std::size_t k = 0; k < program.size(); ++k) {
      MicroWord wanted = pattern.words[k];
      const MicroWord& is = program[k];
      const bool a = wanted.read_a || wanted.write_a, b = wanted.read_b || wanted.write_b;
      if (a && !bind(wanted.register_a, is.register_a)) return false;
      if (b && !bind(wanted.register_b, is.register_b)) return false;
      if (wanted.loop == LoopCount::kRegister && !bind(wanted.loop_number, is.loop_number)) return false;
      if (!(wanted == is)) return false;
    }
    return true;
  }

  const std::array<int, kRoles>& bound() const { return bound_; }

 private:
  bool bind(std::uint8_t& role, std::uint8_t number) {
    int& bound = bound_[role];
    if (bound >= 0 && bound != number) return false;
    bound = number;
    role = number;
    return true;
  }

  std::array<int, kRoles> bound_ = {-1, -1, -1, -1};
};

bool fits(const FieldPlace& field) { return field.bits >= 1 && field.bits <= kMostBits && field.low + field.bits <= 256; }

bool disjoint(const Macro& macro) {
  for (unsigned p = 0; p < macro.field_count; ++p)
    for (unsigned q = p + 1; q < macro.field_count; ++q) {
      const FieldPlace &f = macro.fields[p], &g = macro.fields[q];
      if (f.low < g.low + g.bits && g.low < f.low + f.bits) return false;
    }
  return true;
}

bool holds_expression(const igc::Command& command) {
  const auto small = [](std::int64_t v) { return v > -kMostCoefficient && v < kMostCoefficient; };
  return command.header.guard >= 1 && small(command.a) && small(command.b) && small(command.c);
}

bool is_fill(const MicroWord& word) {
  MicroWord plain;
  plain.write_a = true, plain.indexed_a = true, plain.register_a = word.register_a, plain.offset_a = word.offset_a;
  plain.loop = word.loop, plain.loop_number = word.loop_number, plain.loop_end = true, plain.end = word.end;
  plain.x = word.x, plain.constant_offset = word.constant_offset;
  const bool constant = word.x == igc::Operand::kZero || word.x == igc::Operand::kOne || word.x == igc::Operand::kConstant;
  return constant && (word.loop == LoopCount::kRegister || word.loop == LoopCount::kNumber) && word == plain;
}

/// `enable = 1` and then loops of one word that writes a constant.
bool is_fills(const std::vector<MicroWord>& words) {
  MicroWord first;
  first.function = igc::Function::kSetEnable;
  return words.size() >= 2 && words[0] == first && std::all_of(words.begin() + 1, words.end(), is_fill);
}

}  // namespace

MacroProgram::MacroProgram(std::vector<MicroWord> words) : words_(std::move(words)), fills_only_(is_fills(words_)) {
  find_gate();
  for (const Pattern& pattern : patterns()) {
    Matcher matcher;
    if (!matcher.match(pattern, words_)) continue;
    pattern_ = &pattern;
    bound_ = matcher.bound();
    return;
  }
}

void MacroProgram::find_gate() {
  if (words_.size() < 4) return;
  MicroWord set, load, gate;
  set.function = igc::Function::kSetEnable;
  load.function = igc::Function::kLoad, load.x = igc::Operand::kPortA, load.read_a = true;
  load.register_a = words_[1].register_a, load.offset_a = words_[1].offset_a;
  gate.function = igc::Function::kAndCarry;
  const bool sets_again = std::any_of(words_.begin() + 3, words_.end(),
                                      [](const MicroWord& w) { return w.function == igc::Function::kSetEnable; });
  if (words_[0] == set && words_[1] == load && words_[2] == gate && !sets_again)
    gate_ = Gate{load.register_a, load.offset_a};
}

std::optional<Macro> MacroProgram::from_pattern(const igc::Command& command,
                                                const igc::ControllerState& controller) const {
  const Pattern& pattern = *pattern_;
  const auto value = [&](unsigned role) { return controller.registers[static_cast<std::size_t>(bound_[role])]; };
  Macro macro;
  macro.kind = pattern.kind;
  macro.field_count = static_cast<unsigned>(pattern.bits.size());
  const unsigned bits = bound_[kBits] >= 0 ? value(kBits) : 0;
  for (unsigned k = 0; k < macro.field_count; ++k) {
    const unsigned own = pattern.bits[k];
    if (own == kNone) continue;
    macro.fields[k] = {value(kField0 + k), own == 0 ? bits : own};
    if (!fits(macro.fields[k])) return std::nullopt;
  }
  if (!disjoint(macro)) return std::nullopt;
  macro.constant = command.constant;
  if (pattern.expression) {
    if (!holds_expression(command)) return std::nullopt;
    macro.a = command.a, macro.b = command.b, macro.c = command.c;
    macro.fraction = command.header.fraction;
    macro.stream_bits = macro.fraction + command.header.guard + (pattern.kind == MacroKind::kKill || is_sign(pattern.kind) ? 0 : bits);
    if (macro.stream_bits > kMostStreamBits || command.header.guard < 1) return std::nullopt;
  }
  return macro;
}

std::optional<std::vector<Macro>> MacroProgram::fills(const igc::Command& command,
                                                      const igc::ControllerState& controller) const {
  std::vector<Macro> fills;
  for (std::size_t k = 1; k < words_.size(); ++k) {
    const MicroWord& word = words_[k];
    Macro macro;
    macro.field_count = 1;
    const unsigned bits = igc::loop_turns(word, command.header, controller, 0);
    macro.fields[0] = {static_cast<unsigned>(controller.registers[word.register_a]) + word.offset_a, bits};
    if (!fits(macro.fields[0])) return std::nullopt;
    for (unsigned turn = 0; turn < bits; ++turn)
      if (igc::resolve(word, turn, command, controller).x == igc::Operand::kOne) macro.constant |= std::uint64_t{1} << turn;
    fills.push_back(macro);
  }
  return fills;
}

std::optional<std::vector<Macro>> MacroProgram::macros(const igc::Command& command,
                                                       const igc::ControllerState& controller) const {
  if (fills_only_) return fills(command, controller);
  if (pattern_ == nullptr) return std::nullopt;
  const std::optional<Macro> macro = from_pattern(command, controller);
  if (!macro) return std::nullopt;
  return std::vector<Macro>{*macro};
}

}  // namespace dendro::pixel_planes
