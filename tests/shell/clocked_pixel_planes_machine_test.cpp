#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/shell/clocked_pixel_planes_rig.h"

namespace dendro::pixel_planes {
namespace {

using igc::Function;
using igc::LoopCount;
using igc::MicroWord;
using igc::Operand;

TEST(ClockedPixelPlanes, AStreamGivesEveryPixelTheExactTruncatedNumber) {
  for (const bool masked : {true, false}) {
    in_child([masked] {
      Spec spec = small();
      spec.array.height = 128;
      spec.tree.masked = masked;
      spec.tree.gap_clocks = masked ? 3 : spec.least_gap();
      std::mt19937 random(31);
      const float a = -3.3125f, b = 2.71f, c = 55.5f;
      Rig rig(spec);
      rig.engine->simulate([&](HostPort& host) {
        rig.load(host, store_program(20));
        for (int i = 0; i < 5; ++i) rig.send(host, plane_command(0, -1e6f, -1e6f, -1e6f, 10));
        rig.send(host, plane_command(0, a, b, c, 10));
      });
      const auto units = [](float v) { return std::llround(std::ldexp(static_cast<double>(v), 10)); };
      for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 64; ++x)
          ASSERT_EQ(rig.number(static_cast<unsigned>(x), static_cast<unsigned>(y), 0, 20),
                    (units(a) * x + units(b) * y + units(c)) >> 10)
              << x << ", " << y;
    });
  }
}

TEST(ClockedPixelPlanes, AGapOneClockShortIsSeenAsWrong) {
  in_child([] {
    Spec spec = small();
    spec.tree.masked = false;
    spec.tree.gap_clocks = spec.least_gap() - 1;
    Rig rig(spec);
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(20));
      for (int i = 0; i < 3; ++i) rig.send(host, plane_command(0, -1e5f, -1e5f, -1e5f));
      host.compute({0, 10, 0});
      std::vector<std::uint32_t> both = plane_command(0, -7, -9, 11);
      const std::vector<std::uint32_t> second = plane_command(0, 5, -3, 2);
      both.insert(both.end(), second.begin(), second.end());
      rig.send(host, both);
    });
    int wrong = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        wrong += rig.number(static_cast<unsigned>(x), static_cast<unsigned>(y), 0, 20) != 5 * x - 3 * y + 2;
    EXPECT_GT(wrong, 0);
  });
}

TEST(ClockedPixelPlanes, EnableAndCarryCompareTheStreamWithMemory) {
  in_child([] {
    Rig rig(small());
    // M[0..16) = T; then E = (T' < M), M[20] = E.
    Program compare;
    MicroWord w;
    w.function = Function::kSetEnable;
    compare.push_back(w);
    w = {};
    w.function = Function::kLoad;
    compare.push_back(w);
    w = {};
    w.function = Function::kBorrow;
    w.tree = w.read_a = w.indexed_a = w.loop_end = true;
    w.x = Operand::kTree, w.y = Operand::kPortA;
    w.loop = LoopCount::kNumber, w.loop_number = 15;  // both are positive here
    compare.push_back(w);
    w = {};
    w.function = Function::kAndCarry;
    compare.push_back(w);
    w = {};
    w.x = Operand::kOne;
    w.write_a = w.end = true;
    w.offset_a = 20;
    compare.push_back(w);
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(16));
      rig.load(host, compare, 100);
      rig.send(host, plane_command(0, 3, 5, 1000));
      rig.send(host, plane_command(100, -2, 9, 1100));
    });
    for (unsigned y = 0; y < 64; ++y)
      for (unsigned x = 0; x < 64; ++x)
        ASSERT_EQ(rig.engine->planes().memory(20, x, y), 1100 + 9 * y < 1000 + 3 * x + 5 * y + 2 * x)
            << x << ", " << y;
  });
}

// A word of a loop runs as often as its count says and sees its turn in addresses and constant; 0 turns take
// no time.
TEST(ClockedPixelPlanes, LoopsRunAsOftenAsTheirCountAndSkipInNoTime) {
  for (const unsigned turns : {0u, 1u, 7u}) {
    in_child([turns] {
      Rig rig(small());
      Program p;
      MicroWord w;
      w.function = Function::kSetEnable;
      p.push_back(w);
      w = {};
      w.loop = LoopCount::kRegister, w.loop_number = 3;
      p.push_back(w);
      w.x = Operand::kConstant;
      w.constant_offset = 30;
      w.write_a = w.indexed_a = w.loop_end = true;
      w.register_a = 2;
      w.offset_a = 1;
      p.push_back(w);
      w = {};
      w.end = true;
      p.push_back(w);
      igc::Header h;
      h.entry = 5;
      h.constant = h.long_constant = true;
      const std::uint64_t constant = 0x35A5ull << 30;
      rig.engine->simulate([&](HostPort& host) {
        rig.load(host, p, 5);
        rig.send(host, {register_write(2, 10), register_write(3, turns), igc::pack(h),
                        static_cast<std::uint32_t>(constant), static_cast<std::uint32_t>(constant >> 32)});
      });
      EXPECT_EQ(rig.engine->controller_counters().busy, 2 + 2 + 2 * turns);
      for (unsigned bit = 0; bit < 32; ++bit) {
        const bool inside = bit >= 11 && bit < 11 + turns;
        ASSERT_EQ(rig.engine->planes().memory(bit, 17, 45), inside && (0x35A5 >> (bit - 11) & 1)) << bit;
      }
    });
  }
}

