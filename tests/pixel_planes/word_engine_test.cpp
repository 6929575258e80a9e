#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>
#include <map>

#include "models/machines/pixel_planes/bit_array.h"
#include "models/machines/pixel_planes/word_engine.h"
#include "tests/support/pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

struct Case {
  Spec spec;
  Layout layout;
  Programs programs;
  igc::ControllerState controller;

  Case(const Spec& s, const Layout& l) : spec(s), layout(l), programs(s.array.ports), controller(programs.controller(l)) {}

  WordEngine run(const std::vector<Step>& steps, bool lazy) const {
    WordEngine engine(spec, lazy);
    for (const Step& one : steps) engine.execute(program(one), one.command, controller);
    return engine;
  }
  /// Every word of every command on every pixel's bits.
  ArrayState run_bits(const std::vector<Step>& steps) const {
    ArrayState state(spec);
    for (const Step& one : steps) apply(one, state);
    return state;
  }
  void apply(const Step& one, ArrayState& state) const {
    apply_words(spec, one.command,
                igc::expand(program(one).words(), one.command, controller, static_cast<unsigned>(spec.tree.gap_clocks)), state);
  }
  MacroProgram program(const Step& one) const {
    return MacroProgram(igc::program_at(controller, one.command.header.entry));
  }
  std::uint32_t field(const ArrayState& state, int pixel, unsigned low, unsigned bits) const {
    std::uint32_t value = 0;
    for (unsigned b = 0; b < bits; ++b)
      value |= static_cast<std::uint32_t>(state.memory[low + b][static_cast<std::size_t>(pixel) / 64] >> (pixel % 64) & 1) << b;
    return value;
  }
};

/// floor(T / 2^fraction) of a stream that is long enough.
std::int64_t depth(const igc::Command& command, int x, int y) {
  return (command.a * x + command.b * y + command.c) >> command.header.fraction;
}

TEST(WordEngine, EveryShippedProgramIsAMacroOperation) {
  for (const int ports : {1, 2}) {
    const Case one(small_spec(64, ports), {16, ports == 2});
    for (const auto& [name, program] : one.programs.all()) {
      igc::Command command;
      command.header.entry = program.entry, command.header.expression = true;
      command.header.fraction = 6, command.header.guard = 2;
      EXPECT_TRUE(one.program({name, command}).macros(command, one.controller).has_value()) << name;
    }
  }
}

TEST(WordEngine, OneChangedWordIsNoMacroOperationAnyMore) {
  const Case one(small_spec(), {});
  std::vector<igc::MicroWord> words = igc::program_at(one.controller, one.programs.entry("front_plane"));
  igc::Command command;
  command.header.fraction = 6, command.header.guard = 2, command.header.expression = true;
  ASSERT_TRUE(MacroProgram(words).macros(command, one.controller).has_value());
  words[6].function = igc::Function::kCarry;
  EXPECT_FALSE(MacroProgram(words).macros(command, one.controller).has_value());
}

TEST(WordEngine, PlanesAreMinimaAndMaximaOfExactIntegers) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    std::mt19937_64 random(seed);
    const Case one(small_spec(), {12, false});
    std::vector<Step> steps{step(one.programs, "clear_hull")};
    std::vector<std::int64_t> front(64 * 64, 0), back(64 * 64, 4095);
    for (int p = 0; p < 12; ++p) {
      const std::int64_t a = static_cast<std::int64_t>(random() % 200000) - 100000;
      const std::int64_t b = static_cast<std::int64_t>(random() % 200000) - 100000;
      const std::int64_t c = static_cast<std::int64_t>(random() % 262144) - a * 31 - b * 31;
      const bool raise = random() % 2 == 0;
      steps.push_back(step(one.programs, raise ? "front_plane" : "back_plane", a, b, c, 6, guard_of(a, b, c, 64, 6, 12)));
      for (int at = 0; at < 64 * 64; ++at) {
        const std::int64_t t = std::clamp<std::int64_t>(depth(steps.back().command, at % 64, at / 64), 0, 4095);
        std::int64_t& value = raise ? front[static_cast<std::size_t>(at)] : back[static_cast<std::size_t>(at)];
        value = raise ? std::max(value, t) : std::min(value, t);
      }
    }
    const ArrayState bits = one.run_bits(steps);
    for (int at = 0; at < 64 * 64; ++at) {
      ASSERT_EQ(one.field(bits, at, 0, 12), front[static_cast<std::size_t>(at)]) << at;
      ASSERT_EQ(one.field(bits, at, 12, 12), back[static_cast<std::size_t>(at)]) << at;
    }
  }
}

void expect_same_memory(const ArrayState& wanted, const ArrayState& found) {
  for (std::size_t bit = 0; bit < wanted.memory.size(); ++bit)
    ASSERT_EQ(wanted.memory[bit], found.memory[bit]) << "bit " << bit;
}

