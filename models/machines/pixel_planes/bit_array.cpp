#include "models/machines/pixel_planes/bit_array.h"

#include <algorithm>

namespace dendro::pixel_planes {
namespace {

using igc::ArrayWord;
using igc::DataOp;
using igc::Function;
using igc::Operand;
using igc::Source;
using Wide = __int128;

Wide expression(const igc::Command& command, int x, int y) {
  return static_cast<Wide>(command.a) * x + static_cast<Wide>(command.b) * y + command.c;
}

/// Turns 64 rows of 64 bits into 64 columns: bit p of out[k] is bit k of in[p].
void transpose(std::uint64_t (&m)[64]) {
  std::uint64_t mask = 0x00000000FFFFFFFF;
  for (int j = 32; j != 0; j >>= 1, mask ^= mask << j)
    for (int k = 0; k < 64; k = (k + j + 1) & ~j) {
      const std::uint64_t t = ((m[k] >> j) ^ m[k + j]) & mask;
      m[k] ^= t << j;
      m[k + j] ^= t;
    }
}

/// 64 pixels in a row while a command runs.
class Group {
 public:
  Group(ArrayState& state, std::size_t at) : state_(state), at_(at), e_(state.enable[at]), c_(state.carry[at]), d_(state.data[at]) {}
  ~Group() { state_.enable[at_] = e_, state_.carry[at_] = c_, state_.data[at_] = d_; }

  void apply(const ArrayWord& word, std::uint64_t tree, int ports) {
    const std::uint64_t a = word.read_a ? read(word.address_a) : 0;
    const std::uint64_t b = word.read_b && ports > 1 ? read(word.address_b) : 0;
    const std::uint64_t x = operand(word.x, tree, a, b), y = operand(word.y, tree, a, b);
    const std::uint64_t value = source(word.source, x, y, tree);
    const std::uint64_t enable = e_;
    change_flags(word.function, x, y);
    change_data(word.data, tree, a);
    if (word.write_a) write(word.address_a, value, enable);
    if (word.write_b && ports > 1) write(word.address_b, value, enable);
  }

 private:
  std::uint64_t read(unsigned address) const { return address < state_.memory.size() ? state_.memory[address][at_] : 0; }
  void write(unsigned address, std::uint64_t value, std::uint64_t enable) {
    if (address >= state_.memory.size()) return;
    std::uint64_t& word = state_.memory[address][at_];
    word = (word & ~enable) | (value & enable);
  }
  std::uint64_t operand(Operand which, std::uint64_t tree, std::uint64_t a, std::uint64_t b) const {
    switch (which) {
      case Operand::kOne: return ~std::uint64_t{0};
      case Operand::kTree: return tree;
      case Operand::kPortA: return a;
      case Operand::kPortB: return b;
      case Operand::kData: return d_;
      default: return 0;
    }
  }
  std::uint64_t source(Source which, std::uint64_t x, std::uint64_t y, std::uint64_t tree) const {
    switch (which) {
      case Source::kXOrData: return x | d_;
      case Source::kXAndNotData: return x & ~d_;
      case Source::kSum: return x ^ y ^ c_;
      case Source::kTree: return tree;
      default: return x;
    }
  }
  void change_flags(Function function, std::uint64_t x, std::uint64_t y) {
    switch (function) {
      case Function::kSetEnable: e_ = ~std::uint64_t{0}; break;
      case Function::kAndCarry: e_ &= c_; break;
      case Function::kAndNotCarry: e_ &= ~c_; break;
      case Function::kLoad: c_ = x; break;
      case Function::kBorrow: c_ = (~x & y) | (~(x ^ y) & c_); break;
      case Function::kCarry: c_ = (x & y) | ((x ^ y) & c_); break;
      case Function::kEqual: c_ &= ~(x ^ y); break;
      default: break;
    }
  }
  void change_data(DataOp op, std::uint64_t tree, std::uint64_t a) {
    switch (op) {
      case DataOp::kClear: d_ = 0; break;
      case DataOp::kTree: d_ = tree; break;
      case DataOp::kOrTree: d_ |= tree; break;
      case DataOp::kPortA: d_ = a; break;
      default: break;
    }
  }

  ArrayState& state_;
  std::size_t at_;
  std::uint64_t e_, c_, d_;
};

/// The bits of the expression for 64 pixels in a row, 64 at a time.
class TreeBits {
 public:
  TreeBits(const igc::Command& command, int x, int y, bool wide) {
    for (int p = 0; p < 64; ++p) {
      const Wide value = expression(command, x + p, y);
      low_[p] = static_cast<std::uint64_t>(value);
      high_[p] = static_cast<std::uint64_t>(value >> 64);
    }
    transpose(low_);
    if (wide) transpose(high_);
  }

  std::uint64_t bit(unsigned k) const { return k < 64 ? low_[k] : high_[std::min(k - 64, 63u)]; }

 private:
  std::uint64_t low_[64], high_[64];
};

}  // namespace

bool expression_bit(const igc::Command& command, int x, int y, unsigned bit) {
  return (expression(command, x, y) >> std::min(bit, 127u) & 1) != 0;
}

void apply_words(const Spec& spec, const igc::Command& command, const std::vector<ArrayWord>& words,
                 ArrayState& state) {
  const int gap = spec.tree.gap_clocks;
  // Position of every word in its stream; -1: no tree bit, or a leading zero.
  std::vector<int> bits;
  int position = 0, longest = 0;
  for (const ArrayWord& word : words) {
    bits.push_back(word.tree && position >= gap ? position - gap : -1);
    position = word.tree ? position + 1 : 0;
    longest = std::max(longest, position - gap);
  }
  const int per_row = spec.array.width / 64;
  for (std::size_t at = 0; at < state.enable.size(); ++at) {
    Group group(state, at);
    const TreeBits tree(command, static_cast<int>(at) % per_row * 64, static_cast<int>(at) / per_row, longest > 64);
    for (std::size_t n = 0; n < words.size(); ++n)
      group.apply(words[n], bits[n] >= 0 ? tree.bit(static_cast<unsigned>(bits[n])) : 0, spec.array.ports);
  }
}

}  // namespace dendro::pixel_planes