TEST(ClockedPixelPlanes, ACommandBeginsANewStreamThoughTheWordBeforeItUsedTheTree) {
  in_child([] {
    Spec spec = small();
    spec.setup_clocks = 0;
    Rig rig(spec);
    Program p;
    MicroWord w;
    w.tree = w.write_a = w.indexed_a = w.loop_end = w.end = true;
    w.x = Operand::kTree;
    w.loop = LoopCount::kNumber, w.loop_number = 24;
    p.push_back(w);
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(1, 40));
      rig.load(host, p, 100);
      for (const unsigned entry : {0u, 100u, 100u})
        rig.send(host, plane_command(entry, static_cast<float>(entry) - 3.0f, 7, -9));
    });
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        ASSERT_EQ(rig.number(static_cast<unsigned>(x), static_cast<unsigned>(y), 0, 24), 97 * x + 7 * y - 9);
  });
}

TEST(ClockedPixelPlanes, CoefficientsAreRoundedToNearestEvenAndHeldWithinSixtyTwoBits) {
  EXPECT_EQ(translate(single(0.5f), 0), 0);
  EXPECT_EQ(translate(single(1.5f), 0), 2);
  EXPECT_EQ(translate(single(2.5f), 0), 2);
  EXPECT_EQ(translate(single(-2.5f), 0), -2);
  EXPECT_EQ(translate(single(-2.75f), 1), -6);
  EXPECT_EQ(translate(single(0.3f), 10), 307);
  EXPECT_EQ(translate(single(1e30f), 0), std::int64_t{1} << 62);
  EXPECT_EQ(translate(single(-1e30f), 0), -(std::int64_t{1} << 62));
  EXPECT_EQ(translate(0x7F800000u, 3), std::int64_t{1} << 62);
  EXPECT_EQ(translate(0xFF800000u, 3), -(std::int64_t{1} << 62));
  EXPECT_EQ(translate(0x7FC00000u, 3), 0);
  EXPECT_EQ(translate(0x00000001u, 63), 0);
}

TEST(ClockedPixelPlanes, TheStoreAndTheVideoRegistersAreReadBack) {
  in_child([] {
    Rig rig(small());
    rig.engine->simulate([](HostPort& host) {
      for (const std::uint32_t address : {0u, 1u, 2047u, kVideoBase, kVideoSize}) {
        const std::uint32_t kept =
            address == kVideoBase ? 0xEF : 0x89ABCDEF;  // the base has the 8 bits of an address
        host.write(address, 0x89ABCDEF, 0);
        EXPECT_EQ(host.read(address, 0), kept);
        host.compute({0, 10, 0});
        EXPECT_EQ(host.read(address, 0), kept);
      }
      host.write(0x900, 5, 0);
      EXPECT_EQ(host.read(0x900, 0), 0u);
      EXPECT_EQ(host.read(kFifo, 0), 0u);
    });
  });
}

TEST(ClockedPixelPlanes, TheWaveformShowsWordsAndTheirEffectAsManyClocksBehindAsTheTreeHasLevels) {
  in_child([] {
    MachineOptions options;
    options.vcd_file =
        (std::filesystem::path(::testing::TempDir()) / ("pixel_planes" + std::to_string(getpid()) + ".vcd"))
            .string();
    Rig rig(small(), options);
    rig.engine->simulate([&](HostPort& host) {
      rig.load(host, store_program(4));
      rig.send(host, plane_command(0, 0, 0, 5));
    });
    std::ifstream file(options.vcd_file);
    std::map<std::string, std::string> names;
    std::map<std::string, std::int64_t> first_one;
    std::int64_t time = -1;
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string first, skip, width, code, name;
      words >> first;
      if (first == "$var") {
        words >> skip >> width >> code >> name;
        names[code] = name;
      } else if (first[0] == '#') {
        time = std::stoll(first.substr(1));
      } else if (first[0] == '1') {
        first_one.try_emplace(names[first.substr(1)], time / 100000);
      } else if (first[0] == 'b' && first.find('1') != std::string::npos) {
        words >> code;
        first_one.try_emplace(names[code], time / 100000);
      }
    }
    std::filesystem::remove(options.vcd_file);
    // 10 words of program, 4 of the command: the last is taken in 57, ready in 62. The first word of the
    // program sets E in clock 62 + 12, seen before clock 75; the stream begins with the word of clock 63.
    EXPECT_EQ(first_one.at("function"), 74);
    EXPECT_EQ(first_one.at("enabled_pixels"), 75);
    EXPECT_EQ(first_one.at("c"), 63);
    EXPECT_EQ(first_one.at("tree"), 75);
  });
}

}  // namespace
}  // namespace dendro::pixel_planes
