#include <gtest/gtest.h>

#include <random>

#include "models/parts/igc/clocked_planes.h"

namespace dendro::igc {
namespace {

ArrayWord random_word(std::mt19937_64& random, unsigned memory_bits) {
  ArrayWord w;
  w.function = static_cast<Function>(random() % static_cast<unsigned>(Function::kCount));
  w.x = static_cast<Operand>(random() % static_cast<unsigned>(Operand::kCount));
  w.y = static_cast<Operand>(random() % static_cast<unsigned>(Operand::kCount));
  w.data = static_cast<DataOp>(random() % static_cast<unsigned>(DataOp::kCount));
  w.source = static_cast<Source>(random() % static_cast<unsigned>(Source::kCount));
  const std::uint64_t r = random();
  w.read_a = r & 1, w.write_a = r & 2, w.read_b = r & 4, w.write_b = r & 8, w.tree = r & 0x30;
  w.address_a = static_cast<std::uint8_t>(random() % (memory_bits + 2));
  w.address_b = static_cast<std::uint8_t>(random() % (memory_bits + 2));
  return w;
}

void compare(const PlanesSpec& spec, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  ClockedPlanes planes(spec);
  ClockedTree tree(spec.levels_x, spec.levels_y, spec.masked);
  ClockedArray array(tree.words(), spec.memory_bits, spec.ports);
  TreeFeed feed(spec.levels_x - 1, spec.levels_x + spec.levels_y - 1, 2);
  for (int n = 0; n < 333; ++n) {
    if (random() % 20 == 0)
      feed.start(static_cast<std::int64_t>(random()) >> 40, static_cast<std::int64_t>(random()) >> 40,
                 static_cast<std::int64_t>(random()) >> 40);
    const TreeLines lines = feed.clock();
    const ArrayWord word = random_word(random, spec.memory_bits);
    planes.clock(lines, word);
    array.clock(word, tree.leaves());
    tree.clock(lines);
    if (random() % 50 != 0 && n != 332) continue;
    for (unsigned y = 0; y < 1u << spec.levels_y; ++y)
      for (unsigned x = 0; x < 1u << spec.levels_x; ++x) {
        const std::size_t leaf = leaf_of(spec.levels_x, x, y);
        ASSERT_EQ(planes.enable(x, y), array.enable(leaf)) << "seed " << seed << " clock " << n;
        ASSERT_EQ(planes.carry(x, y), array.carry(leaf)) << "seed " << seed << " clock " << n;
        ASSERT_EQ(planes.data(x, y), array.data(leaf)) << "seed " << seed << " clock " << n;
        for (unsigned bit = 0; bit < spec.memory_bits; ++bit)
          ASSERT_EQ(planes.memory(bit, x, y), array.memory(bit, leaf)) << "seed " << seed << " clock " << n;
      }
    ASSERT_EQ(planes.enabled(), array.enabled());
  }
}

TEST(ClockedPlanes, ChipsWithGatheredClocksAreEqualToOneTreeAndArrayClockByClock) {
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    compare({6, 6, 8, 1, true}, seed);
    compare({6, 7, 8, 2, false}, seed);
    compare({7, 8, 8, 2, true}, seed);
  }
}

}  // namespace
}  // namespace dendro::igc
