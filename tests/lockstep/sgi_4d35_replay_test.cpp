#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/recorder.h"
#include "tests/lockstep/random_mips_program.h"
#include "tests/lockstep/sgi_4d35_lockstep.h"

/// Records random programs on random machines, and replays what is behind each boundary alone at both levels.
namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint64_t kLimit = 6000;

std::uint32_t setting(const char* name, std::uint32_t fallback) {
  const char* text = std::getenv(name);
  return text ? static_cast<std::uint32_t>(std::atoi(text)) : fallback;
}

struct Recording {
  std::string bytes;
  std::map<std::string, std::uint64_t> counters;
};

Recording record(std::uint32_t seed, const Spec& spec, const char* boundary, std::int64_t from = 0, std::int64_t to = INT64_MAX) {
  const CornerProgram program = corner_program(seed);
  trace::Writer writer(boundary, from, to, false);
  StopService services;
  const ProgramResult result = run_recorded(spec, image_of(program.memory, program.start), services, kLimit, writer);
  Recording recording;
  for (const UnitStats& unit : result.units)
    for (const auto& [name, value] : unit.values) recording.counters[unit.unit.substr(unit.unit.find('.') + 1) + "." + name] = value;
  trace::Header header;
  header.machine = "sgi-4d35";
  header.boundary = boundary;
  if (writer.records() != 0) recording.bytes = writer.file(header);
  return recording;
}

std::string replayed(const std::string& bytes, const Spec& spec, Level level) {
  trace::Reader reader(bytes, "trace");
  for (const trace::Boundary& boundary : boundaries())
    if (boundary.name == reader.header().boundary) reader.expect(boundary);
  return replay(spec, level, reader).difference.value_or("");
}

void expect_replays(const std::string& bytes, const Spec& spec) {
  for (const Level level : {Level::kCycle, Level::kClocked}) ASSERT_EQ("", replayed(bytes, spec, level)) << level_name(level);
}

constexpr const char* kBoundaries[] = {kMemoryBoundary, kProcessorBoundary};

TEST(Sgi4d35Replay, WhatIsBehindABoundaryDoesAloneWhatItDidInTheMachine) {
  const std::uint32_t first = setting("DENDRO_SEED", 1), count = std::getenv("DENDRO_SEED") ? 1 : setting("DENDRO_PROGRAMS", 300) / 5;
  for (std::uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed)
    for (const char* boundary : kBoundaries) {
      SCOPED_TRACE(std::string(boundary) + ", repeat with DENDRO_SEED=" + std::to_string(seed));
      const Spec spec = corner_spec(seed);
      const Recording recording = record(seed, spec, boundary);
      if (!recording.bytes.empty()) expect_replays(recording.bytes, spec);
    }
}

TEST(Sgi4d35Replay, SoItDoesFromTheMiddleOfARun) {
  const std::uint32_t first = setting("DENDRO_SEED", 1000), count = std::getenv("DENDRO_SEED") ? 1 : setting("DENDRO_PROGRAMS", 300) / 5;
  unsigned opened = 0;
  for (std::uint32_t seed = first; seed < first + count && !HasFatalFailure(); ++seed)
    for (const char* boundary : kBoundaries) {
      SCOPED_TRACE(std::string(boundary) + ", repeat with DENDRO_SEED=" + std::to_string(seed));
      std::mt19937 random(seed);
      const auto from = static_cast<std::int64_t>(random() % 2000), to = from + 1 + static_cast<std::int64_t>(random() % 6000);
      const Spec spec = corner_spec(seed);
      const Recording recording = record(seed, spec, boundary, from, to);
      if (recording.bytes.empty()) continue;
      ++opened;
      expect_replays(recording.bytes, spec);
    }
  EXPECT_TRUE(count == 1 || opened > count) << opened;
}

TEST(Sgi4d35Replay, ARecordedRunIsTheRun) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed)
    for (const char* boundary : kBoundaries) {
      const CornerProgram program = corner_program(seed);
      const Ran ran = run_unlogged(corner_spec(seed), image_of(program.memory, program.start), kLimit);
      EXPECT_EQ(ran.counters, record(seed, corner_spec(seed), boundary).counters) << boundary << " seed " << seed;
      EXPECT_EQ(ran.counters, record(seed, corner_spec(seed), boundary, 1500, 2500).counters) << boundary << " seed " << seed;
    }
}

/// A machine with one number changed, of which a replay must tell.
TEST(Sgi4d35Replay, AnotherMachineIsSeenToDiffer) {
  const auto differs = [](const char* boundary, const auto& change) {
    unsigned seen = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
      const Spec spec = corner_spec(seed);
      const Recording recording = record(seed, spec, boundary);
      if (recording.bytes.empty()) continue;
      Spec other = spec;
      change(other);
      const std::string cycle = replayed(recording.bytes, other, Level::kCycle);
      EXPECT_EQ(cycle.empty(), replayed(recording.bytes, other, Level::kClocked).empty()) << seed << cycle;
      seen += !cycle.empty();
    }
    return seen;
  };
  for (const char* boundary : kBoundaries) {
    EXPECT_GT(differs(boundary, [](Spec& s) { ++s.bus.first_word_cycles; }), 18u) << boundary;
    EXPECT_GT(differs(boundary, [](Spec& s) { ++s.bus.write_cycles; }), 12u) << boundary;
    EXPECT_GT(differs(boundary, [](Spec& s) { s.bus.read_bypass = !s.bus.read_bypass; }), 8u) << boundary;
    EXPECT_GT(differs(boundary, [](Spec& s) { s.bus.entries = s.bus.entries == 1 ? 4 : 1; }), 8u) << boundary;
  }
  EXPECT_GT(differs(kProcessorBoundary, [](Spec& s) { s.instruction_cache.streaming = !s.instruction_cache.streaming; }), 15u);
  EXPECT_GT(differs(kProcessorBoundary, [](Spec& s) { s.data_cache.refill_words ^= 12; }), 10u);
  EXPECT_GT(differs(kProcessorBoundary, [](Spec& s) { s.data_cache.store_partial = !s.data_cache.store_partial; }), 5u);
}

}  // namespace
}  // namespace dendro::sgi_4d35
