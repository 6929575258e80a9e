#include <nlohmann/json.hpp>

#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

void expect_as_qemu(const std::string& program, const std::string& arguments, const std::string& input = "") {
  const std::string before = input.empty() ? "" : "printf '" + input + "' | ",
                    after = input.empty() ? " </dev/null" : "";
  const Ran reference = run(before + qemu(program_file(program), arguments) + after);
  ASSERT_FALSE(reference.output.empty()) << reference.errors;
  for (const char* suffix : {"", "-unmapped"}) {
    const Ran ran = run(before + model(program_file(program + suffix), arguments) + after);
    EXPECT_EQ(reference.output, ran.output) << program << suffix << ran.errors;
    EXPECT_EQ(reference.status, ran.status) << program << suffix;
    EXPECT_EQ("", ran.errors);
  }
}

TEST(MipsPrograms, ArgumentsInputOutputAndExitCodeAreThoseOfQemu) {
  expect_as_qemu("mips_hello", "one 'two words' 3", "some input\\nmore");
}

TEST(MipsPrograms, InputLongerThanAPageIsRead) {
  std::string long_input;
  for (int i = 0; i < 700; ++i) long_input += "0123456789";
  expect_as_qemu("mips_hello", "x", long_input);
}

TEST(MipsPrograms, SixtyFourBitIntegersAreThoseOfQemu) { expect_as_qemu("mips_integers", ""); }

TEST(MipsPrograms, MathematicsIsThatOfQemu) { expect_as_qemu("mips_maths", "60"); }

TEST(MipsPrograms, AllocatorPagesAndFilesAreThoseOfQemu) { expect_as_qemu("mips_memory", scratch() + "/data"); }

TEST(MipsPrograms, CallsRefuseAddressesBehindUserSpaceAsQemuDoes) {
  for (const char* input : {"", "0123456789abcdef"}) {
    const std::string before = std::string("printf '") + input + "' | ";
    const Ran reference = run(before + qemu(elf("addresses"), "kernel"));
    ASSERT_EQ(0, reference.status) << reference.errors;
    const Ran ran = run(before + model(elf("addresses"), "kernel"));
    EXPECT_EQ(reference.output, ran.output);
    EXPECT_EQ(0, ran.status);
    EXPECT_EQ("", ran.errors);
  }
}

/// qemu puts its stack elsewhere.
TEST(MipsPrograms, CallsReachTheLastByteOfUserSpaceAndNoFurther) {
  const Ran ran = run(model(elf("addresses"), "top") + " </dev/null");
  EXPECT_EQ(std::string(64, 'x') + "\nfits 64, over -14, path -14\n", ran.output);
  EXPECT_EQ("", ran.errors);
}

TEST(MipsPrograms, MemoryGivenBackAndTakenAgainReadsZeroAsInQemu) { expect_as_qemu("mips_addresses", "break"); }

TEST(MipsPrograms, WhatTheFloatingPointUnitGivesUpOnIsFinishedAsQemuDoesIt) {
  expect_as_qemu("mips_denormals", "");
}

TEST(MipsPrograms, LoopsThatMeasureTheProcessorHaveTheResultsOfQemu) {
  expect_as_qemu("processor_figures_integers", "");
  expect_as_qemu("processor_figures_numbers", "");
  expect_as_qemu("processor_figures_numbers", "plain");
}

TEST(MipsPrograms, ALoopCostsInATableWhatItCostsAlone) {
  const std::string json = scratch() + "/run.json", table = scratch() + "/table.json";
  const Ran alone = run(model(program_file("processor_figures_integers"), "", "--level cycle --json " + json) + " </dev/null");
  ASSERT_EQ(0, alone.status) << alone.errors;
  const Ran row = run("XDG_CACHE_HOME=" + scratch() + " " DENDRO " table MO95 --row MO95-P8 --json " + table);
  ASSERT_EQ(0, row.status) << row.errors;
  const auto object = nlohmann::json::parse(read_file(json));
  const auto figure = nlohmann::json::parse(read_file(table))["rows"][0]["simulated"].get<double>();
  EXPECT_DOUBLE_EQ(object["cycles"].get<double>() / object["instructions"].get<double>(), figure);
}