void expect_same_three_ways(const Spec& spec, const Layout& layout, std::uint64_t seed) {
  SCOPED_TRACE(fmt::format("seed {}, {} ports, {} bits, gap {}", seed, spec.array.ports, layout.bits, spec.tree.gap_clocks));
  std::mt19937_64 random(seed);
  const Case one(spec, layout);
  const std::vector<Step> steps = random_stream(random, one.programs, layout, spec.array.width, 6);
  const ArrayState wanted = one.run_bits(steps);
  for (const bool lazy : {false, true}) {
    SCOPED_TRACE(lazy ? "lazy" : "full");
    WordEngine engine = one.run(steps, lazy);
    EXPECT_EQ(engine.counters().bitwise_commands, 0u);
    expect_same_memory(wanted, engine.bits());
  }
}

TEST(WordEngine, LazyAndFullEqualTheBitsOnRandomStreams) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const unsigned bits : {8u, 12u, 16u, 24u}) expect_same_three_ways(small_spec(), {bits, false}, seed);
}

TEST(WordEngine, LazyAndFullEqualTheBitsWithTwoPortsAndScratch) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const unsigned bits : {12u, 16u, 24u}) expect_same_three_ways(small_spec(64, 2), {bits, true}, seed);
}

TEST(WordEngine, LeadingZerosChangeNoBit) {
  Spec spec = small_spec();
  spec.tree.masked = false, spec.tree.gap_clocks = 8;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_same_three_ways(spec, {16, false}, seed);
}

TEST(WordEngine, LazyEqualsFullOnALargeArray) {
  for (std::uint64_t seed = 100; seed < 106; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    std::mt19937_64 random(seed);
    const Case one(small_spec(256), {16, false});
    const std::vector<Step> steps = random_stream(random, one.programs, one.layout, 256, 40);
    WordEngine lazy = one.run(steps, true), full = one.run(steps, false);
    expect_same_memory(full.bits(), lazy.bits());
  }
}

TEST(WordEngine, ASmallHullTouchesFewTiles) {
  const Case one(small_spec(256), {16, false});
  std::vector<Step> steps{step(one.programs, "clear_picture"), step(one.programs, "clear_hull")};
  const std::int64_t slope = 1 << 18, depth = 1 << 21;
  for (const auto& [a, b] : {std::pair(slope, slope), {slope, -slope}, {-slope, slope}, {-slope, -slope}}) {
    const std::int64_t c = depth - a * 100 - b * 100;
    const unsigned guard = guard_of(a, b, c, 256, 6, 16);
    steps.push_back(step(one.programs, "front_plane", a, b, c - (1 << 20), 6, guard));
    steps.push_back(step(one.programs, "back_plane", a, b, c + (1 << 20), 6, guard));
  }
  steps.push_back(step(one.programs, "finish"));
  steps.push_back(step(one.programs, "clear_hull"));
  WordEngine lazy = one.run(steps, true);
  EXPECT_LT(lazy.peek(100 * 256 + 100, 32) & 0xFFFF, 0xFFFFu) << "the hull is seen in its middle";
  EXPECT_LT(lazy.counters().evaluated, lazy.counters().pixel_operations / 3);
  expect_same_memory(one.run_bits(steps), lazy.bits());
}

TEST(WordEngine, APeekBringsOneTileUpToDate) {
  std::mt19937_64 random(7);
  const Case one(small_spec(), {16, false});
  const std::vector<Step> steps = random_stream(random, one.programs, one.layout, 64, 3);
  const ArrayState wanted = one.run_bits(steps);
  WordEngine engine = one.run(steps, true);
  for (int n = 0; n < 500; ++n) {
    const int pixel = static_cast<int>(random() % (64 * 64));
    const auto low = static_cast<unsigned>(random() % 110);
    ASSERT_EQ(engine.peek(pixel, low), one.field(wanted, pixel, low, std::min(32u, 128 - low))) << pixel << " " << low;
  }
}

TEST(WordEngine, AProgramOfItsOwnKindRunsOnTheBitsBetweenTheOthers) {
  std::mt19937_64 random(11);
  const Case one(small_spec(), {16, false});
  const tools::IgcImage own = tools::assemble_igc(
      "register front = 1; register back = 2; program add { enable = 1; carry = 0;\n"
      "loop 16 { data = front[i]; carry = majority(data, back[i]), back[i] = sum(data, back[i]); } }", "own.igc");
  igc::ControllerState controller = one.controller;
  std::copy(own.words.begin(), own.words.end(), controller.store.begin() + 900);
  const std::vector<Step> steps = random_stream(random, one.programs, one.layout, 64, 2);
  igc::Command add;
  add.header.entry = 900;
  WordEngine engine(one.spec, true);
  ArrayState wanted(one.spec);
  for (const Step& s : steps) {
    for (const igc::Command& command : {s.command, add}) {
      const auto words = igc::program_at(controller, command.header.entry);
      engine.execute(MacroProgram(words), command, controller);
      apply_words(one.spec, command, igc::expand(words, command, controller, 0), wanted);
    }
  }
  EXPECT_EQ(engine.counters().bitwise_commands, steps.size());
  expect_same_memory(wanted, engine.bits());
}

