#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models/machines/pixel_planes/bit_array.h"
#include "models/parts/igc/igc.h"
#include "sim/base/error.h"
#include "tests/support/pixel_planes_rig.h"

namespace dendro::igc {
namespace {

TEST(Igc, CoefficientsAreRoundedToTheNearestAndTiesToEven) {
  EXPECT_EQ(translate(1.5f, 0), 2);
  EXPECT_EQ(translate(2.5f, 0), 2);
  EXPECT_EQ(translate(-2.5f, 0), -2);
  EXPECT_EQ(translate(-3.5f, 0), -4);
  EXPECT_EQ(translate(-0.25f, 10), -256);
  EXPECT_EQ(translate(1.0f / 3, 10), 341);
}

TEST(Igc, CoefficientsWithoutAValueOrTooLargeAreWhatTheSheetSays) {
  EXPECT_EQ(translate(std::numeric_limits<float>::quiet_NaN(), 10), 0);
  EXPECT_EQ(translate(std::numeric_limits<float>::infinity(), 0), std::int64_t{1} << 62);
  EXPECT_EQ(translate(-1e30f, 10), -(std::int64_t{1} << 62));
}

TEST(Igc, AMicroWordSurvivesItsEncoding) {
  MicroWord word;
  word.function = Function::kEqual, word.x = Operand::kData, word.y = Operand::kPortB, word.data = DataOp::kPortA;
  word.source = Source::kTree, word.read_a = word.write_b = true, word.register_a = 9, word.offset_a = 200;
  word.indexed_b = true, word.register_b = 15, word.offset_b = 255, word.tree = true, word.loop = LoopCount::kNumber;
  word.loop_number = 63, word.constant_offset = 40, word.loop_end = word.end = true;
  const MicroWord back = unpack(pack(word));
  EXPECT_EQ(back.function, word.function);
  EXPECT_EQ(back.offset_a, 200);
  EXPECT_EQ(back.offset_b, 255);
  EXPECT_EQ(back.loop_number, 63);
  EXPECT_EQ(back.constant_offset, 40);
  EXPECT_TRUE(back.end && back.loop_end && back.tree && back.indexed_b && !back.indexed_a);
  EXPECT_EQ(pack(back), pack(word));
}

TEST(Igc, AHeaderSurvivesItsEncoding) {
  Header header;
  header.entry = 1000, header.fraction = 63, header.guard = 41, header.expression = true, header.long_constant = true;
  const Header back = unpack_header(pack(header));
  EXPECT_EQ(back.entry, 1000u);
  EXPECT_EQ(back.fraction, 63u);
  EXPECT_EQ(back.guard, 41u);
  EXPECT_TRUE(back.expression && back.long_constant && !back.constant && !back.register_write);
  EXPECT_EQ(back.words(), 5u);
}

TEST(Igc, ALoopOfNoTurnsTakesNoClock) {
  ControllerState state;
  const tools::IgcImage image =
      tools::assemble_igc("program p { enable = 1; loop fraction { tree; idle; } loop guard - 1 { idle; } }", "p.igc");
  std::copy(image.words.begin(), image.words.end(), state.store.begin());
  const auto program = program_at(state, 0);
  Header header;
  for (const auto& [fraction, guard, words] : {std::tuple(0u, 1u, 1u), {3u, 1u, 7u}, {0u, 5u, 5u}, {0u, 0u, 1u}}) {
    header.fraction = fraction, header.guard = guard;
    EXPECT_EQ(count_words(program, header, state, 0), words) << fraction << " " << guard;
  }
}

TEST(Igc, AProgramWithoutEndIsAnError) {
  const ControllerState state;
  EXPECT_THROW(program_at(state, 5), UserError);
}

TEST(Igc, BitsOfAnExpressionAreThoseOfItsSum) {
  Command command;
  command.a = -(std::int64_t{1} << 61), command.b = 12345, command.c = 77;
  const __int128 sum = static_cast<__int128>(command.a) * 511 + command.b * 300 + command.c;
  for (unsigned bit = 0; bit < 100; ++bit)
    EXPECT_EQ(pixel_planes::expression_bit(command, 511, 300, bit), (sum >> bit & 1) != 0) << bit;
}

}  // namespace
}  // namespace dendro::igc
