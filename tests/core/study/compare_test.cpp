#include "sim/study/compare.h"

#include <filesystem>

#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

/// Run directories of 4 x 2 pixels, made by hand.
class CompareTest : public fake::TestFolder {
 protected:
  /// Depths of a register up to `most`; the reference as shares of its range, 1 where nothing is covered.
  std::string run(const std::string& name, int most, const std::vector<float>& depth, const std::vector<double>& shares,
                  const std::string& scene = "toy") {
    std::filesystem::create_directories(path(name));
    std::vector<float> reference;
    for (const double share : shares) reference.push_back(static_cast<float>(share * most));
    scene::write_exr(path(name) + "/image.exr", 4, 2, {{"Z", depth}, {"reference.Z", reference}});
    write(name + "/stats.json", "{\"command\":\"run\",\"scene\":\"" + scene + "\",\"machine\":\"" + name +
                                    "\",\"preset\":\"p\",\"level\":\"cycle\",\"facts\":{\"max_depth\":" +
                                    std::to_string(most) + "}}");
    return path(name);
  }
  Comparison compare(const std::string& a, const std::string& b) {
    return compare_runs(read_drawn_run(a), read_drawn_run(b));
  }

  const std::vector<double> shares_ = {1, 1, 0.1, 0.2, 0.4, 0.6, 0.8, 1};
};

TEST_F(CompareTest, PixelsAreCountedByWhatIsWrongAndWhere) {
  // Of 100: right are 10, 20, 40, 60, 80. The first loses pixel 2, gains 0 and has another surface at 3; the second gains 0
  // too and is 2.5 units off at 5.
  const Comparison c = compare(run("a", 100, {50, 100, 100, 17, 40, 60, 80, 100}, shares_),
                               run("b", 1000, {500, 1000, 100, 200, 400, 602, 800, 1000}, shares_));
  EXPECT_EQ(c.covered, 5);
  EXPECT_EQ(c.references_differ, 0);
  EXPECT_LT(c.reference_distance, 1e-6);
  EXPECT_EQ(c.first.lost, 1);
  EXPECT_EQ(c.first.gained, 1);
  EXPECT_EQ(c.first.other_surface, 1);
  EXPECT_EQ(c.second.wrong(), 2);
  EXPECT_EQ(c.both, 1);
  const auto none = PixelFault::kNone;
  EXPECT_EQ(c.pixels, (std::vector<PixelFault>{PixelFault::kBoth, none, PixelFault::kFirst, PixelFault::kFirst, none,
                                               PixelFault::kSecond, none, none}));
  EXPECT_NEAR(c.first.max_depth_error, 0.5, 1e-4);
  // Where both are right: half a unit of 100 against half a unit of 1000.
  EXPECT_NEAR(c.depth_distance, 0.005 - 0.0005, 1e-6);
  EXPECT_NEAR(c.mean_depth_distance, 0.005 - 0.0005, 1e-6);
}

TEST_F(CompareTest, ReferencesOfTwoScenesAreSeenToDiffer) {
  std::vector<double> others = shares_;
  others[1] = 0.5, others[4] = 0.45;
  const Comparison c = compare(run("a", 100, {100, 100, 10, 20, 40, 60, 80, 100}, shares_),
                               run("b", 100, {100, 50, 10, 20, 45, 60, 80, 100}, others));
  EXPECT_EQ(c.references_differ, 1);
  EXPECT_NEAR(c.reference_distance, 0.05, 1e-6);
  EXPECT_EQ(c.first.wrong() + c.second.wrong(), 0);
}

TEST_F(CompareTest, ThePictureShowsEveryWrongPixel) {
  const std::string a = run("a", 100, {100, 100, 10, 20, 40, 60, 80, 100}, shares_),
                    b = run("b", 100, {100, 100, 10, 20, 40, 60, 100, 100}, shares_);
  const DrawnRun first = read_drawn_run(a), second = read_drawn_run(b);
  const auto picture = [](const DrawnRun& p, const DrawnRun& q) { return comparison_picture(p, q, compare_runs(p, q)); };
  const scene::RgbImage image = picture(first, second);
  EXPECT_EQ(image.width, 8);
  EXPECT_NE(image.rgb, picture(first, first).rgb);
  EXPECT_NE(image.rgb, picture(second, first).rgb);
}

TEST_F(CompareTest, WhatCannotBeComparedIsTheUsersError) {
  const std::vector<float> depth{100, 100, 10, 20, 40, 60, 80, 100};
  const std::string a = run("a", 100, depth, shares_), other = run("other", 100, depth, shares_, "grove");
  const auto error = [&](const std::string& p, const std::string& q) { return error_of([&] { compare(p, q); }); };
  EXPECT_NE(std::string::npos, error(a, other).find("is a picture of grove, the first of toy"));
  EXPECT_NE(std::string::npos, error(a, path("gone")).find("gone/stats.json: there is no such file"));
  write("other/stats.json", "{\"command\":\"run\",");
  EXPECT_NE(std::string::npos, error(a, other).find("is not the run object"));
  write("other/stats.json", "{\"command\":\"run\",\"scene\":\"toy\",\"machine\":\"m\",\"preset\":\"p\",\"level\":\"cycle\"}");
  EXPECT_NE(std::string::npos, error(a, other).find("facts.max_depth"));
  scene::write_exr(path("other") + "/image.exr", 4, 2, {{"Z", depth}});
  write("other/stats.json", "{\"command\":\"run\",\"scene\":\"toy\",\"machine\":\"m\",\"preset\":\"p\",\"level\":\"cycle\","
                            "\"facts\":{\"max_depth\":100}}");
  EXPECT_NE(std::string::npos, error(a, other).find("has no channel reference.Z"));
}

}  // namespace
}  // namespace dendro::study
