#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "models/machines/sgi_4d35/boundaries.h"
#include "sim/base/error.h"
#include "sim/trace/plain_trace.h"

/// Memory traces from elsewhere on the caches of the 4D/35.
namespace dendro::sgi_4d35 {
namespace {

Spec preset() {
  Spec spec;
  spec.instruction_cache.refill_words = 8;
  spec.clock_hz = 36e6;
  spec.main_bytes = 128 << 20;
  return spec;
}

PlainReplay drive(const std::string& text, const Spec& spec = preset(), Level level = Level::kCycle) {
  trace::PlainReader reader(text, "t");
  return replay_plain(spec, level, reader);
}

std::uint64_t counter(const PlainReplay& replay, const std::string& unit, const std::string& name) {
  for (const UnitStats& stats : replay.units)
    if (stats.unit == "sgi_4d35." + unit)
      for (const auto& [key, value] : stats.values)
        if (key == name) return value;
  ADD_FAILURE() << unit << "." << name;
  return 0;
}

std::map<std::string, std::uint64_t> all(const PlainReplay& replay) {
  std::map<std::string, std::uint64_t> counters;
  for (const UnitStats& stats : replay.units)
    for (const auto& [key, value] : stats.values) counters[stats.unit + "." + key] = value;
  return counters;
}

class PlainTrace : public ::testing::TestWithParam<Level> {};

TEST_P(PlainTrace, CountsByHand) {
  // The load asks in the clock behind the fetch's, 11 + 1; memory is free in clock 18, and 14 more bring the block. What
  // comes behind is later by the 11 + 20 stalls.
  const PlainReplay replay = drive("# a comment\n100 i 0x1000\n100 r 0x2000   # another\n101 i 0x1004\n101 w 8196 1\n\n", preset(), GetParam());
  EXPECT_EQ(4, replay.accesses);
  EXPECT_EQ(1u, counter(replay, "instruction_cache", "misses"));
  EXPECT_EQ(2u, counter(replay, "instruction_cache", "busy"));
  EXPECT_EQ(1u, counter(replay, "data_cache", "misses"));
  EXPECT_EQ(2u, counter(replay, "data_cache", "busy"));
  EXPECT_EQ(11u, counter(replay, "processor", "stall_instruction_miss"));
  EXPECT_EQ(20u, counter(replay, "processor", "stall_data_miss"));
  EXPECT_EQ(1u, counter(replay, "processor", "stall_partial_store"));
  EXPECT_EQ(0u, counter(replay, "processor", "stall_write_buffer"));
  EXPECT_EQ(35, replay.cycles) << "the fetch went on in clock 11, the load and the next fetch in 32, the store in 34";
  EXPECT_EQ(3u, counter(replay, "processor", "busy"));
  EXPECT_EQ(32u, counter(replay, "memory", "busy")) << "18 and 14; the write has not begun";
}

TEST_P(PlainTrace, AFullWriteBufferHoldsUp) {
  std::string text;
  for (int i = 0; i < 6; ++i) text += fmt::format("{} w {:#x}\n", i, 0x10000 * (i + 1));
  const PlainReplay replay = drive(text, preset(), GetParam());
  // Stores of four pages fill it in clock 3; writes end in clocks 7 and 13.
  EXPECT_EQ(3u + 5u, counter(replay, "processor", "stall_write_buffer"));
  EXPECT_EQ(14, replay.cycles);
}

TEST_P(PlainTrace, DinerosLabelsAndHexadecimalAddresses) {
  const PlainReplay din = drive("2 1000\n0 2000\n2 1004\n1 0x2004\n", preset(), GetParam());
  EXPECT_EQ(all(drive("1 i 0x1000\n1 r 0x2000\n2 i 0x1004\n2 w 0x2004\n", preset(), GetParam())), all(din));
  EXPECT_EQ(all(drive("1 2 0x1000\n1 0 0x2000\n2 2 0x1004\n2 1 0x2004 4\n", preset(), GetParam())), all(din));
  EXPECT_EQ(4, din.accesses);
}

TEST_P(PlainTrace, ClocksInWhichNothingIsAskedAreIdle) {
  const PlainReplay replay = drive("7 r 0x1000\n1000 r 0x1004\n", preset(), GetParam());
  EXPECT_EQ(993 + 14 + 1, replay.cycles);
  EXPECT_EQ(2u, counter(replay, "processor", "busy"));
  EXPECT_EQ(992u, counter(replay, "processor", "idle"));
}

TEST_P(PlainTrace, AddressesBeyondMainMemoryWrapAndAreCounted) {
  const PlainReplay replay = drive("0 r 0x7fff00001000\n50 r 0x1004\n", preset(), GetParam());
  EXPECT_EQ(1u, counter(replay, "processor", "beyond_main_memory"));
  EXPECT_EQ(5u, replay.summary.size());
  EXPECT_EQ(1u, counter(replay, "data_cache", "misses")) << "0x7fff00001000 modulo 128 MB is 0x1000";
}

INSTANTIATE_TEST_SUITE_P(Levels, PlainTrace, ::testing::Values(Level::kCycle, Level::kClocked),
                         [](const auto& instance) { return std::string(level_name(instance.param)); });

/// A direct-mapped cache with a tag for every word, as a map from place to address.
class MapOfTags {
 public:
  explicit MapOfTags(const r3000_cache::Spec& spec) : spec_(spec) {}
  bool read(std::uint64_t address) {
    const bool hit = holds(address);
    const std::uint64_t block = 4 * spec_.refill_words, first = address / block * block;
    for (std::uint64_t a = first; !hit && a < first + block; a += 4) put(a);
    return hit;
  }
  bool write(std::uint64_t address, unsigned size) {
    const bool hit = holds(address);
    if (size == 4)
      put(address);
    else if (!spec_.store_partial)
      tags_.erase(place(address));
    return hit;
  }

