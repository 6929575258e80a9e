#include <gtest/gtest.h>

#include <random>

#include "firmware/tools/assembler.h"
#include "firmware/tools/disassembler.h"
#include "models/parts/bps32/bps32_disasm.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/error.h"
#include "tests/firmware/assembler/assembler_programs.h"

namespace dendro {
namespace {

using tools::assemble;
using tools::Ucode;

Ucode again(const Ucode& u) { return assemble(tools::disassemble(u), "again.gia", {}).ucode; }

Ucode small() {
  return assemble(
             "scratch a[2] = {7, 8} @ 3; entry go; up: r0 = r0 + 1; go: r0 - a[1] -> flags; if (!zero) goto "
             "up; halt;",
             "t.gia", {})
      .ucode;
}

TEST(Disassembler, GivesBackEveryAssembledProgram) {
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    for (const char* pack : {"none", "full"}) {
      tools::AssembleOptions o;
      o.pack = pack;
      o.multiply_ticks = 3;
      const Ucode u = assemble(testing::random_source(seed, 3, true), "t.gia", o).ucode;
      const std::string text = tools::disassemble(u);
      ASSERT_EQ(again(u), u) << "seed " << seed << " pack " << pack;
      EXPECT_EQ(text.find(" word 0x"), std::string::npos)
          << "seed " << seed << ": a word without a symbolic form\n"
          << text;
    }
  }
}

TEST(Disassembler, GivesBackAnyWords) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    Ucode u = small();
    u.words.clear();
    for (int i = 0; i < 500; ++i) {
      std::uint64_t w = random();
      // Half of them differ from a nop in one field only, so that symbolic forms come up.
      if (i % 2) {
        const auto& f = bps32::kFields[random() % std::size(bps32::kFields)];
        w = bps32::put(bps32::nop(), f, static_cast<unsigned>(random()));
      }
      u.words.push_back(w);
    }
    u.symbols["last"] = 500;
    u.symbols["middle"] = 250;
    u.entry = static_cast<std::uint32_t>(random() % 500);
    u.scratch_data[8191] = 0xFFFFFFFFu;
    u.scratch["overlapping"] = {4, 100};
    u.pack = "full";
    u.multiply_ticks = 5;
    ASSERT_EQ(again(u), u) << "round " << round;
  }
}

TEST(Disassembler, NamesLabelsAndShowsSymbols) {
  const std::string text = tools::disassemble(small());
  EXPECT_NE(text.find("if (!zero) goto up;"), std::string::npos) << text;
  EXPECT_NE(text.find("r0 - spad[0x004] -> flags;"), std::string::npos) << text;
}

TEST(Disassembler, NeedsNoAssemblerForOneWord) {
  EXPECT_EQ(bps32::disassemble_word(bps32::nop()), "nop");
  EXPECT_EQ(bps32::disassemble_word(small().words[0]), "r0 = r0 + 1");
  EXPECT_EQ(bps32::disassemble_word(~std::uint64_t{0}), "word 0xffffffffffffffff");
}

TEST(UcodeFile, ReadsWhatItWrites) {
  const Ucode u = small();
  EXPECT_EQ(tools::read_ucode(tools::write_ucode(u), "t.ucode"), u);
}

TEST(UcodeFile, RefusesEveryTruncation) {
  const std::string text = tools::write_ucode(small());
  for (std::size_t n = 0; n < text.size(); ++n) {
    EXPECT_THROW(tools::read_ucode(text.substr(0, n), "t.ucode"), UserError) << n;
  }
}

TEST(UcodeFile, RefusesEveryChangedByte) {
  const std::string text = tools::write_ucode(small());
  for (std::size_t n = 0; n < text.size(); ++n) {
    std::string damaged = text;
    damaged[n] = damaged[n] == '1' ? '2' : '1';
    EXPECT_THROW(tools::read_ucode(damaged, "t.ucode"), UserError) << n << ": " << damaged;
  }
}

TEST(UcodeFile, NamesFileAndLineOfANewerFormat) {
  try {
    tools::read_ucode("dendro-ucode 2\n", "t.ucode");
    FAIL();
  } catch (const UserError& e) {
    EXPECT_EQ(std::string(e.what()).rfind("t.ucode:1: format 2 is newer", 0), 0u) << e.what();
  }
}

}  // namespace
}  // namespace dendro
