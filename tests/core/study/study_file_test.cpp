#include "sim/study/study_file.h"

#include <cstdio>
#include <set>

#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

using config::Value;

class StudyFileTest : public fake::TestFolder {
 protected:
  Study study(const std::string& axes, const std::string& head = "", bool many = false) {
    return load_study(write("s.toml", "scene = \"toy\"\n" + head + axes), many);
  }
  std::vector<Value> values(const std::string& axis) { return study("[[axis]]\nkey = \"k\"\n" + axis).axes[0].values; }
  std::string axis_error(const std::string& axis, bool many = false) {
    return error_of([&] { study("[[axis]]\nkey = \"k\"\n" + axis, "", many); });
  }
};

std::vector<Value> integers(std::initializer_list<std::int64_t> list) { return {list.begin(), list.end()}; }

TEST_F(StudyFileTest, ListsKeepTheirTypes) {
  EXPECT_EQ((std::vector<Value>{std::int64_t{1}, 2.5, std::string("x"), true}), values("values = [1, 2.5, \"x\", true]\n"));
}

TEST_F(StudyFileTest, RangesIncludeBothEnds) {
  EXPECT_EQ(integers({1, 3, 5, 7}), values("from = 1\nto = 7\nstep = 2\n"));
  EXPECT_EQ(integers({1, 3, 5}), values("from = 1\nto = 6\nstep = 2\n"));
  EXPECT_EQ((std::vector<Value>{0.0, 0.5, 1.0}), values("from = 0.0\nto = 1\ncount = 3\n"));
  EXPECT_EQ(integers({0, 50, 100}), values("from = 0\nto = 100\ncount = 3\n"));
  EXPECT_EQ(11u, values("from = 0.0\nto = 1.0\nstep = 0.1\n").size()) << "steps that are no binary fractions";
}

TEST_F(StudyFileTest, LogarithmicRangesHaveEqualRatios) {
  EXPECT_EQ(integers({1, 10, 100, 1000}), values("scale = \"log\"\nfrom = 1\nto = 1000\ncount = 4\n"));
  const auto reals = values("scale = \"log\"\nfrom = 0.5\nto = 8.0\ncount = 5\n");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(0.5 * (1 << i), std::get<double>(reals[i]), 1e-12);
  EXPECT_EQ(integers({1, 2, 3}), values("scale = \"log\"\nfrom = 1\nto = 3\ncount = 9\n")) << "no value twice";
}

TEST_F(StudyFileTest, EmptyAndImpossibleAxesAreErrorsOfTheirLine) {
  EXPECT_EQ("s.toml:4: axis.0.values: the axis is empty", axis_error("values = []\n"));
  EXPECT_EQ("s.toml:6: axis.0.count: the axis is empty", axis_error("from = 1\nto = 2\ncount = 0\n"));
  EXPECT_NE(std::string::npos, axis_error("from = 3\nto = 2\nstep = 1\n").find("the range is empty"));
  EXPECT_NE(std::string::npos, axis_error("from = 1\nto = 2\n").find("either `step` or `count`"));
  EXPECT_NE(std::string::npos, axis_error("from = 1\nto = 2\nstep = 0\n").find("larger than zero"));
  EXPECT_NE(std::string::npos, axis_error("").find("needs `values`, or `from` and `to`"));
  EXPECT_NE(std::string::npos, axis_error("values = [1, 1]\n").find("1 is there twice"));
  EXPECT_NE(std::string::npos, axis_error("values = [[1]]\n").find("every item"));
  EXPECT_NE(std::string::npos, axis_error("scale = \"log\"\nfrom = 0\nto = 2\ncount = 3\n").find("above zero"));
  EXPECT_NE(std::string::npos, axis_error("valeus = [1]\n").find("valeus"));
  EXPECT_NE(std::string::npos, error_of([&] { study(""); }).find("at least one [[axis]]"));
  EXPECT_NE(std::string::npos,
            error_of([&] { study("[[axis]]\nkey = \"k\"\nvalues = [1]\n[[axis]]\nkey = \"k\"\nvalues = [2]\n"); })
                .find("two axes"));
}