TEST(MipsPrograms, ReportsFaultsWithPlaceAndCause) {
  struct Case {
    const char* what;
    const char* text;
  };
  for (const Case& c : {Case{"u", "AdEL"}, {"w", "AdES"}, {"n", "TLBL"}, {"k", "AdEL"}, {"d", "Bp"}, {"r", "RI"},
                         {"h", "TLBS"}}) {
    const Ran ran = run(model(elf("fault"), c.what));
    EXPECT_EQ(2, ran.status) << c.what;
    EXPECT_NE(std::string::npos, ran.errors.find(std::string("raised ") + c.text + " at 0x")) << ran.errors;
    EXPECT_NE(std::string::npos, ran.errors.find("(main+0x")) << ran.errors;
    EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n'));
  }
}

TEST(MipsPrograms, AnEndlessProgramEndsAtItsLimit) {
  const Ran ran = run(model(elf("fault"), "l", "--limit 100000"));
  EXPECT_EQ(2, ran.status);
  EXPECT_NE(std::string::npos, ran.errors.find("100000 instructions")) << ran.errors;
  EXPECT_NE(std::string::npos, ran.errors.find("(main+0x")) << ran.errors;
}

TEST(MipsPrograms, AStackThatOverflowsAndAnEndlessProgramSayWhoCalledThem) {
  for (const char* suffix : {"", "-unmapped"})
    for (const char* level : {"function", "estimate", "cycle", "clocked"}) {
      const Ran ran = run(model(elf(std::string("fault") + suffix), "c", std::string("--limit 20000 --level ") + level));
      EXPECT_EQ(2, ran.status) << level;
      std::size_t at = ran.errors.find("did not end within 20000 instructions (--limit); it was at 0x");
      for (const char* part : {"(spin+0x", ", called from 0x", "(outer+0x", "(main+0x", "(__start+0x"}) {
        at = ran.errors.find(part, at);
        EXPECT_NE(std::string::npos, at) << part << " at " << level << suffix << ": " << ran.errors;
      }
      EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n')) << ran.errors;
    }
  const Ran deep = run(model(elf("fault"), "s"));
  EXPECT_EQ(2, deep.status);
  EXPECT_NE(std::string::npos, deep.errors.find("raised TLBS at 0x")) << deep.errors;
  EXPECT_NE(std::string::npos, deep.errors.find("(deeper+0x")) << deep.errors;
}

TEST(MipsPrograms, TheJsonOfARunHasNoTimeAtFunction) {
  const std::string json = scratch() + "/run.json";
  const Ran ran = run(model(elf("hello"), "", "--level function --json " + json) + " </dev/null");
  ASSERT_EQ(0, ran.status) << ran.errors;
  const std::string text = read_file(json);
  for (const char* part : {"\"machine\": \"sgi-4d35\"", "\"level\": \"function\"", "\"cycles\": null",
                           "\"clock_hz\": 36000000", "\"exit_code\": 0"})
    EXPECT_NE(std::string::npos, text.find(part)) << part << "\n" << text;
}

TEST(MipsPrograms, AProfileAtCycleNamesTheFunctionsAndTheCauses) {
  const Ran ran = run(std::string(DENDRO) + " exec sgi-4d35 " + elf("integers") + " --level cycle --profile </dev/null");
  ASSERT_EQ(0, ran.status) << ran.errors;
  for (const char* part : {"cycles per instruction", "base", "data misses", "  main\n", "  (monitor)\n"})
    EXPECT_NE(std::string::npos, ran.errors.find(part)) << part << "\n" << ran.errors;
}

TEST(MipsPrograms, AnImpossibleMachineIsRefused) {
  for (const char* bytes : {"8388608", "1000000000000", "-1", "33554433"}) {
    const Ran ran =
        run(model(elf("hello"), "", std::string("--set memory.main_bytes=") + bytes) + " </dev/null");
    EXPECT_EQ(2, ran.status) << bytes;
    EXPECT_NE(std::string::npos, ran.errors.find("memory.main_bytes")) << ran.errors;
  }
}

TEST(MipsPrograms, CommandsThatCannotDriveTheMachineSaySo) {
  const std::string dendro = DENDRO;
  for (const std::string& command :
       {dendro + " run icosahedron --machine sgi-4d35", dendro + " levels icosahedron --machine sgi-4d35",
        model(elf("hello"), "", "--dump 0"),
        dendro + " record --exec sgi-4d35 " + elf("hello") + " --boundary sgi_4d35.display --out " +
            scratch() + "/t"}) {
    const Ran ran = run(command + " </dev/null");
    EXPECT_EQ(2, ran.status) << command << ran.errors;
    EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n')) << command << ran.errors;
  }
}

}  // namespace
}  // namespace dendro::mips
