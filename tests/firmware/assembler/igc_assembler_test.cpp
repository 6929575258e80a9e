#include <gtest/gtest.h>

#include "firmware/tools/igc_assembler.h"
#include "models/parts/igc/igc_isa.h"
#include "sim/base/error.h"

namespace dendro::tools {
namespace {

const std::string kRegisters = "register n = 0; register f = 1; register g = 2;\n";

igc::MicroWord word_of(const std::string& text, int ports = 1) {
  const IgcImage image =
      assemble_igc(kRegisters + "program p { enable = 1, data = 0; carry = 0; loop n { " + text + "; } }", "t.igc", {ports, 256, {}});
  return igc::unpack(image.words.at(2));
}

void expect_error(const std::string& program, const std::string& message, const IgcOptions& options = {}) {
  try {
    assemble_igc(kRegisters + program, "t.igc", options);
    ADD_FAILURE() << "no error: " << program;
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("t.igc:2:"), 0u) << error.what();
  }
}

TEST(IgcAssembler, AComparisonReadsOnePortAndUsesTheTree) {
  const igc::MicroWord word = word_of("carry = borrow(f[i], tree)");
  EXPECT_EQ(word.function, igc::Function::kBorrow);
  EXPECT_EQ(word.x, igc::Operand::kPortA);
  EXPECT_EQ(word.y, igc::Operand::kTree);
  EXPECT_TRUE(word.read_a && word.indexed_a && word.tree && !word.write_a && !word.read_b);
  EXPECT_EQ(word.register_a, 1);
  EXPECT_EQ(word.loop, igc::LoopCount::kRegister);
}

TEST(IgcAssembler, ReadingAndWritingOneBitIsOneUseOfThePort) {
  const igc::MicroWord word = word_of("carry = majority(f[i], tree), f[i] = sum(f[i], tree)");
  EXPECT_TRUE(word.read_a && word.write_a && word.tree);
  EXPECT_EQ(word.source, igc::Source::kSum);
}

TEST(IgcAssembler, ASecondFieldTakesTheSecondPort) {
  const igc::MicroWord word = word_of("carry = borrow(f[i], tree), g[i + 3] = tree", 2);
  EXPECT_TRUE(word.read_a && word.write_b);
  EXPECT_EQ(word.register_b, 2);
  EXPECT_EQ(word.offset_b, 3);
  EXPECT_EQ(word.source, igc::Source::kTree);
}

TEST(IgcAssembler, TwoUsesOfOnePortAreAnError) {
  expect_error("program p { enable = 1; loop n { f[i] = g[i]; } }", "two uses of one port in a clock: the array's memory has 1 port");
  expect_error("program p { enable = 1; loop n { f[i] = g[i], carry = n[i]; } }", "has 2 ports", {2, 256, {}});
}

TEST(IgcAssembler, PartsThatShareAFieldOfTheWordAreAnError) {
  expect_error("program p { enable = 1, carry = 0; }", "the function field is taken");
  expect_error("program p { enable = 1; carry = 0, f[0] = 1; }", "operand x of this word is something else already");
  expect_error("program p { enable = 1; carry = 0; data = 0, data = tree; }", "the data register is changed twice");
  expect_error("program p { enable = 1, data = 0; f[0] = 0 | data, g[0] = 0 & ~data; }", "the source field is taken", {2, 256, {}});
}

TEST(IgcAssembler, BitsBeyondTheMemoryAreAnError) {
  const IgcOptions options{1, 72, {{"n", 16}, {"f", 57}, {"g", 71}}};
  expect_error("program p { enable = 1; loop n { f[i] = 0; } }", "`f` reaches bit 72 of a pixel; the memory has bits 0..71", options);
  expect_error("program p { enable = 1; g[1] = 0; }", "`g` reaches bit 72", options);
  EXPECT_NO_THROW(assemble_igc(kRegisters + "program p { enable = 1; g[0] = 0; }", "t.igc", options));
}

TEST(IgcAssembler, WhatAProgramUsesItSetsFirst) {
  expect_error("program p { f[0] = 1; }", "`enable` is used before the program sets it");
  expect_error("program p { enable = 1; enable = enable & carry; }", "`carry` is used before the program sets it");
  expect_error("program p { enable = 1; loop fraction { carry = tree; } enable = enable & carry; }", "`carry` is used before");
  expect_error("program p { enable = 1; f[0] = tree | data; }", "`data` is used before the program sets it");
}

TEST(IgcAssembler, MistakesAreNamedWithTheirPlace) {
  expect_error("program p { enable = 1; loop n { loop n { idle; } } }", "a loop holds words only");
  expect_error("program p { loop n { idle; } }", "at least one word outside loops");
  expect_error("program p { enable = 1; f[i] = 0; }", "`i` counts the turns of a loop");
  expect_error("program p { enable = 1; h[0] = 0; }", "`h` is no register");
  expect_error("program p { enable = 1; loop 64 { idle; } }", "a number of turns is 1..63");
  expect_error("program p { idle; } program p { idle; }", "the program `p` is written twice");
  expect_error("register n = 3;", "declared twice");
  expect_error("register tree = 3;", "means something else");
  expect_error("program p { enable = 1", "`;` stands here");
}

}  // namespace
}  // namespace dendro::tools
