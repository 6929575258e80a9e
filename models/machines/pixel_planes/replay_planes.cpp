#include "models/machines/pixel_planes/replay_planes.h"

#include <algorithm>

#include "sim/trace/digest.h"

namespace dendro::pixel_planes {

using trace::Record;

void PlaneRecords::set(const Record& record, std::size_t first, Plane& plane) const {
  const auto words = static_cast<std::int64_t>(plane.size());
  const std::int64_t at = replayer.within(record, "word", record.value(first), 0, words - 1);
  const std::int64_t count = replayer.within(record, "count", record.key("count", 1), 1, words - at);
  std::fill_n(plane.begin() + at, count, record.values[first + 1].value);
}

unsigned PlaneRecords::bit_of(const Record& record) const {
  return static_cast<unsigned>(replayer.within(record, "bit", record.value(0), 0, spec.array.memory_bits - 1));
}

std::size_t PlaneRecords::pixel_of(const Record& record) const {
  return static_cast<std::size_t>(replayer.within(record, "pixel", record.value(0), 0, spec.pixels() - 1));
}

void PlaneRecords::expect_pixel(const Record& record, const std::function<Plane(unsigned bit)>& memory) const {
  const std::size_t pixel = pixel_of(record);
  const auto bits = static_cast<unsigned>(spec.array.memory_bits);
  const auto low = static_cast<unsigned>(replayer.within(record, "bit", record.value(1), 0, bits - 1));
  std::uint64_t word = 0;
  for (unsigned bit = low; bit < std::min(low + 32, bits); ++bit) word |= std::uint64_t{bit_at(memory(bit), pixel)} << (bit - low);
  const auto width = static_cast<std::size_t>(spec.array.width);
  replayer.expect_data(record, word, fmt::format("pixel {} (x {}, y {}), bits {} and up,", pixel, pixel % width, pixel / width, low));
}

void PlaneRecords::expect_plane(const Record& record, const Plane& plane) const {
  replayer.expect_key(record, "ones", ones_of(plane), fmt::format("pixels in which bit {} is 1:", record.value(0)));
  expect_digest(record, "digest", trace::digest(plane), fmt::format("the digest of bit {}", record.value(0)));
}

void PlaneRecords::expect_digest(const Record& record, const char* key, std::uint64_t got, const std::string& what) const {
  const std::optional<std::int64_t> said = record.expected(key);
  if (said && static_cast<std::uint64_t>(*said) != got)
    replayer.differ(record, fmt::format("{} is 0x{:x}, the trace says 0x{:x}", what, got, static_cast<std::uint64_t>(*said)));
}

std::vector<Plane> memory_of(const Spec& spec, const std::function<Plane(unsigned bit)>& plane) {
  std::vector<Plane> memory;
  for (int bit = 0; bit < spec.array.memory_bits; ++bit) memory.push_back(plane(static_cast<unsigned>(bit)));
  return memory;
}

}  // namespace dendro::pixel_planes
