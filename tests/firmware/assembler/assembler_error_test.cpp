#include <gtest/gtest.h>

#include <random>

#include "firmware/tools/assembler.h"
#include "firmware/tools/source_error.h"
#include "tests/firmware/assembler/assembler_programs.h"

namespace dendro {
namespace {

using tools::assemble;
using tools::AssembleOptions;

/// The message for a source that must be refused, in both packings.
std::string refusal(const std::string& source, AssembleOptions o = {}) {
  std::string first;
  for (const char* pack : {"none", "full"}) {
    o.pack = pack;
    try {
      assemble(source, "t.gia", o);
      return "accepted with pack " + o.pack;
    } catch (const UserError& e) {
      if (!first.empty() && first != e.what()) return first + " BUT " + e.what();
      first = e.what();
    }
  }
  return first;
}

void expect_refused(const std::string& source, const std::string& place, const std::string& part,
                    AssembleOptions o = {}) {
  const std::string message = refusal(source, o);
  EXPECT_EQ(message.rfind("t.gia:" + place, 0), 0u) << source << "\n" << message;
  EXPECT_NE(message.find(part), std::string::npos) << source << "\n" << message;
}

TEST(AssemblerErrors, CarryFileLineAndColumn) {
  try {
    assemble("nop;\n  r0 = unknown;\n", "dir/t.gia", {});
    FAIL();
  } catch (const tools::SourceError& e) {
    EXPECT_STREQ(e.what(), "dir/t.gia:2:8: 'unknown' is no register, constant or D bus source");
    EXPECT_EQ(e.file(), "dir/t.gia");
    EXPECT_EQ(e.line(), 2);
    EXPECT_EQ(e.column(), 8);
  }
}

TEST(AssemblerErrors, NameTwoWritersOfOneField) {
  expect_refused("r0 = 1, r1 = r2; halt;", "1:9:", "two writers of the field 'func'");
  expect_refused("bus_x = bus_y = r0; halt;", "1:9:", "two writers of the field 'ydst'");
  expect_refused("r0 = r1 = r2; halt;", "1:6:", "two writers of the field 'b'");
  expect_refused("read lores, write lores; halt;", "1:13:", "two writers of the field 'busop'");
  expect_refused("mul signed, mul signed; halt;", "1:13:", "two writers of the field 'mul'");
  expect_refused("a: goto a, return;", "1:12:", "two writers of the field 'seq'");
  expect_refused("r0 = r1 -> flags, flags; halt;", "1:19:", "two writers of the field 'latch'");
}

TEST(AssemblerErrors, NameTwoUsesOfImm) {
  expect_refused("a: r0 = 5, goto a;", "1:9:", "two different uses of the imm field");
  expect_refused("scratch s[2]; s[0] = r0 = s[1]; halt;", "1:15:", "two different uses of the imm field");
  EXPECT_NO_THROW(assemble("scratch s[2]; s[1] = r0 = s[1]; halt;", "t.gia", {}));
}

TEST(AssemblerErrors, NameAFlagThatIsReadBeforeItIsLatched) {
  expect_refused("a: r0 - r1 -> flags, if (zero) goto a; halt;",
                 "1:26:", "'zero' is read before it is latched");
  EXPECT_NO_THROW(assemble("r0 -> flags; a: r0 - r1 -> flags, if (old(zero)) goto a; halt;", "t.gia", {}));
  expect_refused("a: r0 = r0 + 1; if (!less) goto a; halt;", "1:17:", "'less' is read before it is latched");
  expect_refused("call s; halt; s: if (carry) return; return;",
                 "1:18:", "'carry' is read before it is latched");
  EXPECT_NO_THROW(assemble("call s; if (carry) goto e; e: halt; s: r0 -> flags; return;", "t.gia", {}));
}

TEST(AssemblerErrors, NameAProductThatIsTakenTooEarly) {
  expect_refused("mul signed; r0 = product; halt;", "1:13:", "the product is taken 1 word too early");
  AssembleOptions o;
  o.multiply_ticks = 4;
  expect_refused("mul signed;\nnop;\nr0 = product_hi; halt;",
                 "3:1:", "the product is taken 2 words too early", o);
  expect_refused("mul signed, goto a; nop; a: r0 = product; halt;", "1:29:", "too early");
  EXPECT_NO_THROW(assemble("mul signed; nop; r0 = product; halt;", "t.gia", {}));
  EXPECT_NO_THROW(assemble("mul signed; r0 = old(product); halt;", "t.gia", {}));
  EXPECT_NO_THROW(assemble("mul signed; nop; r0 = product, mul signed; halt;", "t.gia", {}));
}

TEST(AssemblerErrors, NameAMultiplicationThatIsStartedTooEarly) {
  expect_refused("mul signed; mul unsigned; halt;", "1:13:", "is started while one is under way");
}

TEST(AssemblerErrors, NameTheSixthStackEntry) {
  std::string five =
      "call a; halt; a: call b; return; b: call c; return; c: call d; return; d: call e; return; e: ";
  EXPECT_NO_THROW(assemble(five + "return;", "t.gia", {}));
  expect_refused(five + "\ncall f; return; f: return;",
                 "2:1:", "the stack holds 5 entries and this is number 6");
  expect_refused("a: call a; return;", "1:4:", "the stack holds 5");
  expect_refused("push; push; push; push; push; push; halt;", "1:31:", "the stack holds 5");
}

TEST(AssemblerErrors, NameStoresThatOverflow) {
  std::string many = "a0: ";
  for (int i = 1; i <= 4096; ++i) many += "goto a" + std::to_string(i) + ";\na" + std::to_string(i) + ": ";
  expect_refused(many + "goto a0;", "4097:", "4096 fit");
  AssembleOptions o;
  o.control_words = 3;
  expect_refused("a: goto b;\nb: goto c;\nc: goto d;\nd: goto a;",
                 "4:4:", "control store overflow: this is word 4 of 4 and 3 fit", o);
  expect_refused("scratch a[8000];\nscratch b[200];\nhalt;", "2:9:", "scratchpad overflow");
  expect_refused("scratch a[8193];\nhalt;", "1:9:", "the scratchpad has 8192");
  expect_refused("scratch a[2] @ 8191;\nhalt;", "1:9:", "overflows the scratchpad");
  o = {};
  o.scratch_words = 4;
  expect_refused("scratch a[4];\nr0 = 0x12345678; halt;", " ",
                 "no word below 4 is left for the constant 0x12345678", o);
}

TEST(AssemblerErrors, NameSymbolsThatAreMissingOrTwice) {
  expect_refused("goto nowhere;", "1:6:", "the label 'nowhere' is not defined");
  expect_refused("a: nop; a: halt;", "1:9:", "the label 'a' is defined twice: first in line 1");
  expect_refused("const a = 1; reg a = r1; halt;", "1:18:", "'a' is declared twice");
  expect_refused("const a = b; halt;", "1:11:", "'b' is not defined");
  expect_refused("scratch a; goto a;", "1:17:", "the branch");
  expect_refused("const q = 1; halt;", "1:7:", "a word of the language");
  expect_refused("r0: halt;", "1:1:", "is a register and no label");
}

TEST(AssemblerErrors, NameUnknownConditionsAndWords) {
  expect_refused("a: if (zer0) goto a;", "1:8:", "'zer0' is no condition: always, zero");
  expect_refused("read pixels; halt;", "1:6:", "the bus function is word, lores, hires");
  expect_refused("mul fast; halt;", "1:5:", "mul is followed by signed or unsigned");
  expect_refused("r0 = $; halt;", "1:6:", "means nothing");
  expect_refused("r0 = 09; halt;", "1:6:", "a number starts with");
}

TEST(AssemblerErrors, ExplainOperandsThatTheAluCannotTake) {
  expect_refused("r0 = bus + product; halt;", "1:12:", "one D source");
  expect_refused("r0 = r1 + r2; halt;", "1:11:", "field B is both S and destination");
  expect_refused("r0 = q + q; halt;", "1:10:", "q cannot be both operands");
  expect_refused("r0 = ~r0 & r1; halt;", "1:12:", "both are field B");
  expect_refused("bus_x = (r0 + r1) >> 1; halt;", "1:9:", "always written to a register");
  expect_refused("r0 = (r0 + r1) >> 2; halt;", "1:19:", "the shifter moves by 1");
  expect_refused("r0 = ror8(r1); halt;", "1:6:", "turns the D bus");
  expect_refused("r0 = div_step(r0, r1); halt;", "1:6:", "writes 'register:q'");
  expect_refused("r0 = #5000; halt;", "1:6:", "does not fit the 12 signed bits");
  expect_refused("scratch s[2]; r0 = s[2]; halt;", "1:20:", "lies outside");
  expect_refused("r0 = spad[4096]; halt;", "1:6:", "out of reach of imm");
  expect_refused("r0 + r1; halt;", "1:1:", "this value goes nowhere");
}

TEST(AssemblerErrors, NameStructureThatDoesNotClose) {
  expect_refused("r0 -> flags; if (zero) { nop;", "1:14:", "never closed");
  expect_refused("}", "1:1:", "closes nothing");
  expect_refused("break; halt;", "1:1:", "outside a loop");
  expect_refused("for 3 { for 2 { nop; } } halt;", "1:9:", "the counter is in use by the loop of line 1");
  expect_refused("for 3 { counter = 1; } halt;", "1:9:", "the counter is in use");
  expect_refused("for 4097 { nop; } halt;", "1:5:", "1 to 4096 times");
}

TEST(AssemblerErrors, NameAProgramThatRunsOffItsEnd) {
  expect_refused("nop;\nr0 = 1;", "2:1:", "runs off its end");
  expect_refused("r0 -> flags; if (zero) goto e; halt; e:", "1:14:", "leads behind the last word");
  expect_refused("// nothing\n", "2:1:", "there is no microinstruction");
}

TEST(AssemblerErrors, NothingButAUserErrorComesOfMutatedSources) {
  std::mt19937 random(20);
  static const std::string kBits[] = {
      "(", ")", "{", "}",          ";",   "=",     "q",  ":",  "[",    "sar",  "++",   "if",     "~",
      "-", "#", "@", "9999999999", "old", "flags", "\n", "\t", "\x80", "word", "push", "scratch"};
  int accepted = 0, refused = 0;
  for (std::uint32_t seed = 0; seed < 1500; ++seed) {
    std::string source = testing::random_source(seed % 37, 2, true);
    for (int n = 1 + static_cast<int>(random() % 3); n > 0; --n) {
      const std::size_t at = random() % source.size();
      switch (random() % 3) {
        case 0:
          source.erase(at, 1 + random() % 6);
          break;
        case 1:
          source.insert(at, kBits[random() % std::size(kBits)]);
          break;
        default:
          source[at] = static_cast<char>(random() % 256);
          break;
      }
    }
    AssembleOptions o;
    o.pack = seed % 2 ? "full" : "none";
    try {
      assemble(source, "t.gia", o);
      ++accepted;
    } catch (const UserError& e) {
      ++refused;
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << "seed " << seed;
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_GT(refused, 500);
}

TEST(AssemblerErrors, DeepNestingIsRefused) {
  const std::string deep(100000, '(');
  EXPECT_THROW(assemble("const a = " + deep + "1;", "t.gia", {}), UserError);
  EXPECT_THROW(assemble("r0 = " + deep + "1;", "t.gia", {}), UserError);
  EXPECT_THROW(assemble("r0 = " + std::string(100000, '-') + "1;", "t.gia", {}), UserError);
  std::string sums = "const a = ";
  for (int i = 0; i < 100000; ++i) sums += "(1+";
  EXPECT_THROW(assemble(sums, "t.gia", {}), UserError);
}

}  // namespace
}  // namespace dendro
