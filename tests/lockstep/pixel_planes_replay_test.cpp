#include <gtest/gtest.h>

#include <cstdlib>

#include "models/machines/pixel_planes/boundaries.h"
#include "models/machines/pixel_planes/clocked_array_side.h"
#include "models/machines/pixel_planes/cycle.h"
#include "models/machines/pixel_planes/cycle_array.h"
#include "tests/lockstep/pixel_planes_lockstep.h"

/// Records random machines that are sent random commands, and replays each boundary alone at both levels.
namespace dendro::pixel_planes {
namespace {

struct Window {
  std::int64_t from = 0, to = INT64_MAX;
};

struct Recorded {
  std::string bytes;
  std::int64_t records = 0, end = 0;
};

Recorded record(const Scenario& scenario, const char* boundary, const Window& window) {
  trace::Writer writer(boundary, window.from, window.to, false);
  MachineOptions options = scenario.options;
  options.recorder = &writer;
  CycleMachine machine(scenario.spec, options);
  std::vector<std::int64_t> seen;
  machine.run([&](HostPort& host) { scenario.program(host, seen); });
  trace::Header header;
  header.machine = "pixel-planes";
  header.boundary = boundary;
  Recorded recorded;
  recorded.records = writer.records();
  recorded.end = machine.cycles();
  recorded.bytes = writer.file(header);
  return recorded;
}

trace::ReplayResult replay_of(const Spec& spec, const std::string& bytes, Level level) {
  trace::Reader reader(bytes, "trace");
  for (const trace::Boundary& boundary : boundaries())
    if (boundary.name == reader.header().boundary) reader.expect(boundary);
  return replay(spec, level, reader);
}

void expect_no_difference(const Spec& spec, const Recorded& recorded) {
  for (const Level level : {Level::kCycle, Level::kClocked}) {
    SCOPED_TRACE(level_name(level));
    const trace::ReplayResult result = replay_of(spec, recorded.bytes, level);
    ASSERT_EQ("", result.difference.value_or(""));
    ASSERT_EQ(recorded.records, result.transactions);
  }
}

void for_seeds(std::uint64_t salt, std::uint64_t count, const std::function<void(std::uint64_t)>& test) {
  const char* const one = std::getenv("DENDRO_SEED");
  const std::uint64_t first = one ? std::strtoull(one, nullptr, 10) : salt;
  for (std::uint64_t seed = first; seed < first + (one ? 1 : count); ++seed) {
    SCOPED_TRACE("repeat with DENDRO_SEED=" + std::to_string(seed));
    test(seed);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(RandomPixelPlanesReplay, WhatPassesABoundaryIsWhatItsUnitDoesAlone) {
  std::int64_t records = 0;
  for_seeds(31000, 60, [&](std::uint64_t seed) {
    const Scenario scenario = random_programs(seed);
    for (const char* boundary : {kCommandsBoundary, kArrayBoundary}) {
      SCOPED_TRACE(boundary);
      const Recorded recorded = record(scenario, boundary, {});
      records += recorded.records;
      if (recorded.records > 0) expect_no_difference(scenario.spec, recorded);
    }
  });
  EXPECT_GT(records, 100);
}

TEST(RandomPixelPlanesReplay, SoItIsFromTheMiddleOfARun) {
  int windows = 0;
  for_seeds(710000, 120, [&](std::uint64_t seed) {
    const Scenario scenario = random_programs(seed);
    std::mt19937_64 random(seed);
    const std::int64_t end = record(scenario, kCommandsBoundary, {}).end;
    Window window;
    window.from = 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    window.to = window.from + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    for (const char* boundary : {kCommandsBoundary, kArrayBoundary}) {
      SCOPED_TRACE(std::string(boundary) + " from " + std::to_string(window.from) + " to " + std::to_string(window.to));
      const Recorded recorded = record(scenario, boundary, window);
      if (recorded.records == 0) continue;
      ++windows;
      expect_no_difference(scenario.spec, recorded);
    }
  });
  if (std::getenv("DENDRO_SEED") == nullptr) {
    EXPECT_GT(windows, 60);
  }
}

TEST(RandomPixelPlanesReplay, ADamagedMemoryIsSeen) {
  for_seeds(31000, 20, [&](std::uint64_t seed) {
    const Scenario scenario = random_programs(seed);
    Spec fewer = scenario.spec;
    fewer.array.memory_bits -= 1;  // the digest is of all bits
    for (const char* boundary : {kCommandsBoundary, kArrayBoundary}) {
      const Recorded recorded = record(scenario, boundary, {});
      if (recorded.records == 0) continue;
      for (const Level level : {Level::kCycle, Level::kClocked})
        ASSERT_TRUE(replay_of(fewer, recorded.bytes, level).difference.has_value()) << boundary;
    }
  });
}

igc::ArrayWord random_word(std::mt19937_64& random, const Spec& spec) {
  const auto any = [&](auto count) { return static_cast<decltype(count)>(random() % static_cast<unsigned>(count)); };
  igc::ArrayWord w;
  w.function = any(igc::Function::kCount), w.data = any(igc::DataOp::kCount), w.source = any(igc::Source::kCount);
  do w.x = any(igc::Operand::kCount), w.y = any(igc::Operand::kCount);
  while (w.x == igc::Operand::kConstant || w.y == igc::Operand::kConstant);
  const auto address = [&] { return static_cast<std::uint8_t>(random() % static_cast<unsigned>(spec.array.memory_bits + 2)); };
  w.address_a = address(), w.address_b = address();
  w.read_a = random() & 1, w.write_a = random() & 1, w.read_b = random() & 1, w.write_b = random() & 1;
  w.tree = random() % 4 != 0;
  return w;
}

/// Both array models, a clock at a time.
class BothArrays {
 public:
  explicit BothArrays(const Spec& spec) : cycle_(spec), thieves_(spec), clocked_(spec) {}

  bool next_is_stolen() { return stolen_ = thieves_.steal(now_) != ClockedCause::kBusy; }
  void start(std::int64_t a, std::int64_t b, std::int64_t c) {
    cycle_.start(a, b, c);
    clocked_.start(a, b, c);
  }
  /// Behind next_is_stolen().
  void clock(const igc::ArrayWord* word) {
    if (word != nullptr) {
      EXPECT_TRUE(cycle_.send(now_, *word).has_value()) << now_;
    }
    if (!stolen_) clocked_.clock(word);
    ++now_;
  }
  void expect_same() {
    cycle_.go_to(now_);
    const ArrayState& state = cycle_.state();
    using igc::PixelPlane;
    ASSERT_TRUE(clocked_.planes().plane(PixelPlane::kEnable, 0) == state.enable) << now_;
    ASSERT_TRUE(clocked_.planes().plane(PixelPlane::kCarry, 0) == state.carry) << now_;
    ASSERT_TRUE(clocked_.planes().plane(PixelPlane::kData, 0) == state.data) << now_;
    for (unsigned bit = 0; bit < state.memory.size(); ++bit)
      ASSERT_TRUE(clocked_.planes().plane(PixelPlane::kMemory, bit) == state.memory[bit]) << now_ << " bit " << bit;
  }

 private:
  CycleArray cycle_;
  ClockedThieves thieves_;
  ClockedArraySide clocked_;
  std::int64_t now_ = 0;
  bool stolen_ = false;
};

TEST(RandomPixelPlanesArray, BothModelsHaveTheSameRegistersAndMemoryInEveryClock) {
  for_seeds(52000, 40, [&](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Spec spec = random_spec(random);
    spec.tree.masked = true;  // streams of any length, at any time
    BothArrays arrays(spec);
    for (int n = 0; n < 300; ++n) {
      const bool stolen = arrays.next_is_stolen();
      const auto coefficient = [&] { return static_cast<std::int64_t>(random()) >> (2 + random() % 60); };
      const igc::ArrayWord word = random_word(random, spec);
      const bool sent = !stolen && random() % 8 != 0;
      if (sent && random() % 20 == 0) arrays.start(coefficient(), coefficient(), coefficient());
      arrays.clock(sent ? &word : nullptr);
      if (random() % 16 == 0) arrays.expect_same();
      if (::testing::Test::HasFatalFailure()) return;
    }
  });
}

}  // namespace
}  // namespace dendro::pixel_planes
