#include <gtest/gtest.h>

#include "firmware/tools/assembler.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/error.h"
#include "tests/firmware/assembler/assembler_machine.h"
#include "tests/firmware/assembler/assembler_programs.h"

namespace dendro {
namespace {

using tools::assemble;
using tools::AssembleOptions;

tools::Ucode packed(const std::string& source, int multiply_ticks = 2) {
  AssembleOptions o;
  o.pack = "full";
  o.multiply_ticks = multiply_ticks;
  return assemble(source, "t.gia", o).ucode;
}

std::size_t packed_words(const std::string& source, int multiply_ticks = 2) {
  return packed(source, multiply_ticks).words.size();
}

/// What a program leaves: a product still under way counts as arrived.
void expect_same(const testing::MachineRun& a, const testing::MachineRun& b) {
  ASSERT_TRUE(a.halted);
  ASSERT_TRUE(b.halted);
  EXPECT_EQ(a.state.ram, b.state.ram);
  EXPECT_EQ(a.state.q, b.state.q);
  EXPECT_EQ(a.state.z, b.state.z);
  EXPECT_EQ(a.state.n, b.state.n);
  EXPECT_EQ(a.state.c, b.state.c);
  EXPECT_EQ(a.state.v, b.state.v);
  EXPECT_EQ(a.state.divide_sign, b.state.divide_sign);
  EXPECT_EQ(a.state.counter, b.state.counter);
  EXPECT_EQ(a.state.sar, b.state.sar);
  EXPECT_EQ(a.state.bus_address, b.state.bus_address);
  EXPECT_EQ(a.state.write_data, b.state.write_data);
  EXPECT_EQ(a.state.read_data, b.state.read_data);
  EXPECT_EQ(a.state.mul_x, b.state.mul_x);
  EXPECT_EQ(a.state.mul_y, b.state.mul_y);
  const auto product = [](const bps32::ProcessorState& s) {
    return s.product_in ? s.pending_product : s.product;
  };
  EXPECT_EQ(product(a.state), product(b.state));
  EXPECT_EQ(a.state.scratch, b.state.scratch);
  EXPECT_EQ(a.accesses, b.accesses);
}

void expect_packing_changes_nothing(std::uint32_t seed, bool structured, std::size_t& plain,
                                    std::size_t& dense) {
  const int ticks = 1 + static_cast<int>(seed % 4);
  const std::string source = testing::random_source(seed, ticks, structured);
  SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + source);
  AssembleOptions o;
  o.multiply_ticks = ticks;
  const tools::Ucode none = assemble(source, "none.gia", o).ucode;
  o.pack = "full";
  const tools::Ucode full = assemble(source, "full.gia", o).ucode;
  EXPECT_LE(full.words.size(), none.words.size());
  plain += none.words.size();
  dense += full.words.size();
  const bps32::ProcessorState start = testing::random_state(seed);
  expect_same(testing::run_program(none, start, 5000), testing::run_program(full, start, 5000));
}

TEST(Packing, ChangesNoResultOfRandomStraightLinePrograms) {
  std::size_t plain = 0, dense = 0;
  for (std::uint32_t seed = 1; seed <= 400 && !HasFailure(); ++seed) {
    expect_packing_changes_nothing(seed, false, plain, dense);
  }
  EXPECT_LT(dense * 10, plain * 9);
}

TEST(Packing, ChangesNoResultOfRandomProgramsWithBranchesLoopsAndCalls) {
  std::size_t plain = 0, dense = 0;
  for (std::uint32_t seed = 1001; seed <= 1300 && !HasFailure(); ++seed) {
    expect_packing_changes_nothing(seed, true, plain, dense);
  }
  EXPECT_LT(dense * 10, plain * 9);
}

TEST(Packing, IsDeterministic) {
  const std::string source = testing::random_source(7, 2, true);
  EXPECT_EQ(packed(source), packed(source));
}

TEST(Packing, JoinsAMoveToTheBusAnAccessAndABranchWithTheOperationBefore) {
  EXPECT_EQ(packed_words("l: r0 = r0 + r1; bus_x = r0; read lores; goto l;"), 1u);
}

TEST(Packing, KeepsABranchBehindTheLatchThatItTests) {
  EXPECT_EQ(packed_words("l: r0 - r1 -> flags; if (zero) goto l; halt;"), 3u);
  EXPECT_EQ(packed_words("l: r0 - r1 -> flags; r2 = r2 + 1; if (zero) goto l; halt;"), 3u);
  EXPECT_EQ(packed_words("l: r2 = r2 + 1; r0 - r1 -> flags; if (zero) goto l; halt;"), 3u);
}

TEST(Packing, KeepsTheWordsThatAProductNeeds) {
  EXPECT_EQ(packed_words("mul signed; nop; r0 = product, halt;", 2), 3u);
  EXPECT_EQ(packed_words("mul signed; nop; nop; r0 = product, halt;", 3), 4u);
  EXPECT_EQ(packed_words("mul signed; r1 = 1; r0 = product, halt;", 2), 3u);
  // Across a label the distance is the sum of both stretches.
  EXPECT_EQ(packed_words("mul signed; nop; l: r0 = product, halt;", 2), 3u);
}

TEST(Packing, KeepsTheWordsThatAProductNeedsThroughLabelsAndReturns) {
  EXPECT_EQ(packed_words("mul signed; l: nop; nop; r0 = product, halt;", 3), 4u);
  EXPECT_EQ(packed_words("mul signed; k: nop; l: nop; r0 = product, halt;", 3), 4u);
  EXPECT_EQ(packed_words("entry e; s: mul signed; return; e: call s; nop; r0 = product, halt;", 3), 5u);
  EXPECT_EQ(packed_words("entry e; s: mul signed; return; e: call s; nop; r0 = product, halt;", 2), 4u);
}

TEST(Packing, JoinsNoMoveThatDependsOnMoreThanTheResult) {
  EXPECT_EQ(packed_words("r0 = spad[sar++]; spad[sar++] = r0; halt;"), 2u);
  EXPECT_EQ(packed_words("r0 = r0 + 1, flags; status = r0; halt;"), 2u);
  EXPECT_EQ(packed_words("bus_x = r0 = r0 + 1; bus_y = r0; halt;"), 2u);
}

TEST(Packing, KeepsTwoUsesOfImmApart) {
  EXPECT_EQ(packed_words("r0 = 5; goto l; r1 = 1; l: halt;"), 4u);
  EXPECT_EQ(packed_words("r0 = r1; goto l; r1 = 1; l: halt;"), 3u);
}

TEST(Packing, PutsIndependentWorkBetweenAReadAndItsUse) {
  const tools::Ucode u = packed(
      "bus_x = r0, read lores; r1 = bus; r1 - r2 -> flags; r3 = r3 + 1; r4 = r4 + 2; r5 = r5 + 3;"
      "if (zero) goto l; halt; l: halt;");
  std::size_t use = 0;
  while (bps32::get(u.words[use], bps32::kDsrc) != bps32::kDBus) ++use;
  EXPECT_EQ(use, 3u);
  EXPECT_EQ(u.words.size(), 8u);
}

TEST(Packing, KeepsTheUseOfDataBehindItsReadAndLetsTheUseBeforeShareTheWord) {
  EXPECT_EQ(packed_words("read lores; r1 = bus; halt;"), 2u);
  EXPECT_EQ(packed_words("r1 = bus; read lores; halt;"), 1u);
}

TEST(Packing, RefusesABranchToANumber) {
  AssembleOptions o;
  o.pack = "full";
  EXPECT_THROW(assemble("goto 0;", "t.gia", o), UserError);
  EXPECT_THROW(assemble("l: goto l + 1; halt;", "t.gia", o), UserError);
  EXPECT_NO_THROW(assemble("goto 0;", "t.gia", {}));
}

TEST(Packing, LeavesVerbatimWordsAndOldProductsAlone) {
  const tools::Ucode u =
      packed("r0 = r0 + 1; word 0xe000064000000000; mul signed; r1 = old(product); r2 = product; halt;");
  EXPECT_EQ(u.words.size(), 6u);
  EXPECT_EQ(u.words[1], 0xe000064000000000u);
}

/// The same program for a machine whose products come later.
tools::Ucode filled(const std::string& source, int multiply_ticks, const std::string& pack) {
  AssembleOptions o;
  o.multiply_ticks = multiply_ticks;
  o.pack = pack;
  o.fill_products = true;
  return assemble(source, "t.gia", o).ucode;
}

TEST(FillingProducts, ChangesNoProgramThatWaitsAlready) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const std::string source = testing::random_source(seed, 3, false);
    AssembleOptions o;
    o.multiply_ticks = 3;
    EXPECT_EQ(assemble(source, "t.gia", o).ucode, filled(source, 3, "none")) << "seed " << seed;
  }
}

