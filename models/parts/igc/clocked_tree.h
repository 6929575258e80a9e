#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "models/parts/igc/clocked_kernels.h"

/// The tree of nodes that gives every pixel A x + B y + C, clock by clock, and the lines that feed it. Time
/// is counted in clocks that are not stolen.
///
/// A node has two children: the left one is its input one clock later, the right one the sum of input and
/// coefficient, one clock later, with the carry kept in the node. Levels of X come first and take the A line,
/// then those of Y with the B line; each axis begins with its highest address bit.
namespace dendro::igc {

/// What enters the tree in a clock.
struct TreeLines {
  bool a = false, b = false, c = false;
  /// Number of the stream that a line's bit belongs to.
  std::uint32_t a_stream = 0, b_stream = 0, c_stream = 0;
  bool clear = false;  ///< with C's bit: the carries are 0 before it
};

/// Makes the lines' bits from coefficients: C at once, A and B behind it by their skews. Before the first
/// stream: zeros.
class TreeFeed {
 public:
  /// Skews in clocks; `gap`: leading zeros of every stream.
  TreeFeed(unsigned skew_a, unsigned skew_b, unsigned gap);

  /// The next clock() gives the first bit (or leading zero) of a new stream.
  void start(std::int64_t a, std::int64_t b, std::int64_t c);
  TreeLines clock();

 private:
  struct Bit {
    bool value = false;
    std::uint32_t stream = 0;
  };
  static Bit through(std::vector<Bit>& delay, std::size_t& at, Bit in);

  unsigned gap_;
  std::int64_t a_ = 0, b_ = 0, c_ = 0;
  std::uint32_t stream_ = 0;
  std::uint32_t position_ = 0;  ///< of the stream's next bit, leading zeros included
  std::vector<Bit> delay_a_, delay_b_;
  std::size_t at_a_ = 0, at_b_ = 0;
};

/// What all nodes of a level get in a clock.
struct LevelBits {
  bool coefficient = false, clear = false;
};

/// The tokens that go down the tree with a stream. With `masked` a level takes its line's bit only while the
/// line is in the same stream as the level's own inputs.
class TreeTokens {
 public:
  TreeTokens(unsigned levels_x, unsigned levels_y, bool masked);

  /// By level, good until the next call.
  const std::vector<LevelBits>& clock(const TreeLines& lines);

 private:
  unsigned levels_x_;
  bool masked_;
  std::vector<std::uint32_t> streams_;
  std::vector<bool> clears_;
  std::vector<LevelBits> bits_;
};

/// The nodes of X. A level's node has its children at its own number and at that plus the level's number of
/// nodes, so pixel x comes out at its address with the bits reversed.
class TreeOfX {
 public:
  explicit TreeOfX(unsigned levels);

  void clock(bool c, const LevelBits* bits);
  /// Outputs of before the next clock().
  const std::uint64_t* row() const { return outputs_.back().data(); }
  std::size_t row_words() const { return outputs_.back().size(); }

 private:
  std::vector<BitPlane> outputs_;  ///< [l]: inputs of level l, 2^l bits; the last: the row
  std::vector<BitPlane> carries_;
};

/// Levels of Y below a row of nodes: 2^levels rows for every row that goes in, in order of y.
class TreeOfY {
 public:
  TreeOfY(unsigned levels, std::size_t rows, std::size_t row_words);

  /// `input`: outputs of the level above, of before this clock.
  void clock(const std::uint64_t* input, const LevelBits* bits);
  /// Outputs of before the next clock(). At least one level.
  const std::uint64_t* leaves() const { return outputs_.back().data(); }

 private:
  std::size_t rows_, row_words_;
  std::vector<BitPlane> outputs_, carries_;  ///< of level l
};

/// Where a pixel's bit stands among the leaves: bit n % 64 of word n / 64.
std::size_t leaf_of(unsigned levels_x, unsigned x, unsigned y);

/// A whole tree.
class ClockedTree {
 public:
  ClockedTree(unsigned levels_x, unsigned levels_y, bool masked);

  void clock(const TreeLines& lines);
  /// The outputs that were there before the next clock(): one bit a pixel, at leaf_of().
  const std::uint64_t* leaves() const { return y_.leaves(); }
  std::size_t words() const { return words_; }

 private:
  unsigned levels_x_;
  TreeTokens tokens_;
  TreeOfX x_;
  TreeOfY y_;
  std::size_t words_;
};

}  // namespace dendro::igc
