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

  bool is_disabled() const { return e_ == 0; }

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

/// The bits of the expression for 64 pixels in a row. A few are made one by one, more by turning a square of bits.
class TreeBits {
 public:
  TreeBits(const igc::Command& command, int x, int y, bool wide, bool few)
      : command_(command), x_(x), y_(y), wide_(wide), few_(few && !wide) {}

  std::uint64_t bit(unsigned k) {
    if (few_) return one(k);
    if (!turned_) turn();
    return k < 64 ? low_[k] : high_[std::min(k - 64, 63u)];
  }

 private:
  std::uint64_t one(unsigned k) const {
    const auto step = static_cast<std::uint64_t>(command_.a);
    auto value = static_cast<std::uint64_t>(expression(command_, x_, y_));
    std::uint64_t bits = 0;
    for (int p = 0; p < 64; ++p, value += step) bits |= (value >> k & 1) << p;
    return bits;
  }

  void turn() {
    Wide value = expression(command_, x_, y_);
    for (int p = 0; p < 64; ++p, value += command_.a) {
      low_[p] = static_cast<std::uint64_t>(value);
      if (wide_) high_[p] = static_cast<std::uint64_t>(value >> 64);
    }
    transpose(low_);
    if (wide_) transpose(high_);
    turned_ = true;
  }

  const igc::Command& command_;
  int x_, y_;
  bool wide_, few_, turned_ = false;
  std::uint64_t low_[64], high_[64];
};

/// Which registers the words behind a place still use.
struct Live {
  bool enable = false, carry = false, data = false;
};

bool is_used(const ArrayWord& w, const Live& live) {
  const bool enable = w.function == Function::kSetEnable || w.function == Function::kAndCarry ||
                      w.function == Function::kAndNotCarry;
  const bool function = w.function != Function::kHold && (enable ? live.enable : live.carry);
  return w.write_a || w.write_b || function || (w.data != DataOp::kHold && live.data);
}

/// What a word that is used needs from those before it. Registers that it sets anew are not needed unless it uses them, too.
Live before(const ArrayWord& w, Live live) {
  const bool function_live = w.function != Function::kHold && w.function < Function::kLoad ? live.enable : live.carry;
  const bool data_live = live.data;
  if (w.function == Function::kSetEnable) live.enable = false;
  if (w.function == Function::kLoad) live.carry = false;
  if (w.data != DataOp::kHold && w.data != DataOp::kOrTree) live.data = false;
  bool x = false, y = false;
  if (function_live) {
    live.carry = live.carry || w.function >= Function::kBorrow || w.function == Function::kAndCarry ||
                 w.function == Function::kAndNotCarry;
    x = w.function >= Function::kLoad, y = w.function >= Function::kBorrow;
  }
  if (data_live && w.data == DataOp::kOrTree) live.data = true;
  if (w.write_a || w.write_b) {
    live.enable = true;
    x = x || w.source != Source::kTree;
    if (w.source == Source::kSum) y = live.carry = true;
    if (w.source == Source::kXOrData || w.source == Source::kXAndNotData) live.data = true;
  }
  if ((x && w.x == Operand::kData) || (y && w.y == Operand::kData)) live.data = true;
  return live;
}

/// The words of a command that change the memory, themselves or through registers; E, C and D need not be right behind it.
std::vector<ArrayStep> steps_of(const std::vector<ArrayWord>& words, int gap) {
  std::vector<ArrayStep> steps;
  int position = 0;
  for (const ArrayWord& word : words) {
    steps.push_back({word, word.tree && position >= gap ? position - gap : -1, false});
    position = word.tree ? position + 1 : 0;
  }
  std::vector<ArrayStep> used;
  Live live;
  bool set_behind = false;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (!is_used(step->word, live)) continue;
    live = before(step->word, live);
    step->last_enable = !set_behind;
    set_behind = set_behind || step->word.function == Function::kSetEnable;
    used.push_back(*step);
  }
  std::reverse(used.begin(), used.end());
  return used;
}

}  // namespace

bool expression_bit(const igc::Command& command, int x, int y, unsigned bit) {
  return (expression(command, x, y) >> std::min(bit, 127u) & 1) != 0;
}

void apply_words(const Spec& spec, const igc::Command& command, const std::vector<ArrayWord>& words,
                 ArrayState& state) {
  apply_steps(spec, command, steps_of(words, spec.tree.gap_clocks), state);
}

void apply_steps(const Spec& spec, const igc::Command& command, const std::vector<ArrayStep>& steps, ArrayState& state) {
  constexpr std::size_t kFew = 4;
  std::size_t tree_bits = 0;
  int longest = 0;
  for (const ArrayStep& step : steps) tree_bits += step.bit >= 0, longest = std::max(longest, step.bit + 1);
  const int per_row = spec.array.width / 64;
  for (std::size_t at = 0; at < state.enable.size(); ++at) {
    Group group(state, at);
    TreeBits tree(command, static_cast<int>(at) % per_row * 64, static_cast<int>(at) / per_row, longest > 64,
                  tree_bits <= kFew);
    for (const ArrayStep& step : steps) {
      group.apply(step.word, step.bit >= 0 ? tree.bit(static_cast<unsigned>(step.bit)) : 0, spec.array.ports);
      if (step.last_enable && group.is_disabled()) break;
    }
  }
}

}  // namespace dendro::pixel_planes
