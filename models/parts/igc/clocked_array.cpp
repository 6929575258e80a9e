#include "models/parts/igc/clocked_array.h"

namespace dendro::igc {

ClockedArray::ClockedArray(std::size_t words, unsigned memory_bits, unsigned ports)
    : ports_(ports), memory_(memory_bits, BitPlane(words)), enable_(words), carry_(words), data_(words) {}

std::uint64_t* ClockedArray::plane(bool used, unsigned address) {
  return used && address < memory_.size() ? memory_[address].data() : nullptr;
}

void ClockedArray::clock(const ArrayWord& word, const std::uint64_t* leaves) {
  const bool port_b = ports_ > 1;
  PixelClock planes;
  planes.tree = word.tree ? leaves : nullptr;
  planes.read_a = plane(word.read_a, word.address_a);
  planes.write_a = plane(word.write_a, word.address_a);
  planes.read_b = plane(port_b && word.read_b, word.address_b);
  planes.write_b = plane(port_b && word.write_b, word.address_b);
  planes.enable = enable_.data(), planes.carry = carry_.data(), planes.data = data_.data();
  planes.words = enable_.size();
  const bool nothing =
      word.function == Function::kHold && word.data == DataOp::kHold && !planes.write_a && !planes.write_b;
  if (!nothing) clock_pixels(planes, word);
}

template <class Array>
auto& ClockedArray::plane_of(Array& array, PixelPlane which, unsigned bit) {
  switch (which) {
    case PixelPlane::kEnable: return array.enable_;
    case PixelPlane::kCarry: return array.carry_;
    case PixelPlane::kData: return array.data_;
    default: return array.memory_.at(bit);
  }
}

bool ClockedArray::value(PixelPlane which, unsigned bit, std::size_t leaf) const {
  return get(plane_of(*this, which, bit), leaf);
}

void ClockedArray::set(PixelPlane which, unsigned bit, std::size_t leaf, bool value) {
  const std::uint64_t mask = std::uint64_t{1} << leaf % 64;
  std::uint64_t& word = plane_of(*this, which, bit)[leaf / 64];
  word = value ? word | mask : word & ~mask;
}

std::uint64_t ClockedArray::enabled() const {
  std::uint64_t count = 0;
  for (const std::uint64_t e : enable_) count += static_cast<std::uint64_t>(__builtin_popcountll(e));
  return count;
}

}  // namespace dendro::igc