 private:
  std::uint64_t place(std::uint64_t address) const { return address % spec_.size_bytes / 4; }
  bool holds(std::uint64_t address) const {
    const auto tag = tags_.find(place(address));
    return tag != tags_.end() && tag->second == address / 4;
  }
  void put(std::uint64_t address) { tags_[place(address)] = address / 4; }

  r3000_cache::Spec spec_;
  std::map<std::uint64_t, std::uint64_t> tags_;
};

TEST(PlainTraces, RandomOnesMissWhereAMapOfTagsDoesAndBothLevelsCountTheSameClocks) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto one_of = [&random](std::initializer_list<unsigned> choices) { return choices.begin()[random() % choices.size()]; };
    Spec spec = preset();
    for (r3000_cache::Spec* cache : {&spec.instruction_cache, &spec.data_cache}) {
      cache->size_bytes = one_of({1024, 2048, 8192});
      cache->refill_words = one_of({1, 4, 8, 16});
      cache->store_partial = random() % 2;
    }
    spec.instruction_cache.streaming = random() % 2;
    spec.bus.entries = one_of({1, 2, 4, 6});
    spec.bus.read_bypass = random() % 2;
    spec.bus.first_word_cycles = one_of({1, 6, 21});
    MapOfTags instructions(spec.instruction_cache), data(spec.data_cache);
    std::string text;
    std::uint64_t time = random() % 1000, misses[2] = {0, 0}, accesses[2] = {0, 0}, next = 0x1000;
    for (int i = 0; i < 3000; ++i) {
      time += random() % 3;
      if (random() % 8 == 0) next = random() % 0x8000;
      const unsigned kind = random() % 3, size = kind == 1 ? one_of({1, 2, 4, 4}) : 4;
      const std::uint64_t address = kind == 2 ? (next += 4) & ~3u : (random() % 0x6000) & ~(size - 1);
      text += fmt::format("{} {} {:#x} {}\n", time, "rwi"[kind], address, size);
      ++accesses[kind == 2];
      misses[kind == 2] += !(kind == 2 ? instructions.read(address) : kind == 0 ? data.read(address) : data.write(address, size));
    }
    const PlainReplay cycle = drive(text, spec);
    EXPECT_EQ(misses[0], counter(cycle, "data_cache", "misses"));
    EXPECT_EQ(misses[1], counter(cycle, "instruction_cache", "misses"));
    EXPECT_EQ(accesses[0], counter(cycle, "data_cache", "busy"));
    EXPECT_EQ(accesses[1], counter(cycle, "instruction_cache", "busy"));
    EXPECT_EQ(all(cycle), all(drive(text, spec, Level::kClocked)));
  }
}

std::string error_of(const std::string& text) {
  try {
    drive(text);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(PlainTraces, AWrongLineIsNamed) {
  const auto expect = [](const std::string& text, const std::string& wanted) {
    EXPECT_NE(std::string::npos, error_of(text).find(wanted)) << error_of(text);
  };
  expect("", "t: has no accesses");
  expect("# nothing\n\n", "t: has no accesses");
  expect("1 r 0x10\n2 x 0x10\n", "t:2: `x` is no operation: r (0), w (1) or i (2)");
  expect("1 r 0x10\n\n2 r zehn\n", "t:3: `zehn` is no address: decimal, or hexadecimal with 0x");
  expect("1 r 7f00\n", "t:1: `7f00` is no address");
  expect("1 r 0x10000000000000000\n", "t:1: `0x10000000000000000` is no address");
  expect("now r 0x10\n", "t:1: `now` is no time");
  expect("5 r 0x10\n4 r 0x10\n", "t:2: time goes back, from 5 to 4");
  expect("99999999999999999 r 0x10\n", "t:1: time 99999999999999999 is too large");
  expect("1 r 0x10 3\n", "t:1: `3` is no size: 1, 2 or 4 bytes");
  expect("1 r 0x10 4 5\n", "t:1: is not `time op address [size]`");
  expect("1 r 0x10\n1 r\n", "t:2: is not `time op address [size]`");
  expect("2 400\n2 r 0x10\n", "t:2: is not `label address`");
  expect("2 40g0\n", "t:1: `40g0` is no address: hexadecimal");
  expect("3 4000\n", "t:1: `3` is no operation");
  expect("single\n", "t:1: is not `time op address [size]`");
}

}  // namespace
}  // namespace dendro::sgi_4d35
