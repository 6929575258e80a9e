#include "models/parts/igc/clocked_planes.h"

#include <algorithm>

namespace dendro::igc {
namespace {

constexpr unsigned kChipLevels = 6;  // 64 rows: what a clock touches of them fits the host's nearest memory
constexpr std::size_t kGatheredClocks = 64;

}  // namespace

ClockedPlanes::ClockedPlanes(const PlanesSpec& spec)
    : spec_(spec),
      chip_levels_(std::min(kChipLevels, spec.levels_y)),
      tokens_(spec.levels_x, spec.levels_y, spec.masked),
      x_(spec.levels_x),
      upper_(spec.levels_y - chip_levels_, 1, x_.row_words()),
      chips_(std::size_t{1} << (spec.levels_y - chip_levels_)),
      clocks_(kGatheredClocks),
      inputs_(kGatheredClocks, BitPlane(chips_ * x_.row_words())) {
  const std::size_t row = x_.row_words();
  for (std::size_t c = 0; c < chips_; ++c)
    chip_.push_back(
        {TreeOfY(chip_levels_, 1, row), ClockedArray(row << chip_levels_, spec.memory_bits, spec.ports)});
  for (unsigned x = 0; x < 1u << spec.levels_x; ++x) leaf_in_row_.push_back(leaf_of(spec.levels_x, x, 0));
  for (Clock& clock : clocks_) clock.bits.resize(chip_levels_);
}

void ClockedPlanes::clock(const TreeLines& lines, const ArrayWord& word) {
  const std::vector<LevelBits>& bits = tokens_.clock(lines);
  const bool one_chip = chips_ == 1;
  Clock& now = clocks_[gathered_];
  now.word = word;
  std::copy(bits.end() - chip_levels_, bits.end(), now.bits.begin());
  const std::uint64_t* const into_chips = one_chip ? x_.row() : upper_.leaves();
  std::copy_n(into_chips, inputs_[gathered_].size(), inputs_[gathered_].begin());
  if (!one_chip) upper_.clock(x_.row(), bits.data() + spec_.levels_x);
  x_.clock(lines.c, bits.data());
  if (++gathered_ == kGatheredClocks) catch_up();
}

void ClockedPlanes::catch_up() {
  for (std::size_t c = 0; c < chips_; ++c) {
    for (std::size_t n = 0; n < gathered_; ++n) {
      chip_[c].pixels.clock(clocks_[n].word, chip_[c].tree.leaves());
      chip_[c].tree.clock(inputs_[n].data() + c * x_.row_words(), clocks_[n].bits.data());
    }
  }
  gathered_ = 0;
}

ClockedArray& ClockedPlanes::chip_of(unsigned x, unsigned y, std::size_t* leaf) {
  if (gathered_ > 0) catch_up();
  *leaf = leaf_in_row_[x] + (std::size_t{y & ((1u << chip_levels_) - 1)} << spec_.levels_x);
  return chip_[y >> chip_levels_].pixels;
}

bool ClockedPlanes::memory(unsigned bit, unsigned x, unsigned y) {
  std::size_t leaf = 0;
  return chip_of(x, y, &leaf).memory(bit, leaf);
}
std::uint32_t ClockedPlanes::memory_word(unsigned low, unsigned x, unsigned y) {
  std::size_t leaf = 0;
  const ClockedArray& pixels = chip_of(x, y, &leaf);
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 32 && low + i < spec_.memory_bits; ++i)
    word |= static_cast<std::uint32_t>(pixels.memory(low + i, leaf)) << i;
  return word;
}
bool ClockedPlanes::enable(unsigned x, unsigned y) {
  std::size_t leaf = 0;
  return chip_of(x, y, &leaf).enable(leaf);
}
bool ClockedPlanes::carry(unsigned x, unsigned y) {
  std::size_t leaf = 0;
  return chip_of(x, y, &leaf).carry(leaf);
}
bool ClockedPlanes::data(unsigned x, unsigned y) {
  std::size_t leaf = 0;
  return chip_of(x, y, &leaf).data(leaf);
}

std::vector<std::uint64_t> ClockedPlanes::plane(PixelPlane which, unsigned bit) {
  const std::size_t pixels = std::size_t{1} << (spec_.levels_x + spec_.levels_y);
  std::vector<std::uint64_t> plane(pixels / 64);
  for (std::size_t n = 0, leaf = 0; n < pixels; ++n) {
    const auto x = static_cast<unsigned>(n % leaf_in_row_.size()), y = static_cast<unsigned>(n / leaf_in_row_.size());
    const ClockedArray& pixels_of_chip = chip_of(x, y, &leaf);
    plane[n / 64] |= static_cast<std::uint64_t>(pixels_of_chip.value(which, bit, leaf)) << n % 64;
  }
  return plane;
}

void ClockedPlanes::set_plane(PixelPlane which, unsigned bit, const std::vector<std::uint64_t>& plane) {
  for (std::size_t n = 0, leaf = 0; n < plane.size() * 64; ++n) {
    const auto x = static_cast<unsigned>(n % leaf_in_row_.size()), y = static_cast<unsigned>(n / leaf_in_row_.size());
    chip_of(x, y, &leaf).set(which, bit, leaf, plane[n / 64] >> n % 64 & 1);
  }
}

std::uint64_t ClockedPlanes::enabled() {
  if (gathered_ > 0) catch_up();
  std::uint64_t count = 0;
  for (const Chip& c : chip_) count += c.pixels.enabled();
  return count;
}

}  // namespace dendro::igc
