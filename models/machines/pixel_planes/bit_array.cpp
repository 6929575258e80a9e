#include "models/machines/pixel_planes/bit_array.h"

#include <algorithm>
#include <array>
#include <numeric>

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

constexpr std::size_t kLanes = 8;
using Lanes = std::array<std::uint64_t, kLanes>;

/// Up to kLanes times 64 pixels in a row while a command runs.
class Group {
 public:
  Group(ArrayState& state, const std::uint32_t* at, std::size_t count) : state_(state), at_(at), count_(count) {
    for (std::size_t k = 0; k < count; ++k)
      e_[k] = state.enable[at[k]], c_[k] = state.carry[at[k]], d_[k] = state.data[at[k]];
  }
  /// E, C and D go back to the pixels.
  void finish() {
    for (std::size_t k = 0; k < count_; ++k)
      state_.enable[at_[k]] = e_[k], state_.carry[at_[k]] = c_[k], state_.data[at_[k]] = d_[k];
  }

  void apply(const ArrayWord& word, const Lanes& tree, int ports) {
    const Lanes a = word.read_a ? read(word.address_a) : Lanes{};
    const Lanes b = word.read_b && ports > 1 ? read(word.address_b) : Lanes{};
    const Lanes x = operand(word.x, tree, a, b), y = operand(word.y, tree, a, b);
    const bool writes_b = word.write_b && ports > 1;
    if (word.write_a || writes_b) {
      const Lanes value = source(word.source, x, y, tree);
      if (word.write_a) write(word.address_a, value);
      if (writes_b) write(word.address_b, value);
    }
    change_flags(word.function, x, y);
    change_data(word.data, tree, a);
  }

  bool is_disabled() const {
    return std::all_of(e_.begin(), e_.begin() + static_cast<std::ptrdiff_t>(count_), [](std::uint64_t e) { return e == 0; });
  }

 private:
  template <class Make>
  static Lanes each(const Make& make) {
    Lanes out;
    for (std::size_t k = 0; k < kLanes; ++k) out[k] = make(k);
    return out;
  }
  Lanes read(unsigned address) const {
    Lanes out{};
    if (address >= state_.memory.size()) return out;
    const Plane& plane = state_.memory[address];
    for (std::size_t k = 0; k < count_; ++k) out[k] = plane[at_[k]];
    return out;
  }
  void write(unsigned address, const Lanes& value) {
    if (address >= state_.memory.size()) return;
    Plane& plane = state_.memory[address];
    for (std::size_t k = 0; k < count_; ++k) {
      std::uint64_t& word = plane[at_[k]];
      word = (word & ~e_[k]) | (value[k] & e_[k]);
    }
  }
  Lanes operand(Operand which, const Lanes& tree, const Lanes& a, const Lanes& b) const {
    switch (which) {
      case Operand::kOne: return each([](std::size_t) { return ~std::uint64_t{0}; });
      case Operand::kTree: return tree;
      case Operand::kPortA: return a;
      case Operand::kPortB: return b;
      case Operand::kData: return d_;
      default: return {};
    }
  }
  Lanes source(Source which, const Lanes& x, const Lanes& y, const Lanes& tree) const {
    switch (which) {
      case Source::kXOrData: return each([&](std::size_t k) { return x[k] | d_[k]; });
      case Source::kXAndNotData: return each([&](std::size_t k) { return x[k] & ~d_[k]; });
      case Source::kSum: return each([&](std::size_t k) { return x[k] ^ y[k] ^ c_[k]; });
      case Source::kTree: return tree;
      default: return x;
    }
  }
  void change_flags(Function function, const Lanes& x, const Lanes& y) {
    switch (function) {
      case Function::kSetEnable: e_ = each([](std::size_t) { return ~std::uint64_t{0}; }); break;
      case Function::kAndCarry: e_ = each([&](std::size_t k) { return e_[k] & c_[k]; }); break;
      case Function::kAndNotCarry: e_ = each([&](std::size_t k) { return e_[k] & ~c_[k]; }); break;
      case Function::kLoad: c_ = x; break;
      case Function::kBorrow: c_ = each([&](std::size_t k) { return (~x[k] & y[k]) | (~(x[k] ^ y[k]) & c_[k]); }); break;
      case Function::kCarry: c_ = each([&](std::size_t k) { return (x[k] & y[k]) | ((x[k] ^ y[k]) & c_[k]); }); break;
      case Function::kEqual: c_ = each([&](std::size_t k) { return c_[k] & ~(x[k] ^ y[k]); }); break;
      default: break;
    }
  }
  void change_data(DataOp op, const Lanes& tree, const Lanes& a) {
    switch (op) {
      case DataOp::kClear: d_ = {}; break;
      case DataOp::kTree: d_ = tree; break;
      case DataOp::kOrTree: d_ = each([&](std::size_t k) { return d_[k] | tree[k]; }); break;
      case DataOp::kPortA: d_ = a; break;
      default: break;
    }
  }

