#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "firmware/tools/assembler.h"
#include "firmware/tools/source_error.h"
#include "tests/firmware/assembler/assembler_machine.h"

namespace dendro {
namespace {

using tools::AssembleOptions;

AssembleOptions with_files(std::map<std::string, std::string> files) {
  AssembleOptions options;
  options.include = [files = std::move(files)](const std::string& path) -> std::optional<std::string> {
    const auto it = files.find(path);
    return it == files.end() ? std::nullopt : std::optional(it->second);
  };
  return options;
}

std::string refusal(const std::string& source, const AssembleOptions& options) {
  try {
    tools::assemble(source, "main.gia", options);
    return "accepted";
  } catch (const UserError& e) {
    return e.what();
  }
}

TEST(AssemblerIncludes, StandBehindTheSourceAndOnlyOnce) {
  const AssembleOptions files = with_files(
      {{"a.gia", "include \"b.gia\";\nsub_a: return;\n"}, {"b.gia", "include \"a.gia\";\nsub_b: return;"}});
  const auto included = tools::assemble(
      "include \"a.gia\";\ninclude \"b.gia\"; // again\nstart: call sub_a;\ncall sub_b;\nhalt;", "main.gia",
      files);
  const auto written =
      tools::assemble("start: call sub_a;\ncall sub_b;\nhalt;\nsub_a: return;\nsub_b: return;", "main.gia");
  EXPECT_EQ(included.ucode.words, written.ucode.words);
  EXPECT_EQ(included.ucode.symbols, written.ucode.symbols);
}

TEST(AssemblerIncludes, ErrorsNameTheFileAndLineWhereTheTextWasWritten) {
  const AssembleOptions files = with_files({{"a.gia", "\nnop;\n  r0 = unknown;\n"}});
  EXPECT_EQ(refusal("include \"a.gia\";\nhalt;", files).rfind("a.gia:3:", 0), 0u)
      << refusal("include \"a.gia\";\nhalt;", files);
  EXPECT_EQ(refusal("include \"a.gia\";\nhalt\n;r0 = what;", files).rfind("main.gia:3:", 0), 0u);
  EXPECT_EQ(refusal("nop;\ninclude \"b.gia\";\nhalt;", files),
            "main.gia:2:1: there is no file 'b.gia' to include");
  EXPECT_EQ(refusal("nop; \ninclude b.gia;\nhalt;", files),
            "main.gia:2:1: an include stands on a line of its own: include \"PATH\";");
}

std::string random_source() {
  std::ifstream file(RANDOM_GIA);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Numbers that the routine gives for these seeds, as bus writes show them.
std::vector<std::uint32_t> draws(const std::vector<std::uint32_t>& seeds, int count,
                                 const std::string& pack) {
  std::string list;
  for (const std::uint32_t seed : seeds) list += fmt::format("{}{}", list.empty() ? "" : ", ", seed);
  AssembleOptions options = with_files({{"random.gia", random_source()}});
  options.pack = pack;
  const auto assembly = tools::assemble(
      fmt::format("include \"random.gia\";\nreg s; reg draws; reg left;\nscratch next_seed[1];\n"
                  "scratch seeds[{}] = {{{}}};\nentry start;\nstart: left = {};\ndraws = 0;\n"
                  "s = seeds; next_seed[0] = s;\nagain: call draw;\nbus_data = s;\nwrite word;\n"
                  "left = left - 1 -> flags;\nif (!zero) goto again;\nhalt;\n",
                  seeds.size(), list, count),
      "main.gia", options);
  const testing::MachineRun run =
      testing::run_program(assembly.ucode, testing::random_state(7), count * 20 + 100);
  EXPECT_TRUE(run.halted);
  std::vector<std::uint32_t> numbers;
  for (const auto& [address, function, data, write] : run.accesses)
    if (write) numbers.push_back(data & 0xFFFF);
  return numbers;
}

TEST(RandomNumbers, AreTheMultiplicativeSequenceWithANewSeedEvery512) {
  const std::vector<std::uint32_t> seeds = {1, 0xFFFF, 0x8001};
  for (const char* pack : {"none", "full"}) {
    const std::vector<std::uint32_t> numbers = draws(seeds, 1300, pack);
    ASSERT_EQ(numbers.size(), 1300u);
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      expected = i % 512 == 0 ? seeds[i / 512] : expected * 25173 % 65536;
      ASSERT_EQ(numbers[i], expected) << pack << " " << i;
    }
  }
}

TEST(RandomNumbers, HaveThePeriodThatTheMultiplierPromises) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t s = 12345; seen.insert(s).second;) s = s * 25173 % 65536;
  EXPECT_EQ(seen.size(), 16384u);
}

}  // namespace
}  // namespace dendro
