#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "tests/lockstep/pixel_planes_lockstep.h"
#include "tests/support/pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

/// DENDRO_SEED repeats one scenario; DENDRO_PROGRAMS sets how many are tried (the long proof of `./dev test
/// --all`).
std::uint64_t setting(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : fallback;
}

void for_seeds(std::uint64_t first, std::uint64_t count, const std::function<Scenario(std::uint64_t)>& make) {
  const bool one = std::getenv("DENDRO_SEED") != nullptr;
  first = setting("DENDRO_SEED", first);
  count = one ? 1 : setting("DENDRO_PROGRAMS", count);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    expect_lockstep(make(seed), "repeat with DENDRO_SEED=" + std::to_string(seed));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

std::uint32_t single(double value) {
  const auto rounded = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  return bits;
}

void send(HostPort& host, const igc::Command& command) {
  igc::Header h = command.header;
  h.constant = (command.constant & 0xFFFFFFFF) != 0, h.long_constant = command.constant >> 32 != 0;
  std::vector<std::uint32_t> words{igc::pack(h)};
  if (h.expression)
    for (const std::int64_t c : {command.a, command.b, command.c})
      words.push_back(single(std::ldexp(static_cast<double>(c), -static_cast<int>(h.fraction))));
  if (h.constant) words.push_back(static_cast<std::uint32_t>(command.constant));
  if (h.long_constant) words.push_back(static_cast<std::uint32_t>(command.constant >> 32));
  host.dma_to(kFifo, words.data(), words.size(), 0, 0);
}

/// The shipped programs on pictures of random hulls, planes that just touch a tile's corner among them.
Scenario hulls(std::uint64_t seed, const Spec& spec, unsigned bits, int count) {
  std::mt19937_64 random(seed);
  const bool scratch = spec.array.ports > 1 && random() % 2 == 0;
  const Programs programs(spec.array.ports);
  const Layout layout{bits, scratch};
  const std::vector<Step> steps =
      random_stream(random, programs, layout, std::max(spec.array.width, spec.array.height), count);
  Scenario scenario;
  scenario.spec = spec;
  for (const auto& [name, program] : programs.all())
    scenario.options.marks[program.entry] = "phase_" + program.phase + "." + name;
  scenario.program = [=](HostPort& host, std::vector<std::int64_t>&) {
    for (std::uint32_t i = 0; i < programs.words().size(); ++i) {
      host.write(2 * i, static_cast<std::uint32_t>(programs.words()[i]), 0);
      host.write(2 * i + 1, static_cast<std::uint32_t>(programs.words()[i] >> 32), 0);
    }
    for (const auto& [name, value] : layout.registers()) {
      igc::Header h;
      h.register_write = true;
      h.register_number = programs.register_number(name), h.value = value;
      host.write(kFifo, igc::pack(h), 0);
    }
    host.write(kVideoBase, layout.registers().at("colour"), 0);
    for (const Step& s : steps) send(host, s.command);
    host.wait_interrupt();
  };
  return scenario;
}

TEST(PixelPlanesLockstep, RandomProgramsAreEqualAtCycleAndClockedInEveryBitAndClock) {
  for_seeds(1000, 300, [](std::uint64_t seed) { return random_programs(seed); });
}

TEST(PixelPlanesLockstep, SeveralRenderersAndTheirFrameAreEqualAtCycleAndClockedInEveryBitAndClock) {
  for_seeds(700000, 200, [](std::uint64_t seed) { return random_programs(seed, true); });
}

TEST(PixelPlanesLockstep, ShippedProgramsOnRandomHullsAreEqualForRandomParameters) {
  for_seeds(500000, 60, [](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Spec spec = random_spec(random);
    spec.array.memory_bits = 128;
    return hulls(seed, spec, 8 + static_cast<unsigned>(random() % 17), 3);
  });
}

TEST(PixelPlanesLockstep, FiveHundredAndTwelveSquaredIsEqual) {
  Spec spec;
  spec.refresh_interval_ps = 27777800, spec.video_interval_ps = 2712700;
  expect_lockstep(hulls(77, spec, 16, 6), "512 x 512");
}

// One parameter at a time at the ends of what resolve() takes.
TEST(PixelPlanesLockstep, EveryParameterIsEqualAtItsEnds) {
  Spec base;
  base.array.width = base.array.height = 64;
  base.array.memory_bits = 72;
  using Change = std::function<void(Spec&)>;
  const std::vector<std::pair<std::string, Change>> changes{
      {"tick low", [](Spec& s) { s.tick_ps = 1000; }},
      {"tick high", [](Spec& s) { s.tick_ps = 10000000; }},
      {"widest", [](Spec& s) { s.array.width = 1024; }},
      {"highest", [](Spec& s) { s.array.height = 1024; }},
      {"most memory", [](Spec& s) { s.array.memory_bits = 256; }},
      {"least memory", [](Spec& s) { s.array.memory_bits = 8; }},
      {"two ports", [](Spec& s) { s.array.ports = 2; }},
      {"refresh", [](Spec& s) { s.refresh_interval_ps = 4 * s.tick_ps; }},
      {"video", [](Spec& s) { s.video_interval_ps = 4 * s.tick_ps; }},
      {"both", [](Spec& s) { s.refresh_interval_ps = s.video_interval_ps = 4 * s.tick_ps; }},
      {"unmasked", [](Spec& s) { s.tree.masked = false, s.tree.gap_clocks = s.least_gap(); }},
      {"longest gap", [](Spec& s) { s.tree.gap_clocks = 63; }},
      {"no set-up", [](Spec& s) { s.setup_clocks = 0; }},
      {"longest set-up", [](Spec& s) { s.setup_clocks = 1000; }},
      {"smallest FIFO", [](Spec& s) { s.fifo_words = 8; }},
      {"quickest host", [](Spec& s) { s.host.word_ps = 100, s.host.interrupt_ps = 0; }},
      {"slow host", [](Spec& s) { s.host.word_ps = 100000000; }},
  };
  for (const auto& [name, change] : changes) {
    Spec spec = base;
    change(spec);
    expect_lockstep(hulls(90, spec, 12, 2), name);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(PixelPlanesLockstep, ACommandThatLacksWordsIsOneErrorAtBothLevels) {
  const std::string says = "pixel_planes: the last command lacks words, so the machine never becomes idle";
  Scenario scenario;
  scenario.spec.array.width = scenario.spec.array.height = 64;
  igc::Header h;
  h.expression = true;
  for (const bool waits : {false, true}) {
    scenario.program = [&](HostPort& host, std::vector<std::int64_t>&) {
      host.write(kFifo, igc::pack(h), 0);
      if (waits) host.wait_interrupt();
    };
    expect_errors(scenario, says, says);
  }
}

TEST(PixelPlanesLockstep, AProgramWithoutEndIsOneErrorAtBothLevels) {
  const std::string says = "the micro-program at word 7 of the control store has no end";
  Scenario scenario;
  scenario.spec.array.width = scenario.spec.array.height = 64;
  igc::Header h;
  h.entry = 7;
  scenario.program = [=](HostPort& host, std::vector<std::int64_t>&) { host.write(kFifo, igc::pack(h), 0); };
  expect_errors(scenario, says, says);
}

// Load 400 x 4 clocks; the header lands in clock 1604, the first word goes out in 1606, the last in 1805.
TEST(PixelPlanesLockstep, TheLimitOfARunIsReachedInTheSameClockAtBothLevels) {
  std::vector<igc::MicroWord> program(200);
  program.back().end = true;
  for (const std::int64_t limit : {1, 1605, 1700, 1804, 1805, 1806, 1807, 5000}) {
    Scenario scenario;
    scenario.spec.array.width = scenario.spec.array.height = 64;
    scenario.options.tick_limit = limit;
    scenario.program = [=](HostPort& host, std::vector<std::int64_t>&) {
      for (std::uint32_t i = 0; i < 400; ++i)
        host.write(i, static_cast<std::uint32_t>(igc::pack(program[i / 2]) >> (i % 2 * 32)), 0);
      host.write(kFifo, igc::pack(igc::Header()), 0);
      host.wait_interrupt();
    };
    const std::string says =
        limit < 1806 ? "the machine has run for " + std::to_string(limit) + " clocks: the limit is reached"
                     : "";
    expect_errors(scenario, says, says);
  }
}

TEST(PixelPlanesLockstep, AProgramThatSendsNothingIsOneErrorAtBothLevels) {
  const std::string says = "the micro-program at word 0 sends nothing";
  igc::MicroWord none;
  none.loop = igc::LoopCount::kGuard;
  none.loop_end = none.end = true;
  Scenario scenario;
  scenario.spec.array.width = scenario.spec.array.height = 64;
  scenario.program = [=](HostPort& host, std::vector<std::int64_t>&) {
    const std::uint64_t word = igc::pack(none);
    host.write(0, static_cast<std::uint32_t>(word), 0);
    host.write(1, static_cast<std::uint32_t>(word >> 32), 0);
    host.write(kFifo, igc::pack(igc::Header()), 0);
  };
  expect_errors(scenario, says, says);
}

// A command takes effect at `cycle` when it is offered, so a program that changes under it has to be refused.
TEST(PixelPlanesLockstep, AProgramThatIsOverwrittenUnderItsCommandIsRefusedByCycle) {
  std::vector<igc::MicroWord> program(100);
  program.back().end = true;
  for (const bool waits : {false, true}) {
    for (const unsigned word : {0u, 98u, 99u, 100u, 1023u}) {
      Scenario scenario;
      scenario.spec.array.width = scenario.spec.array.height = 64;
      scenario.program = [=](HostPort& host, std::vector<std::int64_t>&) {
        for (std::uint32_t i = 0; i < 200; ++i)
          host.write(i, static_cast<std::uint32_t>(igc::pack(program[i / 2]) >> (i % 2 * 32)), 0);
        host.write(kFifo, igc::pack(igc::Header()), 0);
        if (waits) host.wait_interrupt();
        host.write(2 * word, 0, 0);
      };
      const bool refused = !waits && word < 100;
      expect_errors(scenario,
                    refused ? "word " + std::to_string(word) +
                                  " of the control store is written while a command that runs it is not "
                                  "done: what comes out "
                                  "shows at level clocked only"
                            : "",
                    "");
    }
  }
}

}  // namespace
}  // namespace dendro::pixel_planes
