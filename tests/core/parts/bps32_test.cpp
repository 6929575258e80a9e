#include "models/parts/bps32/bps32.h"

#include <gtest/gtest.h>

#include <random>

#include "models/parts/bps32/bps32_execute.h"

namespace dendro::bps32 {
namespace {

constexpr std::uint64_t kSeed = 32;

struct NoBus {
  bool bus_busy() const { return false; }
  bool data_ready() const { return true; }
  bool vertical_blank() const { return true; }
  bool field() const { return false; }
  void start_read(std::uint32_t, unsigned) {}
  void start_write(std::uint32_t, std::uint32_t, unsigned) {}
};

void run(ProcessorState& p, const ProcessorSpec& spec) {
  NoBus port;
  for (p.running = true; p.running;) execute(p, decode(p.control[p.pc]), spec, port);
}

std::uint64_t word(std::initializer_list<std::pair<Field, unsigned>> fields) {
  std::uint64_t w = nop();
  for (const auto& [field, value] : fields) w = put(w, field, value);
  return w;
}

TEST(ControlWord, TheFieldsTileTheSixtyFourBits) {
  unsigned next = 64;
  for (const Field& f : kFields) {
    EXPECT_EQ(f.low + f.width, next) << f.name;
    next = f.low;
  }
  EXPECT_EQ(next, 0u);
}

TEST(Handlers, ASpecialisedWordDoesWhatTheGeneralOneDoes) {
  std::mt19937_64 random(kSeed);
  ProcessorSpec spec;
  ProcessorState p = power_on(spec);
  for (std::uint32_t& w : p.scratch) w = static_cast<std::uint32_t>(random());
  for (int i = 0; i < 400'000; ++i) {
    for (std::uint32_t& r : p.ram) r = static_cast<std::uint32_t>(random());
    p.q = static_cast<std::uint32_t>(random());
    const std::uint64_t bits = put(put(random(), kSeq, am2910::kCONT), kDest, i % 3 ? kRam : kYOnly);
    const Decoded d = decode(bits);
    if (d.kind != Decoded::kAlu) continue;
    ProcessorState a = p, b = p;
    d.alu(a, d);
    execute_data(b, d);
    ASSERT_TRUE(a.ram == b.ram && a.z == b.z && a.n == b.n && a.c == b.c && a.v == b.v && a.sar == b.sar &&
                a.bus_address == b.bus_address && a.write_data == b.write_data && a.scratch == b.scratch &&
                a.mul_x == b.mul_x && a.mul_y == b.mul_y)
        << std::hex << bits << " seed " << kSeed;
    p.sar = a.sar;
    p.c = a.c;
  }
}

TEST(Multiplier, TheLargestNegativeSquareIsExact) {
  ProcessorSpec spec;
  ProcessorState p = power_on(spec);
  p.mul_x = p.mul_y = 0x8000;
  p.control[0] = word({{kMul, kMulSigned}});
  p.control[1] = nop();
  p.control[2] = word({{kDsrc, kDProduct}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, 1}, {kHalt, 1}});
  run(p, spec);
  EXPECT_EQ(p.ram[1], 0x40000000u);
}

// r1:q := high:low / r2 by the steps of the data sheet; the remainder comes out in r1.
TEST(DivideSteps, ADivisionTakesThirtyFourWordsAndIsExact) {
  std::mt19937_64 random(kSeed);
  ProcessorSpec spec;
  ProcessorState p = power_on(spec);
  const auto special = [](unsigned code) {
    return word({{kFunc, kSpecial}, {kDest, code}, {kA, 2}, {kB, 1}});
  };
  p.control[0] = special(0xA);
  for (int i = 1; i <= 31; ++i) p.control[i] = special(0xC);
  p.control[32] = special(0xE);
  p.control[33] = word({{kHalt, 1}});
  for (int i = 0; i < 2000; ++i) {
    const auto divisor = static_cast<std::int32_t>(random() % 0x7FFFFFFF) + 1;
    const auto quotient = static_cast<std::int32_t>(random() % 0x40000000);
    const auto rest = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(divisor));
    const std::int64_t dividend = std::int64_t{quotient} * divisor + rest;
    p.ram[1] = static_cast<std::uint32_t>(dividend >> 32);
    p.q = static_cast<std::uint32_t>(dividend);
    p.ram[2] = static_cast<std::uint32_t>(divisor);
    p.pc = 0;
    run(p, spec);
    // A remainder of the wrong sign is put right by one more addition, as after the real part's sequence.
    auto remainder = static_cast<std::int32_t>(p.ram[1]);
    if (!p.divide_sign) remainder += divisor;
    ASSERT_EQ(static_cast<std::int32_t>(p.q), quotient) << dividend << " / " << divisor << " seed " << kSeed;
    ASSERT_EQ(remainder, rest) << dividend << " / " << divisor << " seed " << kSeed;
  }
}

}  // namespace
}  // namespace dendro::bps32