TEST_F(StudyFileTest, AMillionRunsWantAYes) {
  const std::string million = "from = 1\nto = 1000000\nstep = 1\n";
  EXPECT_NE(std::string::npos, axis_error(million).find("1,000,000 runs, more than 10,000; say --yes"));
  EXPECT_EQ("no error", axis_error(million, true));
  const std::string grid =
      "[[axis]]\nkey = \"a\"\nfrom = 1\nto = 200\nstep = 1\n[[axis]]\nkey = \"b\"\nfrom = 1\nto = 200\nstep = 1\n";
  EXPECT_NE(std::string::npos, error_of([&] { study(grid); }).find("40,000 runs"));
  EXPECT_EQ(40000u, study(grid, "", true).runs());
  // Never held in memory, whatever the user says.
  EXPECT_NE(std::string::npos, axis_error("from = 0.0\nto = 1e12\nstep = 1e-3\n", true).find("too many"));
}

TEST_F(StudyFileTest, TheLastAxisVariesFastestAndLevelsSlowest) {
  const Study s = study("[[axis]]\nkey = \"a\"\nvalues = [1, 2]\n[[axis]]\nkey = \"b\"\nvalues = [\"x\", \"y\", \"z\"]\n",
                        "levels = [\"function\", \"cycle\"]\n[set]\n\"image.width\" = 9\n");
  ASSERT_EQ(12u, s.runs());
  EXPECT_EQ((std::vector<std::string>{"image.width=9", "a=1", "b=\"y\""}), s.settings_of(1));
  EXPECT_EQ((std::vector<std::string>{"image.width=9", "a=2", "b=\"x\""}), s.settings_of(9));
  EXPECT_EQ("function", s.level_of(5));
  EXPECT_EQ("cycle", s.level_of(6));
  std::set<std::vector<std::string>> all;
  for (std::size_t i = 0; i < 6; ++i) all.insert(s.settings_of(i));
  EXPECT_EQ(6u, all.size()) << "every combination once";
}

TEST_F(StudyFileTest, ValuesMayHaveNames) {
  const Study s = study("[[axis]]\nkey = \"a\"\nvalues = [2, 8]\nnames = [\"16x16\", \"8x8\"]\n");
  EXPECT_EQ("8x8", s.axes[0].text_of(1));
  EXPECT_EQ((std::vector<std::string>{"a=8"}), s.settings_of(1));
  EXPECT_FALSE(s.axes[0].numeric()) << "one beside the other in pictures";
  EXPECT_NE(std::string::npos, axis_error("values = [1, 2]\nnames = [\"x\"]\n").find("1 names for 2 values"));
  EXPECT_NE(std::string::npos, axis_error("values = [1, 2]\nnames = [\"x\", \"x\"]\n").find("there twice"));
}

TEST_F(StudyFileTest, ANarrowerMultiplierTakesTheTicksOfItsPartialProducts) {
  const Study s = load_study("multiplier-width", false);
  const StudyAxis& axis = s.axes.at(0);
  ASSERT_EQ("parameters.processor.multiply_ticks", axis.key);
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    int a = 0, b = 0;
    ASSERT_EQ(2, std::sscanf(axis.text_of(i).c_str(), "%dx%d", &a, &b));
    EXPECT_EQ(2 * (16 / a) * (16 / b), std::get<std::int64_t>(axis.values[i])) << axis.text_of(i);
  }
}

TEST_F(StudyFileTest, EveryValueIsFinite) {
  for (const char* list : {"values = [1.0, nan]\n", "values = [inf]\n"})
    EXPECT_NE(std::string::npos, axis_error(list).find("must be finite")) << list;
}

TEST_F(StudyFileTest, PointsOfARangeAreRoundNumbers) {
  const Study s = study("[[axis]]\nkey = \"a\"\nfrom = 2.2\nto = 7.0\nstep = 0.8\n");
  EXPECT_EQ("a=3.8", s.settings_of(2).back());
}

TEST_F(StudyFileTest, AnUnknownStudyNamesTheNearest) {
  EXPECT_NE(std::string::npos, error_of([&] { load_study("tick-tim", false); }).find("did you mean `tick-time`?"));
}

TEST_F(StudyFileTest, EveryStudyThatShipsCanBeRead) {
  EXPECT_LE(6u, built_in_studies().size());
  for (const BuiltInStudy& s : built_in_studies()) {
    EXPECT_EQ(s.description, load_study(s.name, false).description);
    EXPECT_FALSE(s.description.empty()) << s.name;
  }
}

}  // namespace
}  // namespace dendro::study
