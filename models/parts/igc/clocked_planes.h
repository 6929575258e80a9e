#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "models/parts/igc/clocked_array.h"
#include "models/parts/igc/clocked_tree.h"

namespace dendro::igc {

struct PlanesSpec {
  unsigned levels_x = 9, levels_y = 9;
  unsigned memory_bits = 72, ports = 1;
  bool masked = true;
};

/// Tree and pixels of a whole machine. Nothing of them goes back to the controller, so clocks are gathered
/// and then worked out a chip at a time: a chip is the lower levels of Y above some rows, and these rows'
/// pixels.
class ClockedPlanes {
 public:
  explicit ClockedPlanes(const PlanesSpec& spec);

  /// One clock: `lines` enter the tree, all pixels obey `word` with the bits that the tree gives them in this
  /// clock.
  void clock(const TreeLines& lines, const ArrayWord& word);

  /// State after all clocks so far.
  bool memory(unsigned bit, unsigned x, unsigned y);
  /// Bits low to low + 31 of a pixel; those beyond the memory are 0.
  std::uint32_t memory_word(unsigned low, unsigned x, unsigned y);
  bool enable(unsigned x, unsigned y);
  bool carry(unsigned x, unsigned y);
  bool data(unsigned x, unsigned y);
  std::uint64_t enabled();  ///< pixels whose E is set
  /// A plane of all pixels: pixel y * width + x is bit n % 64 of word n / 64. `bit`: of the memory.
  std::vector<std::uint64_t> plane(PixelPlane which, unsigned bit);
  void set_plane(PixelPlane which, unsigned bit, const std::vector<std::uint64_t>& plane);

 private:
  struct Chip {
    TreeOfY tree;
    ClockedArray pixels;
  };
  struct Clock {
    ArrayWord word;
    std::vector<LevelBits> bits;  ///< of the chips' levels
  };
  void catch_up();
  /// Up to date, with the place of the pixel among its leaves.
  ClockedArray& chip_of(unsigned x, unsigned y, std::size_t* leaf);

  PlanesSpec spec_;
  unsigned chip_levels_;
  TreeTokens tokens_;
  TreeOfX x_;
  TreeOfY upper_;
  std::size_t chips_;
  std::vector<std::size_t> leaf_in_row_;  ///< by x
  std::vector<Chip> chip_;
  std::vector<Clock> clocks_;
  std::vector<BitPlane> inputs_;  ///< by gathered clock: a row for each chip
  std::size_t gathered_ = 0;
};

}  // namespace dendro::igc
