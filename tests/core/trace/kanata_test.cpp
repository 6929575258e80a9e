#include "sim/trace/kanata.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/base/error.h"

namespace dendro::trace {
namespace {

TEST(Kanata, WritesTimeOnlyWhereSomethingHappens) {
  const std::string path = (std::filesystem::path(::testing::TempDir()) / "kanata_test.log").string();
  KanataWriter writer(path);
  writer.at(7);
  writer.begin(0, 100);
  writer.text(0, 0, "00000010: nop");
  writer.stage(0, 0, "IF");
  writer.at(8);
  writer.at(10);
  writer.stage(0, 0, "RD");
  writer.stage(0, 1, "fp");
  writer.at(11);
  writer.end(0, 1, "fp");
  writer.retire(0, 0, false);
  writer.begin(1, 101);
  writer.retire(1, 1, true);
  writer.close();
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  std::filesystem::remove(path);
  EXPECT_EQ(all.str(),
            "Kanata\t0004\nC=\t7\nI\t0\t100\t0\nL\t0\t0\t00000010: "
            "nop\nS\t0\t0\tIF\nC\t3\nS\t0\t0\tRD\nS\t0\t1\tfp\n"
            "C\t1\nE\t0\t1\tfp\nR\t0\t0\t0\nI\t1\t101\t0\nR\t1\t1\t1\n");
}

TEST(Kanata, AFileThatCannotBeWrittenIsTheUsersMistake) {
  EXPECT_THROW(KanataWriter("/nowhere/at/all"), UserError);
}

}  // namespace
}  // namespace dendro::trace