TEST(FillingProducts, WaitsForTheProductOnEveryWayToItsWord) {
  const char* const source = "mul signed, goto a; b: r1 = r1 + 1; a: r0 = product; halt;";
  EXPECT_THROW(packed(source, 2), UserError);
  const tools::Ucode ucode = filled(source, 4, "none");
  EXPECT_EQ(ucode.words.size(), 7u);
  EXPECT_EQ(ucode.symbols.at("a"), 2u);
  EXPECT_THROW(filled("mul signed; r0 = product; if (zero) goto 3; halt;", 4, "none"), UserError);
}

TEST(FillingProducts, ChangesNoResult) {
  int longer = 0;
  for (std::uint32_t seed = 2001; seed <= 2200 && !::testing::Test::HasFailure(); ++seed) {
    const std::string source = testing::random_source(seed, 2, seed % 2 == 0);
    // What is `old` depends on how late products are, so such a program is another one.
    if (source.find("old(product") != std::string::npos) continue;
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + source);
    AssembleOptions plain;
    plain.multiply_ticks = 2;
    const tools::Ucode before = assemble(source, "t.gia", plain).ucode;
    const bps32::ProcessorState start = testing::random_state(seed);
    const testing::MachineRun wanted = testing::run_program(before, start, 5000);
    for (const char* pack : {"none", "full"}) {
      const tools::Ucode late = filled(source, 5, pack);
      expect_same(wanted, testing::run_program(late, start, 20000));
      longer += late.words.size() > before.words.size() ? 1 : 0;
    }
  }
  EXPECT_GT(longer, 20);
}

}  // namespace
}  // namespace dendro
