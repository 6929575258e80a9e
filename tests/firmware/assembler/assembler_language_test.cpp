#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "firmware/tools/assembler.h"
#include "models/parts/bps32/bps32_isa.h"
#include "tests/firmware/assembler/assembler_machine.h"

namespace dendro {
namespace {

using namespace bps32;
using tools::assemble;

std::uint64_t word(const std::string& statement) {
  return assemble(statement + "; halt;", "t.gia", {}).ucode.words[0];
}
unsigned field(const std::string& statement, const Field& f) { return get(word(statement), f); }

testing::MachineRun run(const std::string& source) {
  testing::MachineRun r =
      testing::run_program(assemble(source, "t.gia", {}).ucode, testing::random_state(1), 20000);
  EXPECT_TRUE(r.halted) << source;
  return r;
}

TEST(AssemblerLanguage, AnEmptyStatementIsTheNop) { EXPECT_EQ(word("nop"), nop()); }

TEST(AssemblerLanguage, PutsTheDestinationRegisterIntoFieldB) {
  EXPECT_EQ(field("r3 = r3 - r5", kFunc), kSMinusR);
  EXPECT_EQ(field("r3 = r5 - r3", kFunc), kRMinusS);
  for (const char* s : {"r3 = r3 - r5", "r3 = r5 - r3"}) {
    EXPECT_EQ(field(s, kB), 3u);
    EXPECT_EQ(field(s, kA), 5u);
    EXPECT_EQ(field(s, kCarry), kCarryOne);
  }
}

TEST(AssemblerLanguage, AddsAndSubtractsOneWithoutImm) {
  EXPECT_EQ(field("r3 = r3 + 1", kDsrc), kDNone);
  EXPECT_EQ(field("r3 = r3 - 1", kDsrc), kDNone);
  EXPECT_EQ(run("r3 = 7; r3 = r3 + 1; r4 = 7; r4 = r4 - 1; halt;").state.ram[3], 8u);
  EXPECT_EQ(run("r3 = 7; r3 = r3 + 1; r4 = 7; r4 = r4 - 1; halt;").state.ram[4], 6u);
}

TEST(AssemblerLanguage, BringsEveryConstantOverImmOrThePool) {
  for (const std::uint32_t value : {0u, 1u, 2047u, 0xFFFFF800u, 0xFFFFFFFFu, 2048u, 0xFF0000u, 0x7FF00u,
                                    0x12345678u, 0x80000000u, 0xFFFF0FFFu}) {
    const auto r =
        run("r0 = " + std::to_string(value) + "; r1 = 3; r1 = r1 ^ " + std::to_string(value) + "; halt;");
    EXPECT_EQ(r.state.ram[0], value);
    EXPECT_EQ(r.state.ram[1], value ^ 3u);
  }
  EXPECT_TRUE(assemble("r0 = 0xFF0000; halt;", "t.gia", {}).ucode.scratch_data.empty());
  EXPECT_EQ(assemble("r0 = 0x12345678; r1 = 0x12345678; halt;", "t.gia", {}).ucode.scratch_data.size(), 1u);
}

TEST(AssemblerLanguage, WritesTheYBusAndARegisterInOneWord) {
  const std::uint64_t w = word("bus_x = r1 = r1 + r2");
  EXPECT_EQ(get(w, kYdst), kYBusX);
  EXPECT_EQ(get(w, kDest), kRam);
}

TEST(AssemblerLanguage, CarriesThroughTwoWords) {
  const auto r = run("r0 = -1; r1 = 5; r2 = 1; r0 = r0 + r2, flags; r1 = r1 + 0 + carry; halt;");
  EXPECT_EQ(r.state.ram[0], 0u);
  EXPECT_EQ(r.state.ram[1], 6u);
  const auto s = run("r0 = 0; r1 = 5; r2 = 1; r0 = r0 - r2, flags; r1 = r1 - 0 - borrow; halt;");
  EXPECT_EQ(s.state.ram[0], 0xFFFFFFFFu);
  EXPECT_EQ(s.state.ram[1], 4u);
}

TEST(AssemblerLanguage, RunsALoopAsOftenAsItSays) {
  EXPECT_EQ(run("r0 = 0; for 10 { r0 = r0 + 3; } halt;").state.ram[0], 30u);
  EXPECT_EQ(run("r0 = 0; r1 = 7; loop (r1) { r0 = r0 + 2; } halt;").state.ram[0], 14u);
  EXPECT_EQ(run("r0 = 0; r1 = 5; r1 -> flags; while (!zero) { r0 = r0 + 2; r1 = r1 - 1, flags; } halt;")
                .state.ram[0],
            10u);
  EXPECT_EQ(run("r0 = 0; r1 = 5; do { r0 = r0 + 2; r1 = r1 - 1, flags; } while (!zero); halt;").state.ram[0],
            10u);
  EXPECT_EQ(run("r0 = 0; r0 -> flags; while (!zero) { r0 = 9; } halt;").state.ram[0], 0u);
  EXPECT_EQ(run("r0 = 0; forever { r0 = r0 + 1; r0 - 4 -> flags; if (zero) { break; } } halt;").state.ram[0],
            4u);
}

TEST(AssemblerLanguage, TakesOneSideOfAnIf) {
  const std::string tail = "if (negative) { r1 = 1; } else { r1 = 2; } halt;";
  EXPECT_EQ(run("r0 = 5; r0 - 6 -> flags;" + tail).state.ram[1], 1u);
  EXPECT_EQ(run("r0 = 6; r0 - 6 -> flags;" + tail).state.ram[1], 2u);
}

TEST(AssemblerLanguage, CallsAndReturns) {
  EXPECT_EQ(run("entry main; twice: r0 = r0 + r0; return; main: r0 = 3; call twice; call twice; halt;")
                .state.ram[0],
            12u);
}

TEST(AssemblerLanguage, BranchesThroughATableOfLabels) {
  const std::string s =
      "r0 = 2; seq = r0 + #table, goto seq; table: goto a; goto b; goto c; a: r1 = 10, halt;"
      "b: r1 = 11, halt; c: r1 = 12, halt;";
  for (const char* pack : {"none", "full"}) {
    tools::AssembleOptions o;
    o.pack = pack;
    EXPECT_EQ(testing::run_program(assemble(s, "t.gia", o).ucode, testing::random_state(1), 100).state.ram[1],
              12u);
  }
}

TEST(AssemblerLanguage, ReachesEverySequencerOperation) {
  for (unsigned op = 0; op < 16; ++op) {
    const bool target =
        op == 1 || op == 2 || op == 3 || (op >= 5 && op <= 7) || op == 9 || op == 11 || op == 12 || op == 15;
    std::string s = std::string("if (host_flag) ") + am2910::kOpNames[op] +
                    (op == 4    ? " 3"
                     : op == 12 ? " 4"
                     : target   ? " e"
                                : "");
    s += "; e: goto e";
    EXPECT_EQ(field(s, kSeq), op) << s;
    EXPECT_EQ(field(s, kCond), kHostFlag) << s;
  }
}

TEST(AssemblerLanguage, ReachesEverySourceDestinationAndCondition) {
  const char* sources[] = {"none",    "bus",         "spad[3]",    "spad[sar]", "spad[sar++]",
                           "product", "product_hi",  "product_lo", "#5",        "counter",
                           "status",  "bus_address", "sar"};
  for (unsigned d = 0; d < std::size(sources); ++d)
    EXPECT_EQ(field(std::string("r1 = ") + sources[d], kDsrc), d);
  const char* places[] = {"bus_x", "bus_y", "bus_address", "bus_data", "spad[3]", "spad[sar]", "spad[sar++]",
                          "sar",   "mul_x", "mul_x_hi",    "mul_y",    "status",  "seq"};
  for (unsigned y = 0; y < std::size(places); ++y) {
    EXPECT_EQ(field(std::string(places[y]) + " = r1", kYdst), y + 1);
  }
  for (unsigned c = 0; c < 16; ++c)
    EXPECT_EQ(field(std::string("if (!old(") + kCondNames[c] + ")) goto 0", kCond), c);
}

TEST(AssemblerLanguage, ReachesEveryFunctionShiftAndSpecialFunction) {
  const char* functions[] = {"-1",      "r1 - r2",    "r2 - r1",    "r1 + r2",  "r1",         "~r1",
                             "r2",      "~r2",        "0",          "~r2 & r1", "~(r1 ^ r2)", "r1 ^ r2",
                             "r1 & r2", "~(r1 | r2)", "~(r1 & r2)", "r1 | r2"};
  for (unsigned f = 0; f < 16; ++f)
    EXPECT_EQ(field(std::string("r1 = ") + functions[f], kFunc), f) << functions[f];
  const char* shifts[] = {"r1 = r1 >> 1 keep",
                          "r1 = r1 >> 1",
                          "r1:q = r1 >> 1 keep",
                          "r1:q = r1 >> 1",
                          "r1 = r1",
                          "q = q >> 1",
                          "q = r1",
                          "r1 = q = r1",
                          "r1 = r1 << 1 keep",
                          "r1 = r1 << 1",
                          "r1:q = r1 << 1 keep",
                          "r1:q = r1 << 1",
                          "bus_x = r1",
                          "q = q << 1",
                          "r1 = spread(r1, sign)"};
  for (unsigned d = 0; d < std::size(shifts); ++d) EXPECT_EQ(field(shifts[d], kDest), d) << shifts[d];
  const char* specials[] = {
      "r1:q = umul_step(r1, r2)",        "r1:q = smul_step(r1, r2)", "r1 = increment(r1)",
      "r1 = sign_magnitude(r1)",         "r1:q = smul_last(r1, r2)", "r1:q = normalize(r1)",
      "r1:q = double_normalize(r1, r2)", "r1:q = div_step(r1, r2)",  "r1:q = div_correct(r1, r2)"};
  const unsigned codes[] = {0, 2, 4, 5, 6, 8, 10, 12, 14};
  for (unsigned i = 0; i < std::size(specials); ++i) {
    EXPECT_EQ(field(specials[i], kDest), codes[i]);
    EXPECT_EQ(field(specials[i], kFunc), kSpecial);
  }
}

TEST(AssemblerLanguage, PlacesScratchAreasApart) {
  const auto u =
      assemble("scratch a[3]; scratch b[2] @ 1; scratch c; scratch big[7000]; halt;", "t.gia", {}).ucode;
  EXPECT_EQ(u.scratch.at("b").address, 1u);
  EXPECT_EQ(u.scratch.at("a").address, 3u);
  EXPECT_EQ(u.scratch.at("c").address, 0u);
  EXPECT_EQ(u.scratch.at("big").address, 8192u - 7000u);
}

TEST(AssemblerLanguage, TheListingShowsAddressesWordsLinesAndTicks) {
  const auto a = assemble(
      "entry go;\ngo:\n  r0 = r0 + 1;  // count\n  r0 - r1 -> flags;\n  if (zero) goto go;\n  halt;\n",
      "t.gia", {});
  const std::string text = tools::listing(a);
  EXPECT_NE(text.find("go:\n000  e000022000100000"), std::string::npos) << text;
  EXPECT_NE(text.find("3  r0 = r0 + 1;  // count"), std::string::npos) << text;
  EXPECT_NE(text.find("-- 000 to 002: 3 ticks"), std::string::npos) << text;
  EXPECT_NE(text.find("-- 003 to 003: 1 tick\n"), std::string::npos) << text;
}

TEST(AssemblerLanguage, TheExamplesOfTheDocumentationAssemble) {
  std::ifstream file(ASSEMBLER_DOCS);
  ASSERT_TRUE(file) << ASSEMBLER_DOCS;
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  const std::regex block("```gia\n([^`]*)```");
  int examples = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), block), end; it != end; ++it, ++examples) {
    for (const char* pack : {"none", "full"}) {
      tools::AssembleOptions o;
      o.pack = pack;
      const auto u = assemble((*it)[1].str(), "microassembler.md", o).ucode;
      const std::string words = std::string(pack) + ": " + std::to_string(u.words.size()) + " words";
      EXPECT_NE(text.find(words), std::string::npos) << "the page does not say '" << words << "'";
    }
  }
  EXPECT_EQ(examples, 1);
}

}  // namespace
}  // namespace dendro
