#include "models/parts/igc/clocked_tree.h"

#include <algorithm>

#include "models/parts/igc/igc_isa.h"
#include "sim/base/check.h"

namespace dendro::igc {
namespace {

constexpr unsigned kWordLevels = 6;  // from this level on nodes fill whole words of 64

}  // namespace

TreeFeed::TreeFeed(unsigned skew_a, unsigned skew_b, unsigned gap)
    : gap_(gap), delay_a_(skew_a), delay_b_(skew_b) {}

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

TreeTokens::TreeTokens(unsigned levels_x, unsigned levels_y, bool masked)
    : levels_x_(levels_x),
      masked_(masked),
      streams_(levels_x + levels_y),
      clears_(levels_x + levels_y),
      bits_(levels_x + levels_y) {}

const std::vector<LevelBits>& TreeTokens::clock(const TreeLines& lines) {
  streams_[0] = lines.c_stream;
  clears_[0] = lines.clear;
  // From the leaves up: a token is seen by its level before it moves on.
  for (std::size_t l = bits_.size(); l-- > 0;) {
    const bool of_x = l < levels_x_;
    const bool same = streams_[l] == (of_x ? lines.a_stream : lines.b_stream);
    bits_[l] = {(of_x ? lines.a : lines.b) && (same || !masked_), clears_[l]};
    if (l > 0) {
      streams_[l] = streams_[l - 1];
      clears_[l] = clears_[l - 1];
    }
  }
  return bits_;
}

TreeOfX::TreeOfX(unsigned levels) {
  DENDRO_CHECK(levels >= kWordLevels, "{} levels", levels);
  for (unsigned l = 0; l <= levels; ++l) {
    const std::size_t words = l < kWordLevels ? 1 : std::size_t{1} << (l - kWordLevels);
    outputs_.emplace_back(words);
    if (l < levels) carries_.emplace_back(words);
  }
}

void TreeOfX::clock(bool c, const LevelBits* bits) {
  outputs_[0][0] = c;
  // From the leaves up, so that every level still sees its inputs of before this clock.
  for (std::size_t l = carries_.size(); l-- > 0;) {
    const BitPlane& in = outputs_[l];
    BitPlane &out = outputs_[l + 1], &kept = carries_[l];
    const std::uint64_t coefficient = bits[l].coefficient ? ~std::uint64_t{0} : 0;
    for (std::size_t w = 0; w < in.size(); ++w) {
      const std::uint64_t carry = bits[l].clear ? 0 : kept[w];
      std::uint64_t sum = in[w] ^ carry ^ coefficient;
      kept[w] = (in[w] & carry) | ((in[w] | carry) & coefficient);
      if (l < kWordLevels) {
        const unsigned nodes = 1u << l;
        sum &= (std::uint64_t{1} << nodes) - 1;
        out[0] = in[0] | sum << nodes;
      } else {
        out[w] = in[w];
        out[in.size() + w] = sum;
      }
    }
  }
}

TreeOfY::TreeOfY(unsigned levels, std::size_t rows, std::size_t row_words)
    : rows_(rows), row_words_(row_words) {
  for (unsigned l = 0; l < levels; ++l) {
    carries_.emplace_back(row_words * rows << l);
    outputs_.emplace_back(row_words * rows << (l + 1));
  }
}

void TreeOfY::clock(const std::uint64_t* input, const LevelBits* bits) {
  for (std::size_t l = carries_.size(); l-- > 0;) {
    const std::uint64_t* const in = l == 0 ? input : outputs_[l - 1].data();
    clock_level({in, outputs_[l].data(), carries_[l].data(), rows_ << l, row_words_, bits[l].coefficient,
                 bits[l].clear});
  }
}

std::size_t leaf_of(unsigned levels_x, unsigned x, unsigned y) {
  std::size_t leaf = std::size_t{y} << levels_x;
  for (unsigned l = 0; l < levels_x; ++l) leaf |= std::size_t{x >> (levels_x - 1 - l) & 1} << l;
  return leaf;
}

ClockedTree::ClockedTree(unsigned levels_x, unsigned levels_y, bool masked)
    : levels_x_(levels_x),
      tokens_(levels_x, levels_y, masked),
      x_(levels_x),
      y_(levels_y, 1, x_.row_words()),
      words_(x_.row_words() << levels_y) {}

void ClockedTree::clock(const TreeLines& lines) {
  const std::vector<LevelBits>& bits = tokens_.clock(lines);
  y_.clock(x_.row(), bits.data() + levels_x_);
  x_.clock(lines.c, bits.data());
}

}  // namespace dendro::igc
