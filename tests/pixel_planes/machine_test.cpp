#include <gtest/gtest.h>

#include <cstring>

#include "models/machines/pixel_planes/cycle.h"
#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/error.h"
#include "tests/support/pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

const std::string kPaint = "register colour = 4; program p phase colour { enable = 1; loop 24 { colour[i] = constant; } }";

void load(HostPort& host) {
  const tools::IgcImage image = tools::assemble_igc(kPaint, "p.igc");
  for (std::uint32_t k = 0; k < image.words.size(); ++k) {
    host.write(kControlStore + 2 * k, static_cast<std::uint32_t>(image.words[k]), 0);
    host.write(kControlStore + 2 * k + 1, static_cast<std::uint32_t>(image.words[k] >> 32), 0);
  }
}

void paint(HostPort& host, std::uint32_t colour) {
  host.write(kFifo, 1u << 31 | 4 << 8 | 40, 0);  // register 4: the colour's first bit
  host.write(kFifo, 1u << 23, 0);
  host.write(kFifo, colour, 0);
}

TEST(PixelPlanesMachine, AddressesAreThoseOfTheDataSheet) {
  CycleMachine machine(small_spec(), {});
  std::uint32_t running = 0, idle = 1;
  machine.run([&](HostPort& host) {
    load(host);
    host.write(kVideoBase, 40, 0);
    host.write(kVideoSize, 8 | 4 << 16, 0);
    paint(host, 0x332211);
    running = host.read(kStatus, 0);
    host.wait_interrupt();
    idle = host.read(kStatus, 0);
    EXPECT_EQ(host.read(0x2000, 0), 0u);
  });
  EXPECT_EQ(running, 1u);
  EXPECT_EQ(idle, 0u);
  EXPECT_TRUE(machine.time_dependent());
  const Picture picture = machine.picture();
  EXPECT_EQ(picture.width, 8);
  EXPECT_EQ(picture.height, 4);
  EXPECT_EQ(picture.rgb[0], 0x11);
  EXPECT_EQ(picture.rgb[1], 0x22);
  EXPECT_EQ(picture.rgb[2], 0x33);
  EXPECT_EQ(machine.peek(64 * 63 + 5, 40) & 0xFFFFFF, 0x332211u);
  EXPECT_EQ(machine.peek(64 * 63 + 5, 48) & 0xFFFF, 0x3322u);
}

TEST(PixelPlanesMachine, HostTimeIsThatOfItsParameters) {
  Spec spec = small_spec();
  spec.host.word_ps = 700000, spec.host.flop_ps = 3000, spec.host.instruction_ps = 5000;
  spec.host.program_load_ps = 11000000, spec.host.interrupt_ps = 13000000;
  CycleMachine machine(spec, {});
  machine.run([&](HostPort& host) {
    Work work;
    work.flops = 1000, work.instructions = 100, work.program_loads = 1;
    host.compute(work);
    load(host);
    paint(host, 1);
    host.wait_interrupt();
  });
  // Two words of control store, then a register write and a command; the last word lands in clock floor(h / tick).
  const std::int64_t host = 3000000 + 500000 + 11000000 + (4 + 3) * 700000;
  const std::int64_t words = 1 + 24, translator = 2;  // taken a clock behind the one in which it landed, then ready
  const std::int64_t idle = host / spec.tick_ps + translator + words + spec.latency();
  EXPECT_EQ(machine.cycles(), idle + 130);
  std::int64_t sum = 0;
  for (const Phase& phase : machine.phases()) sum += phase.cycles;
  EXPECT_EQ(sum, machine.cycles());
}

TEST(PixelPlanesMachine, ClocksDoNotDependOnTheClock) {
  std::uint64_t busy[2];
  for (const int k : {0, 1}) {
    Spec spec = small_spec();
    spec.tick_ps = k == 0 ? 100000 : 25000;
    CycleMachine machine(spec, {});
    machine.run([&](HostPort& host) {
      load(host);
      paint(host, 7);
      host.wait_interrupt();
    });
    busy[k] = machine.instructions();
  }
  EXPECT_EQ(busy[0], 26u);
  EXPECT_EQ(busy[0], busy[1]);
}

config::ParameterSet parameters(bool masked, std::int64_t gap) {
  config::ParameterSet set;
  const auto add = [&](const char* key, config::Value value) { set.add({key, value, {}, "TEST", "", {"m.toml", 3}}); };
  add("array.width", std::int64_t{64}), add("array.height", std::int64_t{64}), add("array.memory_bits", std::int64_t{72});
  add("array.clock_mhz", 10.0), add("array.ports", std::int64_t{1});
  add("array.refresh_interval_ns", 0.0), add("array.video_interval_ns", 0.0);
  add("tree.masked", masked), add("tree.gap_clocks", gap);
  add("translator.setup_clocks", std::int64_t{4}), add("fifo.depth_words", std::int64_t{512});
  add("host.flops_m_s", 6.0), add("host.instructions_m_s", 6.0), add("host.word_ns", 400.0);
  add("host.program_load_ms", 30.0), add("host.interrupt_us", 10.0);
  return set;
}

TEST(PixelPlanesMachine, StreamsThatSpillAreRefused) {
  const MachineType type = pixel_planes_type();
  EXPECT_NO_THROW(type.make(parameters(true, 0), Level::kFunction, {}));
  EXPECT_NO_THROW(type.make(parameters(false, 5), Level::kFunction, {}));
  try {
    type.make(parameters(false, 4), Level::kFunction, {});
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_EQ(error.key(), "tree.gap_clocks");
    EXPECT_EQ(error.line(), 3);
  }
}

TEST(PixelPlanesMachine, ARunThatPassesItsLimitIsAnError) {
  MachineOptions options;
  options.tick_limit = 20;
  CycleMachine machine(small_spec(), options);
  EXPECT_THROW(machine.run([&](HostPort& host) {
    load(host);
    paint(host, 7);
  }), UserError);
}

}  // namespace
}  // namespace dendro::pixel_planes