TEST(Texels, ATexelColoursThePixelsThatShowItAndNoOthers) {
  std::mt19937_64 random(17);
  const Spec spec = small_spec();
  const tools::IgcImage image = tools::assemble_igc(shipped_source("texels.igc"), "texels.igc", {1, 128, {}});
  igc::ControllerState controller;
  std::copy(image.words.begin(), image.words.end(), controller.store.begin());
  controller.registers[image.registers.at("coordinates")] = 3, controller.registers[image.registers.at("colour")] = 40;
  ArrayState state(spec);
  for (Plane& plane : state.memory)
    for (std::uint64_t& word : plane) word = random();
  const Case fields(spec, {});
  std::vector<std::uint32_t> wanted;
  for (int p = 0; p < 64 * 64; ++p) wanted.push_back(fields.field(state, p, 40, 24));
  for (int n = 0; n < 40; ++n) {
    igc::Command command;
    // Every other texel is one that some pixel shows.
    const auto any = static_cast<int>(random() % (64 * 64));
    const std::uint32_t texel = n % 2 == 0 ? fields.field(state, any, 3, 15) : random() & 0x7FFF;
    const std::uint32_t colour = random() & 0xFFFFFF;
    command.constant = texel | static_cast<std::uint64_t>(colour) << 15;
    const auto words = igc::expand(igc::program_at(controller, 0), command, controller, 0);
    EXPECT_EQ(words.size(), 42u);
    apply_words(spec, command, words, state);
    for (int p = 0; p < 64 * 64; ++p)
      if (fields.field(state, p, 3, 15) == texel) wanted[static_cast<std::size_t>(p)] = colour;
    for (int p = 0; p < 64 * 64; ++p)
      ASSERT_EQ(fields.field(state, p, 40, 24), wanted[static_cast<std::size_t>(p)]) << "texel " << n << ", pixel " << p;
  }
}

/// The stream with front planes that leave their numbers. Of hulls that `keeps` chooses the numbers are not cleared.
void leave_numbers(std::vector<Step>& steps, const Programs& programs, const std::function<bool()>& keeps) {
  const std::map<std::string, std::string> others{
      {"clear_hull", "clear_hull_index"}, {"front_plane", "front_plane_index"}, {"recolour", "recolour_index"}};
  std::uint64_t number = 0;
  for (Step& s : steps) {
    const auto other = others.find(s.program);
    if (other == others.end() || (s.program == "clear_hull" && keeps())) continue;
    s.program = other->second, s.command.header.entry = programs.entry(s.program);
    const std::uint64_t low = number++ % 7;
    s.command.constant = s.program == "recolour_index" ? s.command.constant << 12 | low : low;
  }
}

TEST(WordEngine, IndexedColoursEqualTheBits) {
  for (std::uint64_t seed = 13; seed < 25; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    std::mt19937_64 random(seed);
    const Case one(small_spec(), {12, false});
    std::vector<Step> steps = random_stream(random, one.programs, one.layout, 64, 5);
    leave_numbers(steps, one.programs, [&] { return random() % 3 == 0; });
    const ArrayState wanted = one.run_bits(steps);
    for (const bool lazy : {false, true}) {
      WordEngine engine = one.run(steps, lazy);
      EXPECT_EQ(engine.counters().bitwise_commands, 0u);
      expect_same_memory(wanted, engine.bits());
    }
  }
}

TEST(WordEngine, AnIndexedHullThatClearsItsNumbersLeavesTilesAlone) {
  std::uint64_t evaluated[2] = {0, 0}, all = 0;
  for (const bool keeps : {false, true}) {
    std::mt19937_64 random(41);
    const Case one(small_spec(256), {12, false});
    std::vector<Step> steps = random_stream(random, one.programs, one.layout, 256, 40);
    leave_numbers(steps, one.programs, [&] { return keeps; });
    steps.push_back(step(one.programs, "clear_hull"));
    WordEngine lazy = one.run(steps, true), full = one.run(steps, false);
    lazy.peek(0, 0);  // everything before is applied or waits
    evaluated[keeps] = lazy.counters().evaluated, all = full.counters().pixel_operations;
    expect_same_memory(full.bits(), lazy.bits());
  }
  EXPECT_LT(evaluated[false], all / 2);
  EXPECT_LT(evaluated[false], evaluated[true]);
}

}  // namespace
}  // namespace dendro::pixel_planes
