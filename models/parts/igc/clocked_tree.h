#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The tree of nodes that gives every pixel A x + B y + C, clock by clock, and the lines that feed it. Time is counted in
/// clocks that are not stolen.
namespace dendro::igc {

/// What enters the tree in a clock.
struct TreeLines {
  bool a = false, b = false, c = false;
  /// Number of the stream that a line's bit belongs to; a different one for all streams within the tree.
  std::uint32_t a_stream = 0, b_stream = 0, c_stream = 0;
  bool clear = false;  ///< with C's bit: the carries are 0 before it
};

/// Makes the lines' bits from coefficients: C at once, A and B behind it by their skews. Before the first stream: zeros.
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

/// A binary tree of levels_x + levels_y levels. Each node has two children: the left one is its input one clock later, the
/// right one the sum of input and coefficient, one clock later, with the carry kept in the node. Levels of X come
/// first and take the A line, then those of Y with the B line; each axis begins with its highest address bit.
///
/// With `masked` a level takes its line's bit only while the line is in the same stream as its own inputs.
class ClockedTree {
 public:
  ClockedTree(unsigned levels_x, unsigned levels_y, bool masked);

  void clock(const TreeLines& lines);

  /// The outputs that were there before the next clock(): one bit a pixel, at leaf_of().
  const std::uint64_t* leaves() const { return outputs_.back().data(); }
  std::size_t words() const { return outputs_.back().size(); }
  /// Where a pixel's bit stands among the leaves: bit n % 64 of word n / 64. A level's node has its children at its own
  /// number and at that plus the level's number of nodes, so addresses come out bit-reversed.
  std::size_t leaf_of(unsigned x, unsigned y) const;

 private:
  void clock_small(unsigned level, bool coefficient, bool clear);

  unsigned levels_x_, levels_y_;
  bool masked_;
  std::vector<std::vector<std::uint64_t>> outputs_;  ///< [l]: inputs of level l, 2^l bits; the last: leaves
  std::vector<std::vector<std::uint64_t>> carries_;  ///< of level l's nodes
  std::vector<std::uint32_t> streams_;               ///< of the inputs of level l
  std::vector<bool> clears_;
};

}  // namespace dendro::igc
