#include "models/parts/igc/clocked_tree.h"

#include <algorithm>

#include "models/parts/igc/clocked_kernels.h"
#include "models/parts/igc/igc_isa.h"
#include "sim/base/check.h"

namespace dendro::igc {
namespace {

constexpr unsigned kWordLevels = 6;  // from this level on nodes fill whole words of 64

}  // namespace

TreeFeed::TreeFeed(unsigned skew_a, unsigned skew_b, unsigned gap) : gap_(gap), delay_a_(skew_a), delay_b_(skew_b) {}

void TreeFeed::start(std::int64_t a, std::int64_t b, std::int64_t c) {
  a_ = a, b_ = b, c_ = c;
  position_ = 0;
  ++stream_;
}

TreeFeed::Bit TreeFeed::through(std::vector<Bit>& delay, std::size_t& at, Bit in) {
  if (delay.empty()) return in;
  const Bit out = delay[at];
  delay[at] = in;
  at = (at + 1) % delay.size();
  return out;
}

TreeLines TreeFeed::clock() {
  const bool zero = position_ < gap_ || stream_ == 0;
  const std::uint32_t k = zero ? 0 : std::min<std::uint32_t>(position_ - gap_, kStreamBits - 1);
  const auto bit = [&](std::int64_t coefficient) { return !zero && (coefficient >> k & 1) != 0; };
  const Bit a = through(delay_a_, at_a_, {bit(a_), stream_});
  const Bit b = through(delay_b_, at_b_, {bit(b_), stream_});
  TreeLines lines;
  lines.a = a.value, lines.a_stream = a.stream;
  lines.b = b.value, lines.b_stream = b.stream;
  lines.c = bit(c_), lines.c_stream = stream_;
  lines.clear = position_ <= gap_;
  if (position_ < gap_ + kStreamBits) ++position_;
  return lines;
}

ClockedTree::ClockedTree(unsigned levels_x, unsigned levels_y, bool masked)
    : levels_x_(levels_x), levels_y_(levels_y), masked_(masked) {
  const unsigned levels = levels_x + levels_y;
  DENDRO_CHECK(levels >= kWordLevels && levels < 32, "{} levels", levels);
  for (unsigned l = 0; l <= levels; ++l) {
    const std::size_t words = l < kWordLevels ? 1 : std::size_t{1} << (l - kWordLevels);
    outputs_.emplace_back(words);
    if (l < levels) carries_.emplace_back(words);
  }
  streams_.resize(levels);
  clears_.resize(levels);
}

void ClockedTree::clock(const TreeLines& lines) {
  outputs_[0][0] = lines.c;
  streams_[0] = lines.c_stream;
  clears_[0] = lines.clear;
  // From the leaves up, so that every level still sees its inputs of before this clock.
  for (unsigned l = levels_x_ + levels_y_; l-- > 0;) {
    const bool of_x = l < levels_x_;
    const bool same = streams_[l] == (of_x ? lines.a_stream : lines.b_stream);
    const bool coefficient = (of_x ? lines.a : lines.b) && (same || !masked_);
    if (l < kWordLevels) {
      clock_small(l, coefficient, clears_[l]);
    } else {
      std::uint64_t* const out = outputs_[l + 1].data();
      const std::size_t words = outputs_[l].size();
      clock_level({outputs_[l].data(), out, out + words, carries_[l].data(), words, coefficient, clears_[l]});
    }
    if (l > 0) {
      streams_[l] = streams_[l - 1];
      clears_[l] = clears_[l - 1];
    }
  }
}

void ClockedTree::clock_small(unsigned level, bool coefficient, bool clear) {
  const unsigned nodes = 1u << level;
  const std::uint64_t mask = (std::uint64_t{1} << nodes) - 1;
  const std::uint64_t in = outputs_[level][0], ones = coefficient ? mask : 0;
  const std::uint64_t carry = clear ? 0 : carries_[level][0];
  outputs_[level + 1][0] = in | (in ^ carry ^ ones) << nodes;
  carries_[level][0] = (in & carry) | (in & ones) | (carry & ones);
}

std::size_t ClockedTree::leaf_of(unsigned x, unsigned y) const {
  std::size_t leaf = 0;
  for (unsigned l = 0; l < levels_x_; ++l) leaf |= std::size_t{x >> (levels_x_ - 1 - l) & 1} << l;
  for (unsigned l = 0; l < levels_y_; ++l) leaf |= std::size_t{y >> (levels_y_ - 1 - l) & 1} << (levels_x_ + l);
  return leaf;
}

}  // namespace dendro::igc
