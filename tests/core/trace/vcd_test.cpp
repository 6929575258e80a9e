#include "sim/trace/vcd.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "sim/base/error.h"

namespace dendro::trace {
namespace {

class Vcd : public ::testing::Test {
 protected:
  std::string path_ =
      (std::filesystem::path(::testing::TempDir()) /
       (std::string("vcd_test_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".vcd"))
          .string();
  void TearDown() override { std::filesystem::remove(path_); }
  std::string text() const {
    std::ostringstream all;
    all << std::ifstream(path_).rdbuf();
    return all.str();
  }
  std::string body() const {
    const std::string all = text(), end = "$enddefinitions $end\n";
    return all.substr(all.find(end) + end.size());
  }
};

TEST_F(Vcd, DeclaresSignalsInTheirScopes) {
  VcdWriter writer(path_, {});
  writer.add("cpu", "pc", 12);
  writer.add("memory", "card0.busy", 1);
  writer.add("cpu", "run", 1);
  writer.start("1 ps");
  writer.close();
  EXPECT_EQ(text(),
            "$version dendro $end\n$timescale 1 ps $end\n"
            "$scope module cpu $end\n$var wire 12 ! pc [11:0] $end\n$var wire 1 # run $end\n$upscope $end\n"
            "$scope module memory $end\n$scope module card0 $end\n$var wire 1 \" busy $end\n$upscope "
            "$end\n$upscope $end\n"
            "$enddefinitions $end\n");
}

TEST_F(Vcd, WritesOnlyChangesAndOnlyTimesThatHaveSome) {
  VcdWriter writer(path_, {});
  const auto a = writer.add("u", "a", 1), b = writer.add("u", "b", 8);
  writer.start("1 ps");
  for (int t = 0; t < 5; ++t) {
    writer.at(t);
    writer.set(a, t >= 2);
    writer.set(b, t == 3 ? 0x1A5 : 0);
  }
  writer.close();
  EXPECT_EQ(body(), "#0\n0!\nb0 \"\n#2\n1!\n#3\nb10100101 \"\n#4\nb0 \"\n#5\n");
}

TEST_F(Vcd, WideSignalsKeepAllTheirBits) {
  VcdWriter writer(path_, {});
  const auto wide = writer.add("u", "wide", 70);
  writer.start("1 ps");
  writer.at(0);
  const std::uint64_t words[2] = {1, 0xFF};  // six bits of the second word exist
  writer.set_wide(wide, words);
  writer.at(1);
  writer.set_wide(wide, words);
  writer.at(2);
  writer.set(wide, 1);
  writer.close();
  EXPECT_EQ(body(), "#0\nb111111" + std::string(63, '0') + "1 !\n#2\nb1 !\n#3\n");
}

TEST_F(Vcd, KeepsToTheUnitsAndTimesOfItsWindow) {
  VcdWriter writer(path_, {10, 20, {"b"}});
  const auto a = writer.add("a", "x", 1), b = writer.add("b", "x", 1);
  writer.start("1 ns");
  EXPECT_FALSE(writer.wants(9));
  EXPECT_TRUE(writer.wants(10));
  EXPECT_TRUE(writer.wants(19));
  EXPECT_FALSE(writer.wants(20));
  writer.at(10);
  writer.set(a, 1);
  writer.set(b, 1);
  writer.close();
  EXPECT_EQ(body(), "#10\n1!\n#11\n");
  EXPECT_EQ(text().find("module a"), std::string::npos);
}

TEST_F(Vcd, CodesStayUniqueBeyondOneCharacter) {
  VcdWriter writer(path_, {});
  std::vector<VcdWriter::Signal> signals;
  for (int i = 0; i < 300; ++i) signals.push_back(writer.add("u", "s" + std::to_string(i), 1));
  writer.start("1 ps");
  writer.at(0);
  for (const auto s : signals) writer.set(s, 1);
  writer.close();
  std::set<std::string> codes;
  std::istringstream lines(body());
  for (std::string line; std::getline(lines, line);)
    if (line[0] == '1') codes.insert(line.substr(1));
  EXPECT_EQ(codes.size(), 300u);
}

TEST_F(Vcd, AFileThatCannotBeWrittenIsTheUsersErrorBeforeTheRun) {
  EXPECT_THROW(VcdWriter("/nonexistent/folder/x.vcd", {}), UserError);
}

TEST_F(Vcd, AnUnknownUnitOrAnEmptyWindowIsTheUsersError) {
  VcdWriter writer(path_, {0, 10, {"cpux"}});
  writer.add("cpu", "pc", 12);
  try {
    writer.start("1 ps");
    FAIL() << "no error";
  } catch (const UserError& e) {
    EXPECT_STREQ(e.what(), "waveform: no unit \"cpux\"; there are cpu");
  }
  EXPECT_THROW(VcdWriter(path_, {5, 5, {}}), UserError);
}

TEST_F(Vcd, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  VcdWriter writer("/dev/full", {});
  const auto a = writer.add("u", "a", 1);
  writer.start("1 ps");
  writer.at(0);
  writer.set(a, 1);
  EXPECT_THROW(writer.close(), UserError);
}

}  // namespace
}  // namespace dendro::trace
