#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/parts/igc/igc_isa.h"

namespace dendro::igc {

/// A coefficient as a bit stream: value times 2^fraction, rounded to the nearest integer, ties to even; 0 for what is not
/// a number, ±2^62 for what is larger.
std::int64_t translate(float value, unsigned fraction);

/// What programs and registers the controller holds.
struct ControllerState {
  std::array<std::uint64_t, kStoreWords> store{};
  std::array<std::uint8_t, kRegisters> registers{};
};

/// The words from an entry to the one with `end`, wrapping at the end of the store. Throws UserError when none has it.
std::vector<MicroWord> program_at(const ControllerState& state, unsigned entry);

/// Turns of a loop. `gap`: the leading zeros of an expression.
unsigned loop_turns(const MicroWord& word, const Header& header, const ControllerState& state, unsigned gap);

/// Calls `send(word, turn)` for every word of the program that is sent, one a clock.
template <class Send>
void walk(const std::vector<MicroWord>& program, const Header& header, const ControllerState& state, unsigned gap,
          const Send& send) {
  for (std::size_t at = 0; at < program.size();) {
    std::size_t after = at + 1;
    while (program[at].loop != LoopCount::kNone && after < program.size() && !program[after - 1].loop_end) ++after;
    const unsigned turns = program[at].loop == LoopCount::kNone ? 1 : loop_turns(program[at], header, state, gap);
    for (unsigned turn = 0; turn < turns; ++turn)
      for (std::size_t k = at; k < after; ++k) send(program[k], turn);
    at = after;
  }
}

/// Clocks of a command: the words that its program sends.
std::uint64_t count_words(const std::vector<MicroWord>& program, const Header& header, const ControllerState& state,
                          unsigned gap);

/// What the array is sent for a micro-word in turn `turn` of its loop.
ArrayWord resolve(const MicroWord& word, unsigned turn, const Command& command, const ControllerState& state);

/// All array words of a command, in order.
std::vector<ArrayWord> expand(const std::vector<MicroWord>& program, const Command& command,
                              const ControllerState& state, unsigned gap);

}  // namespace dendro::igc