  ArrayState& state_;
  const std::uint32_t* at_;
  std::size_t count_;
  Lanes e_{}, c_{}, d_{};
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

/// The same for kLanes times 64 pixels, row after row: the next row's bits are this one's and B, added bit by bit.
class RowBits {
 public:
  RowBits(const igc::Command& command, std::size_t bits) : command_(command), bits_(bits) {}

  void first_row(const std::array<std::uint32_t, kLanes>& at, std::size_t lanes, int per_row) {
    for (std::size_t n = 0; n < lanes; ++n) {
      TreeBits tree(command_, static_cast<int>(at[n]) % per_row * 64, static_cast<int>(at[n]) / per_row, false, false);
      for (std::size_t k = 0; k < bits_; ++k) planes_[k][n] = tree.bit(static_cast<unsigned>(k));
    }
  }
  void next_row() {
    Lanes carry{};
    for (std::size_t k = 0; k < bits_; ++k) {
      const std::uint64_t add = command_.b >> k & 1 ? ~std::uint64_t{0} : 0;
      for (std::size_t n = 0; n < kLanes; ++n) {
        const std::uint64_t bit = planes_[k][n];
        planes_[k][n] = bit ^ add ^ carry[n];
        carry[n] = (bit & add) | ((bit ^ add) & carry[n]);
      }
    }
  }
  const Lanes& bit(unsigned k) const { return planes_[k]; }

 private:
  const igc::Command& command_;
  std::size_t bits_;
  std::array<Lanes, 64> planes_{};
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

template <class Bit>
void run(const std::vector<ArrayStep>& steps, int ports, Group& group, const Bit& bit) {
  for (const ArrayStep& step : steps) {
    group.apply(step.word, step.bit >= 0 ? bit(static_cast<unsigned>(step.bit)) : Lanes{}, ports);
    if (step.last_enable && group.is_disabled()) return;
  }
}

void apply_in_rows(const Spec& spec, const igc::Command& command, const std::vector<ArrayStep>& steps, std::size_t bits,
                   ArrayState& state) {
  const auto per_row = static_cast<std::uint32_t>(spec.array.width / 64);
  RowBits tree(command, bits);
  for (std::uint32_t column = 0; column < per_row; column += kLanes) {
    std::array<std::uint32_t, kLanes> at{};
    const std::size_t lanes = std::min<std::size_t>(kLanes, per_row - column);
    for (std::size_t n = 0; n < lanes; ++n) at[n] = column + static_cast<std::uint32_t>(n);
    tree.first_row(at, lanes, static_cast<int>(per_row));
    for (int y = 0; y < spec.array.height; ++y) {
      Group group(state, at.data(), lanes);
      run(steps, spec.array.ports, group, [&](unsigned k) { return tree.bit(k); });
      group.finish();
      for (std::uint32_t& word : at) word += per_row;
      if (y + 1 < spec.array.height) tree.next_row();
    }
  }
}

void apply_to(const Spec& spec, const igc::Command& command, const std::vector<ArrayStep>& steps, int longest, std::size_t tree_bits,
              ArrayState& state, const std::vector<std::uint32_t>& only) {
  constexpr std::size_t kFew = 4;
  const int per_row = spec.array.width / 64;
  std::vector<TreeBits> trees;
  trees.reserve(kLanes);
  for (std::size_t k = 0; k < only.size(); k += kLanes) {
    const std::size_t lanes = std::min(kLanes, only.size() - k);
    trees.clear();
    for (std::size_t n = 0; n < lanes && tree_bits > 0; ++n) {
      const auto at = static_cast<int>(only[k + n]);
      trees.emplace_back(command, at % per_row * 64, at / per_row, longest > 64, tree_bits <= kFew);
    }
    Group group(state, only.data() + k, lanes);
    run(steps, spec.array.ports, group, [&](unsigned bit) {
      Lanes tree{};
      for (std::size_t n = 0; n < lanes; ++n) tree[n] = trees[n].bit(bit);
      return tree;
    });
    group.finish();
  }
}

}  // namespace

bool expression_bit(const igc::Command& command, int x, int y, unsigned bit) {
  return (expression(command, x, y) >> std::min(bit, 127u) & 1) != 0;
}

void apply_words(const Spec& spec, const igc::Command& command, const std::vector<ArrayWord>& words,
                 ArrayState& state, const std::vector<std::uint32_t>* only) {
  apply_steps(spec, command, steps_of(words, spec.tree.gap_clocks), state, only);
}

void apply_steps(const Spec& spec, const igc::Command& command, const std::vector<ArrayStep>& steps, ArrayState& state,
                 const std::vector<std::uint32_t>* only) {
  std::size_t tree_bits = 0;
  int longest = 0;
  for (const ArrayStep& step : steps) tree_bits += step.bit >= 0, longest = std::max(longest, step.bit + 1);
  if (only == nullptr && longest <= 64) {
    apply_in_rows(spec, command, steps, static_cast<std::size_t>(longest), state);
    return;
  }
  std::vector<std::uint32_t> all;
  if (only == nullptr) {
    all.resize(state.enable.size());
    std::iota(all.begin(), all.end(), 0u);
  }
  apply_to(spec, command, steps, longest, tree_bits, state, only ? *only : all);
}

}  // namespace dendro::pixel_planes
