#include "tests/lockstep/pixel_planes_lockstep.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <tuple>

#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/cycle.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/error.h"
#include "tests/support/in_child.h"

namespace dendro::pixel_planes {
namespace {

using igc::DataOp;
using igc::Function;
using igc::LoopCount;
using igc::MicroWord;
using igc::Operand;
using igc::Source;
using Random = std::mt19937_64;

unsigned below(Random& random, unsigned n) { return static_cast<unsigned>(random() % n); }
bool one_in(Random& random, unsigned n) { return below(random, n) == 0; }

std::string in_words(const Spec& s) {
  return fmt::format(
      "{} renderers copy {} frame {}x{} {}x{}x{} ports {} tick {} masked {} gap {} setup {} fifo {} refresh {} video {} word {} flop {} "
      "interrupt {}",
      s.renderers.count, s.renderers.copy_clocks, s.frame.width, s.frame.height, s.array.width, s.array.height,
      s.array.memory_bits, s.array.ports, s.tick_ps, s.tree.masked,
      s.tree.gap_clocks, s.setup_clocks, s.fifo_words, s.refresh_interval_ps, s.video_interval_ps,
      s.host.word_ps, s.host.flop_ps, s.host.interrupt_ps);
}

/// Everything but the pixels, as "name value".
std::vector<std::string> outcome(const Machine& machine) {
  std::vector<std::string> lines{fmt::format("time_dependent {}", machine.time_dependent()),
                                 fmt::format("cycles {}", machine.cycles()),
                                 fmt::format("machine_cycles {}", machine.machine_cycles()),
                                 fmt::format("instructions {}", machine.instructions())};
  for (const UnitStats& unit : machine.units())
    for (const auto& [name, value] : unit.values)
      // How the simulator worked, not what the machine did.
      if (name != "pixel_operations" && name != "evaluated_pixel_operations" && name != "bitwise_commands")
        lines.push_back(fmt::format("{}.{} {}", unit.unit, name, value));
  for (const Phase& phase : machine.phases())
    lines.push_back(
        fmt::format("phase {} {} {}", phase.name, phase.cycles, phase.on_host ? "host" : "machine"));
  return lines;
}

/// The error that a run ends in, or nothing.
std::string error_of(Machine& machine, const Scenario& scenario, std::vector<std::int64_t>& seen) {
  try {
    machine.run([&](HostPort& host) { scenario.program(host, seen); });
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

void run_both(const Scenario& scenario) {
  std::vector<std::int64_t> cycle_seen, clocked_seen;
  CycleMachine cycle(scenario.spec, scenario.options);
  const std::unique_ptr<Machine> clocked = make_clocked(scenario.spec, scenario.options);
  ASSERT_EQ(error_of(cycle, scenario, cycle_seen), "");
  ASSERT_EQ(error_of(*clocked, scenario, clocked_seen), "");
  ASSERT_EQ(cycle_seen, clocked_seen) << "what the host read, cycle | clocked";
  expect_same(cycle, *clocked, scenario.spec);
}

// Micro-programs
// -------------------------------------------------------------------------------------------------------

class Writer {
 public:
  Writer(Random& random, const Spec& spec)
      : random_(random), spec_(spec), anywhere_(spec.tree.masked && one_in(random, 3)) {}

  std::vector<std::uint64_t> program() {
    MicroWord word;
    word.function = Function::kSetEnable;
    word.data = DataOp::kClear;
    word.tree = anywhere_ && one_in(random_, 2);
    words_.push_back(word);
    word = {};
    word.function = Function::kLoad;
    word.x = one_in(random_, 2) ? Operand::kOne : Operand::kZero;
    words_.push_back(word);
    for (unsigned n = 1 + below(random_, 4); n > 0; --n) one_in(random_, 3) ? items(false) : stream();
    // The program's last word may be that of a loop.
    if (one_in(random_, 2)) words_.push_back({});
    words_.back().end = true;
    std::vector<std::uint64_t> packed;
    for (const MicroWord& w : words_) packed.push_back(pack(w));
    return packed;
  }

 private:
  void stream() {
    MicroWord zeros;
    words_.push_back(zeros);
    zeros.tree = zeros.loop_end = true;
    zeros.loop = LoopCount::kGap;
    words_.push_back(zeros);
    if (one_in(random_, 2)) {
      zeros.loop = LoopCount::kFraction;
      words_.push_back(zeros);
    }
    items(true);
    words_.push_back({});
  }

  void items(bool tree) {
    for (unsigned n = 1 + below(random_, 3); n > 0; --n)
      one_in(random_, 3) ? words_.push_back(word(tree, false)) : loop(tree);
  }

  void loop(bool tree) {
    static constexpr LoopCount kCounts[] = {LoopCount::kFraction,     LoopCount::kGuard,
                                            LoopCount::kGuardLessOne, LoopCount::kRegister,
                                            LoopCount::kNumber,       LoopCount::kNumber};
    const LoopCount count = kCounts[below(random_, 6)];
    const std::uint8_t number =
        static_cast<std::uint8_t>(count == LoopCount::kRegister ? below(random_, 4) : below(random_, 14));
    for (unsigned n = 1 + below(random_, 3); n > 0; --n) {
      MicroWord w = word(tree, true);
      w.loop = count;
      w.loop_number = number;
      w.loop_end = n == 1;
      words_.push_back(w);
    }
  }

  MicroWord word(bool tree, bool in_loop) {
    MicroWord w;
    w.function = static_cast<Function>(below(random_, static_cast<unsigned>(Function::kCount)));
    w.x = static_cast<Operand>(below(random_, static_cast<unsigned>(Operand::kCount)));
    w.y = static_cast<Operand>(below(random_, static_cast<unsigned>(Operand::kCount)));
    w.data = static_cast<DataOp>(below(random_, static_cast<unsigned>(DataOp::kCount)));
    w.source = static_cast<Source>(below(random_, static_cast<unsigned>(Source::kCount)));
    const std::uint64_t r = random_();
    w.read_a = r & 1, w.write_a = r & 2;
    if (spec_.array.ports > 1 || one_in(random_, 8)) w.read_b = r & 4, w.write_b = r & 8;
    w.indexed_a = in_loop && (r & 0x30), w.indexed_b = in_loop && (r & 0xC0);
    w.register_a = below(random_, 16), w.register_b = below(random_, 16);
    w.offset_a = static_cast<std::uint8_t>(
        below(random_, one_in(random_, 20) ? 256 : static_cast<unsigned>(spec_.array.memory_bits)));
    w.offset_b = static_cast<std::uint8_t>(below(random_, static_cast<unsigned>(spec_.array.memory_bits)));
    w.constant_offset = static_cast<std::uint8_t>(below(random_, 64));
    w.tree = anywhere_ ? !one_in(random_, 4) : tree;
    return w;
  }

  Random& random_;
  const Spec& spec_;
  bool anywhere_;  ///< streams of any length begin and stop anywhere, and their leading zeros are looked at
  std::vector<MicroWord> words_;
};

std::uint32_t random_coefficient(Random& random) {
  if (one_in(random, 30))
    return static_cast<std::uint32_t>(random());  // also not a number, infinite, far too large
  const double value = (static_cast<double>(random() >> 11) / 4503599627370496.0 - 1.0) *
                       std::ldexp(1.0, static_cast<int>(below(random, 24)) - 8);
  const auto single = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &single, sizeof bits);
  return bits;
}

/// Tiles of a frame of four times four, some outside a smaller one.
std::vector<std::uint32_t> random_copy(Random& random) {
  igc::Header h;
  h.copy = true;
  return {igc::pack(h), below(random, 4) | below(random, 4) << 16};
}

std::vector<std::uint32_t> random_command(Random& random, const std::vector<unsigned>& entries, bool copies) {
  if (copies && one_in(random, 5)) return random_copy(random);
  igc::Header h;
  if (one_in(random, 3)) {
    h.register_write = true;
    h.register_number = below(random, 16);
    h.value = one_in(random, 20) ? below(random, 256) : below(random, 20);
    return {igc::pack(h)};
  }
  h.entry = entries[below(random, static_cast<unsigned>(entries.size()))];
  h.fraction = one_in(random, 10) ? below(random, 64) : below(random, 12);
  h.guard = below(random, 8);
  h.expression = !one_in(random, 6);
  h.constant = one_in(random, 2);
  h.long_constant = one_in(random, 2);
  std::vector<std::uint32_t> words{igc::pack(h)};
  if (h.expression)
    for (int i = 0; i < 3; ++i) words.push_back(random_coefficient(random));
  for (int i = 0; i < h.constant + h.long_constant; ++i)
    words.push_back(static_cast<std::uint32_t>(random()));
  return words;
}

void load(HostPort& host, const std::vector<std::uint64_t>& program, unsigned entry) {
  for (std::uint32_t i = 0; i < program.size(); ++i) {
    const std::uint32_t halves[] = {static_cast<std::uint32_t>(program[i]),
                                    static_cast<std::uint32_t>(program[i] >> 32)};
    host.dma_to(2 * (entry + i), halves, 2, 0);
  }
}

void play(Random random, const Spec& spec, HostPort& host, std::vector<std::int64_t>& seen) {
  std::vector<unsigned> entries;
  unsigned next = 0;
  const auto load_one = [&] {
    const std::vector<std::uint64_t> program = Writer(random, spec).program();
    if (next + program.size() > igc::kStoreWords) return;
    if (spec.renderers.count > 1) host.write(kSelect, kAllRenderers, 0);
    load(host, program, next);
    entries.push_back(next);
    next += static_cast<unsigned>(program.size());
  };
  for (unsigned n = 1 + below(random, 4); n > 0; --n) load_one();
  for (unsigned n = 5 + below(random, 25); n > 0; --n) {
    switch (below(random, 12)) {
      case 0:
        host.wait_interrupt();
        break;
      case 1:
        seen.push_back(host.read(one_in(random, 3) ? kFifo + below(random, 6) : kStatus, 0));
        if (one_in(random, 4)) seen.push_back(host.read(below(random, 2 * next + 4), 0));
        break;
      case 2:
        host.compute({below(random, 300), below(random, 20), one_in(random, 5) ? 1u : 0u});
        break;
      case 3:
        load_one();
        break;
      case 4:
        host.phase(one_in(random, 2) ? "first" : "second");
        break;
      case 5:
        host.write(one_in(random, 2) ? kVideoBase : kVideoSize,
                   one_in(random, 2) ? below(random, 80) : below(random, 70) << 16 | below(random, 70), 0);
        break;
      default: {
        const std::vector<std::uint32_t> words = random_command(random, entries, spec.frame.exists());
        if (spec.renderers.count > 1 && one_in(random, 2))
          host.write(kSelect, below(random, static_cast<unsigned>(spec.renderers.count) + 1), 0);
        if (one_in(random, 2)) {
          host.dma_to(kFifo, words.data(), words.size(), 0, below(random, 2));
        } else {
          for (const std::uint32_t word : words) {
            host.write(kFifo, word, 0);
            if (one_in(random, 20)) host.compute({below(random, 100), 0, 0});
          }
        }
      }
    }
  }
}

}  // namespace

void expect_same_pixels(const Machine& a, const Machine& b, const Spec& spec, const std::string& names) {
  int told = 0;
  for (int low = 0; low < spec.array.memory_bits; low += 32)
    for (const auto& [first, width, count] :
         {std::tuple(0u, spec.array.width, spec.pixels() * spec.renderers.count),
          std::tuple(kFramePixels, spec.frame.width, spec.frame.width * spec.frame.height)})
      for (int p = 0; p < count; ++p) {
        const std::uint32_t x = a.peek(first + static_cast<std::uint32_t>(p), static_cast<unsigned>(low));
        const std::uint32_t y = b.peek(first + static_cast<std::uint32_t>(p), static_cast<unsigned>(low));
        if (x == y) continue;
        ADD_FAILURE() << fmt::format("pixel {}, {} of the {} bits {} up: {:08x} {:08x}, {}", p % width, p / width,
                                     first == 0 ? "arrays" : "frame", low, x, y, names);
        if (++told == 5) return;
      }
}

void expect_same(const Machine& cycle, const Machine& clocked, const Spec& spec) {
  const std::vector<std::string> a = outcome(cycle), b = outcome(clocked);
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    ASSERT_EQ(i < a.size() ? a[i] : "nothing", i < b.size() ? b[i] : "nothing") << "cycle | clocked";
  expect_same_pixels(cycle, clocked, spec, "cycle | clocked");
  const Picture p = cycle.picture(), q = clocked.picture();
  EXPECT_EQ(p.width, q.width);
  EXPECT_EQ(p.height, q.height);
  EXPECT_TRUE(p.rgb == q.rgb) << "pictures differ";
}

void expect_lockstep(const Scenario& scenario, const std::string& repeat) {
  in_child([&] { run_both(scenario); }, repeat + "\n" + in_words(scenario.spec));
}

void expect_errors(const Scenario& scenario, const std::string& cycle_says, const std::string& clocked_says) {
  in_child(
      [&] {
        std::vector<std::int64_t> seen;
        CycleMachine cycle(scenario.spec, scenario.options);
        const std::unique_ptr<Machine> clocked = make_clocked(scenario.spec, scenario.options);
        EXPECT_EQ(error_of(cycle, scenario, seen), cycle_says);
        EXPECT_EQ(error_of(*clocked, scenario, seen), clocked_says);
      },
      cycle_says);
}

Spec random_spec(Random& random) {
  Spec s;
  const auto any = [&](std::initializer_list<std::int64_t> values) {
    return values.begin()[below(random, static_cast<unsigned>(values.size()))];
  };
  s.tick_ps = any({100000, 125000, 25000, 7, 99991});
  s.array.width = static_cast<int>(any({64, 64, 128}));
  s.array.height = static_cast<int>(any({64, 64, 128}));
  s.array.memory_bits = static_cast<int>(8 + below(random, 90));
  s.array.ports = static_cast<int>(1 + below(random, 2));
  s.tree.masked = !one_in(random, 3);
  s.tree.gap_clocks = static_cast<int>(below(random, 12)) + (s.tree.masked ? 0 : s.least_gap());
  if (s.tree.masked && one_in(random, 2)) s.tree.gap_clocks = 0;
  s.setup_clocks = static_cast<int>(any({0, 1, 4, 16, 100}));
  s.fifo_words = static_cast<int>(any({8, 9, 16, 512}));
  const auto interval = [&]() -> std::int64_t {
    return one_in(random, 3)
               ? 0
               : 4 * s.tick_ps +
                     static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(40 * s.tick_ps));
  };
  s.refresh_interval_ps = interval();
  s.video_interval_ps = interval();
  s.host.word_ps = std::max<std::int64_t>(1, any({1, s.tick_ps / 10, s.tick_ps / 3, s.tick_ps, 4 * s.tick_ps,
                                                  4 * s.tick_ps + 1, 30 * s.tick_ps - 1}));
  s.host.flop_ps = std::max<std::int64_t>(1, any({s.tick_ps / 5, s.tick_ps, 5 * s.tick_ps / 3}));
  s.host.instruction_ps = s.host.flop_ps;
  s.host.program_load_ps = any({0, 300 * s.tick_ps});
  s.host.interrupt_ps = any({0, 1, s.tick_ps - 1, s.tick_ps, 100 * s.tick_ps});
  return s;
}

Scenario random_programs(std::uint64_t seed, bool renderers) {
  Random random(seed);
  Scenario scenario;
  scenario.spec = random_spec(random);
  if (renderers) {
    Spec& s = scenario.spec;
    s.renderers.count = static_cast<int>(1 + below(random, 4));
    s.renderers.copy_clocks = one_in(random, 3) ? 0 : static_cast<int>(below(random, 400));
    s.frame.width = s.array.width * static_cast<int>(1 + below(random, 3));
    s.frame.height = s.array.height * static_cast<int>(1 + below(random, 3));
  }
  scenario.options.tick_limit = 1 << 20;
  scenario.options.marks = {{0, "phase_zero.a"}, {1, "phase_one"}, {7, "other"}};
  scenario.program = [random, spec = scenario.spec](HostPort& host, std::vector<std::int64_t>& seen) {
    play(random, spec, host, seen);
  };
  return scenario;
}

}  // namespace dendro::pixel_planes
