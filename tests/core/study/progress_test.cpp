#include "sim/study/progress.h"

#include <gtest/gtest.h>

namespace dendro::study {
namespace {

TEST(ProgressLine, SaysShareAndTimeLeftOnlyWhenTheLengthIsKnown) {
  RunProgress run{"pine", "pass_1", 25'000'000, 0, 5e6, 2.0};
  EXPECT_EQ("pine: pass_1, 5 s simulated, 12.5 million ticks a second", progress_line(run));
  run.expected = 100'000'000;
  EXPECT_EQ("pine: pass_1, 25 %, 5 s simulated, 12.5 million ticks a second, 6 s left", progress_line(run));
}

TEST(ProgressLine, NeverSaysMoreThanAllOrLessThanNothing) {
  const RunProgress run{"a", "b", 11, 10, 0, 1.0};
  EXPECT_NE(std::string::npos, progress_line(run).find("100 %"));
  EXPECT_NE(std::string::npos, progress_line(run).find(", 0 s left"));
}

}  // namespace
}  // namespace dendro::study
