#include "models/machines/pixel_planes/bit_array.h"

#include <gtest/gtest.h>

#include <random>

namespace dendro::pixel_planes {
namespace {

using igc::ArrayWord;
using igc::DataOp;
using igc::Function;
using igc::Operand;
using igc::Source;

/// One pixel by the rules of models/parts/igc/README.md, a word at a time, nothing left out.
struct Pixel {
  std::vector<bool> memory;
  bool e = false, c = false, d = false;

  void apply(const ArrayWord& w, bool t, int ports) {
    const bool second = ports > 1;
    const bool a = w.read_a && read(w.address_a), b = second && w.read_b && read(w.address_b);
    const auto operand = [&](Operand o) {
      return o == Operand::kOne || (o == Operand::kTree && t) || (o == Operand::kPortA && a) || (o == Operand::kPortB && b) ||
             (o == Operand::kData && d);
    };
    const bool x = operand(w.x), y = operand(w.y), was_c = c, was_d = d, was_e = e;
    if (w.function == Function::kSetEnable) e = true;
    if (w.function == Function::kAndCarry) e = e && c;
    if (w.function == Function::kAndNotCarry) e = e && !c;
    if (w.function == Function::kLoad) c = x;
    if (w.function == Function::kBorrow) c = (!x && y) || (x == y && was_c);
    if (w.function == Function::kCarry) c = (x && y) || (x != y && was_c);
    if (w.function == Function::kEqual) c = was_c && x == y;
    if (w.data == DataOp::kClear) d = false;
    if (w.data == DataOp::kTree) d = t;
    if (w.data == DataOp::kOrTree) d = d || t;
    if (w.data == DataOp::kPortA) d = a;
    bool value = x;
    if (w.source == Source::kXOrData) value = x || was_d;
    if (w.source == Source::kXAndNotData) value = x && !was_d;
    if (w.source == Source::kSum) value = (x != y) != was_c;
    if (w.source == Source::kTree) value = t;
    if (!was_e) return;
    if (w.write_a && w.address_a < memory.size()) memory[w.address_a] = value;
    if (w.write_b && second && w.address_b < memory.size()) memory[w.address_b] = value;
  }
  bool read(unsigned address) const { return address < memory.size() && memory[address]; }
};

/// Sets E, C and D first, as the assembler demands; then anything, with stretches of tree words.
std::vector<ArrayWord> random_words(std::mt19937_64& random, unsigned memory_bits) {
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  std::vector<ArrayWord> words(3);
  words[0].function = Function::kSetEnable, words[0].data = DataOp::kClear;
  words[1].function = Function::kLoad, words[1].x = below(2) ? Operand::kOne : Operand::kZero;
  bool tree = false;
  for (unsigned n = 5 + below(60); n > 0; --n) {
    if (below(8) == 0) tree = !tree;
    ArrayWord w;
    w.tree = tree;
    if (below(3) != 0) w.function = static_cast<Function>(below(static_cast<unsigned>(Function::kCount)));
    if (w.function == Function::kAndCarry && below(2) != 0) w.function = Function::kCarry;
    constexpr Operand kOperands[] = {Operand::kZero, Operand::kOne, Operand::kTree, Operand::kPortA, Operand::kPortB, Operand::kData};
    w.x = kOperands[below(6)], w.y = kOperands[below(6)];
    if (below(3) == 0) w.data = static_cast<DataOp>(below(static_cast<unsigned>(DataOp::kCount)));
    w.source = static_cast<Source>(below(static_cast<unsigned>(Source::kCount)));
    w.read_a = below(2), w.read_b = below(2), w.write_a = below(3) == 0, w.write_b = below(6) == 0;
    w.address_a = static_cast<std::uint8_t>(below(memory_bits + 1)), w.address_b = static_cast<std::uint8_t>(below(memory_bits + 1));
    words.push_back(w);
  }
  return words;
}

TEST(BitArray, WordsThatAreLeftOutDoNotChangeTheMemory) {
  constexpr unsigned kBits = 10;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    Spec spec;
    spec.array.width = spec.array.height = 64;
    spec.array.memory_bits = kBits;
    spec.array.ports = 1 + static_cast<int>(seed % 2);
    spec.tree.gap_clocks = static_cast<int>(seed % 3) * 2;
    ArrayState state(spec);
    for (Plane& plane : state.memory)
      for (std::uint64_t& word : plane) word = random();
    igc::Command command;
    command.a = static_cast<std::int64_t>(random() % 4001) - 2000, command.b = static_cast<std::int64_t>(random() % 4001) - 2000;
    command.c = static_cast<std::int64_t>(random() % 400001) - 200000;
    const std::vector<ArrayWord> words = random_words(random, kBits);
    const ArrayState before = state;
    apply_words(spec, command, words, state);
    for (int n = 0; n < 60; ++n) {
      const int x = static_cast<int>(random() % 64), y = static_cast<int>(random() % 64);
      const auto at = static_cast<std::size_t>(y * 64 + x);
      const auto bit = [at](const Plane& plane) { return (plane[at / 64] >> (at % 64) & 1) != 0; };
      Pixel pixel;
      for (const Plane& plane : before.memory) pixel.memory.push_back(bit(plane));
      unsigned position = 0;
      const auto gap = static_cast<unsigned>(spec.tree.gap_clocks);
      for (const ArrayWord& word : words) {
        pixel.apply(word, word.tree && position >= gap && expression_bit(command, x, y, position - gap), spec.array.ports);
        position = word.tree ? position + 1 : 0;
      }
      for (unsigned k = 0; k < kBits; ++k) ASSERT_EQ(bit(state.memory[k]), pixel.memory[k]) << "bit " << k << " of " << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace dendro::pixel_planes
