#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "models/parts/igc/clocked_array.h"
#include "models/parts/igc/clocked_kernels.h"

namespace dendro::igc {
namespace {

/// One pixel as the data sheet's four steps tell it, with plain bits.
struct Pixel {
  bool e = false, c = false, d = false;
  std::vector<bool> m;

  bool at(bool used, unsigned address) const { return used && address < m.size() && m[address]; }

  void clock(const ArrayWord& w, bool leaf, unsigned ports) {
    const bool t = w.tree && leaf;
    const bool a = at(w.read_a, w.address_a), b = at(ports > 1 && w.read_b, w.address_b);
    const auto operand = [&](Operand o) {
      switch (o) {
        case Operand::kOne:
          return true;
        case Operand::kTree:
          return t;
        case Operand::kPortA:
          return a;
        case Operand::kPortB:
          return b;
        case Operand::kData:
          return d;
        default:
          return false;
      }
    };
    const bool x = operand(w.x), y = operand(w.y);
    const int sum = x + y + c, difference = x - y - c;
    const bool source = w.source == Source::kX             ? x
                        : w.source == Source::kXOrData     ? (x || d)
                        : w.source == Source::kXAndNotData ? (x && !d)
                        : w.source == Source::kSum         ? (sum % 2 != 0)
                                                           : t;
    Pixel next = *this;
    switch (w.function) {
      case Function::kSetEnable:
        next.e = true;
        break;
      case Function::kAndCarry:
        next.e = e && c;
        break;
      case Function::kAndNotCarry:
        next.e = e && !c;
        break;
      case Function::kLoad:
        next.c = x;
        break;
      case Function::kBorrow:
        next.c = difference < 0;
        break;
      case Function::kCarry:
        next.c = sum >= 2;
        break;
      case Function::kEqual:
        next.c = c && x == y;
        break;
      default:
        break;
    }
    switch (w.data) {
      case DataOp::kClear:
        next.d = false;
        break;
      case DataOp::kTree:
        next.d = t;
        break;
      case DataOp::kOrTree:
        next.d = d || t;
        break;
      case DataOp::kPortA:
        next.d = a;
        break;
      default:
        break;
    }
    if (e && w.write_a && w.address_a < m.size()) next.m[w.address_a] = source;
    if (e && ports > 1 && w.write_b && w.address_b < m.size()) next.m[w.address_b] = source;
    *this = next;
  }
};

class Pair {
 public:
  Pair(std::size_t words, unsigned bits, unsigned ports)
      : ports_(ports), leaves_(words), array_(words, bits, ports), pixels_(words * 64) {
    for (Pixel& p : pixels_) p.m.resize(bits);
  }

  void clock(const ArrayWord& w, std::mt19937_64& random) {
    for (std::uint64_t& l : leaves_) l = random();
    array_.clock(w, leaves_.data());
    for (std::size_t p = 0; p < pixels_.size(); ++p)
      pixels_[p].clock(w, leaves_[p / 64] >> p % 64 & 1, ports_);
  }
  /// Fills E, C, D and the memory with noise, by words of the array itself.
  void stir(std::mt19937_64& random) {
    ArrayWord w;
    w.tree = true;
    w.function = Function::kSetEnable;
    clock(w, random);
    for (unsigned bit = 0; bit < array_.memory_bits(); ++bit) {
      ArrayWord write;
      write.tree = write.write_a = true;
      write.x = Operand::kTree;
      write.address_a = static_cast<std::uint8_t>(bit);
      clock(write, random);
    }
    ArrayWord load;
    load.tree = true;
    load.x = Operand::kTree;
    load.function = Function::kLoad;
    load.data = DataOp::kTree;
    clock(load, random);
    ArrayWord mask;
    mask.function = Function::kAndCarry;
    clock(mask, random);
    load.data = DataOp::kHold;
    clock(load, random);
  }
  std::uint64_t differences() const {
    std::uint64_t count = 0;
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      const Pixel& q = pixels_[p];
      count += q.e != array_.enable(p);
      count += q.c != array_.carry(p);
      count += q.d != array_.data(p);
      for (unsigned bit = 0; bit < array_.memory_bits(); ++bit) count += q.m[bit] != array_.memory(bit, p);
    }
    return count;
  }

 private:
  unsigned ports_;
  std::vector<std::uint64_t> leaves_;
  ClockedArray array_;
  std::vector<Pixel> pixels_;
};

// 128 pixels hold all 32 states of (E, C, D, a, t) and more; a word has 8 x 7 x 7 x 5 x 5 forms.
TEST(ClockedArray, EveryWordDoesInEveryStateWhatTheFourStepsSay) {
  std::mt19937_64 random(11);
  for (unsigned ports : {1u, 2u}) {
    Pair pair(2, 8, ports);
    int done = 0;
    for (unsigned f = 0; f < static_cast<unsigned>(Function::kCount); ++f)
      for (unsigned x = 0; x < static_cast<unsigned>(Operand::kCount); ++x)
        for (unsigned y = 0; y < static_cast<unsigned>(Operand::kCount); ++y)
          for (unsigned d = 0; d < static_cast<unsigned>(DataOp::kCount); ++d)
            for (unsigned s = 0; s < static_cast<unsigned>(Source::kCount); ++s) {
              ArrayWord w;
              w.function = static_cast<Function>(f);
              w.x = static_cast<Operand>(x), w.y = static_cast<Operand>(y);
              w.data = static_cast<DataOp>(d);
              w.source = static_cast<Source>(s);
              const std::uint64_t r = random();
              w.read_a = r & 1, w.write_a = r & 2, w.read_b = r & 4, w.write_b = r & 8, w.tree = r & 16;
              w.address_a = r >> 8 & 7, w.address_b = r >> 16 & 7;
              if (done++ % 16 == 0) pair.stir(random);
              pair.clock(w, random);
              ASSERT_EQ(pair.differences(), 0u) << "function " << f << " x " << x << " y " << y << " data "
                                                << d << " source " << s << " r " << r << " ports " << ports;
            }
  }
}

TEST(ClockedArray, AddressesBeyondTheMemoryReadZeroAndIgnoreWrites) {
  std::mt19937_64 random(12);
  Pair pair(4, 8, 2);
  pair.stir(random);
  for (int i = 0; i < 300; ++i) {
    ArrayWord w;
    w.read_a = w.write_a = w.read_b = w.write_b = true;
    w.address_a = static_cast<std::uint8_t>(random()), w.address_b = static_cast<std::uint8_t>(random());
    w.x = Operand::kPortA, w.y = Operand::kPortB;
    w.function = Function::kBorrow;
    w.source = Source::kSum;
    pair.clock(w, random);
    ASSERT_EQ(pair.differences(), 0u);
  }
}

TEST(ClockedArray, ArraysThatAreNoWholeNumberOfBlocksOrVectorsAreWorkedOnToTheirEnd) {
  std::mt19937_64 random(13);
  for (const std::size_t words : {1u, 3u, 7u, 255u, 257u, 515u}) {
    Pair pair(words, 8, 2);
    pair.stir(random);
    for (int i = 0; i < 20; ++i) {
      ArrayWord w;
      w.read_a = w.write_a = true;
      w.address_a = random() % 8;
      w.tree = true;
      w.x = Operand::kTree, w.y = Operand::kPortA;
      w.function = i % 2 ? Function::kBorrow : Function::kCarry;
      w.source = Source::kSum;
      w.data = DataOp::kOrTree;
      pair.clock(w, random);
    }
    EXPECT_EQ(pair.differences(), 0u) << words;
  }
}

}  // namespace
}  // namespace dendro::igc
