#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "models/parts/igc/igc.h"

namespace dendro::pixel_planes {

/// What a whole micro-program does to the fields of a pixel, in word arithmetic. T is the expression without its
/// fraction, floor(T / 2^fraction), a signed number of `bits` + guard bits.
enum class MacroKind : std::uint8_t {
  kFill,          ///< every fill: field := constant
  kRaise,         ///< field 0 := max(field 0, min(T, all ones))
  kLower,         ///< field 0 := min(field 0, max(T, 0))
  kRaiseScratch,  ///< kRaise, and field 1 := low bits of T
  kLowerScratch,  ///< kLower, and field 1 := low bits of T
  kKill,          ///< field 0 := 0 where the expression, of fraction + guard bits, is negative
  kCloseOpen,     ///< field 0 := 0 where it is all ones
  kFinish,        ///< seen: field 0 < field 1 and field 0 < field 2; there field 2 := field 0; bit 0 of field 1 := seen
  kMatchPaint,    ///< where bit 0 of field 1 is set and field 0 = T: field 2 := constant
  kPaint,         ///< where bit 0 of field 1 is set: field 2 := constant
  kRaiseIndex,    ///< kRaise, and where field 0 was below T: field 1 := constant
  kPaintIndex,    ///< where bit 0 of field 1 is set and field 0 = the constant's low bits: field 2 := those above
  kSignFirst,     ///< bit 0 of field 1 := the expression, of fraction + guard bits, is not negative
  kSign           ///< bit 0 of field 1 := itself and that
};

constexpr bool is_sign(MacroKind kind) { return kind == MacroKind::kSignFirst || kind == MacroKind::kSign; }

/// Where a program finds the flag outside which it changes nothing.
struct Gate {
  unsigned register_number = 0, offset = 0;
};

/// A field of the pixel as registers and counts of the controller say it.
struct FieldPlace {
  unsigned low = 0, bits = 0;
  bool operator==(const FieldPlace& other) const { return low == other.low && bits == other.bits; }
};

/// One macro-operation with everything resolved.
struct Macro {
  MacroKind kind = MacroKind::kFill;
  FieldPlace fields[3];
  unsigned field_count = 0;
  std::int64_t a = 0, b = 0, c = 0;  ///< of the expression
  unsigned fraction = 0;
  unsigned stream_bits = 0;  ///< the expression is taken modulo 2^stream_bits; 0: there is none
  std::uint64_t constant = 0;
};

struct Pattern;

/// A micro-program as word arithmetic sees it.
class MacroProgram {
 public:
  explicit MacroProgram(std::vector<igc::MicroWord> words);

  /// The macro-operations that a command comes to; nothing for programs that are none of them, word for word, and for
  /// sizes that word arithmetic does not hold.
  std::optional<std::vector<Macro>> macros(const igc::Command& command, const igc::ControllerState& controller) const;

  const std::vector<igc::MicroWord>& words() const { return words_; }

  /// Of a program that begins with enable = 1, carry = flag, enable = enable & carry, and never sets enable again.
  const std::optional<Gate>& gate() const { return gate_; }

 private:
  void find_gate();
  std::optional<Macro> from_pattern(const igc::Command& command, const igc::ControllerState& controller) const;
  std::optional<std::vector<Macro>> fills(const igc::Command& command, const igc::ControllerState& controller) const;

  std::vector<igc::MicroWord> words_;
  const Pattern* pattern_ = nullptr;
  std::array<int, 4> bound_{};  ///< registers by the pattern's roles, -1: none
  bool fills_only_ = false;
  std::optional<Gate> gate_;
};

}  // namespace dendro::pixel_planes
