#include "sim/study/interval.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/study/cache.h"
#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

// Time of the fake: 10000 / words_per_s + (2 or, dense, 1) * (a + b + c) ticks of 1 ms. Nominal: 100 + 36 =
// 136.

class IntervalTest : public fake::TestFolder {
 protected:
  RunRequest request(const std::vector<std::string>& settings = {}) {
    RunArguments arguments;
    arguments.scene = write("toy.toml", fake::toy_scene());
    arguments.settings = settings;
    return prepare_run(catalogue_, arguments);
  }

  /// Runs in this process: the fake elaborates nothing.
  RunMaker here() {
    return [this](const std::vector<RunRequest>& requests) {
      std::vector<Outcome> outcomes;
      for (const RunRequest& r : requests) {
        ++runs_;
        Outcome outcome;
        try {
          outcome.bytes = to_bytes(execute(r, "", nullptr));
        } catch (const UserError& error) {
          outcome.error = error;
        }
        outcomes.push_back(outcome);
      }
      return outcomes;
    };
  }

  Interval interval(const RunRequest& r, int samples = 0) {
    const std::vector<Metric> metrics = {
        {"ticks", [](const stats::RunObject& run) { return double(run.cycles); }}};
    return propagate(r, execute(r, "", nullptr).object, metrics, here(), samples).front();
  }

  static const stats::Contribution& find(const Interval& interval, const std::string& key) {
    for (const auto& c : interval.contributions)
      if (c.key == key) return c;
    throw std::runtime_error(key);
  }

  int runs_ = 0;
};

TEST_F(IntervalTest, CornersOfOneRunReachTheIntervalOfAnother) {
  const std::vector<Metric> metrics = {{"ticks", [](const stats::RunObject& run) { return double(run.cycles); }}};
  const RunRequest r = request();
  const double nominal = double(execute(r, "", nullptr).object.cycles);
  double low = nominal, high = nominal;
  const std::vector<Assignment> found = corners(r, execute(r, "", nullptr).object, metrics, here());
  EXPECT_EQ(4u, found.size());
  for (const Assignment& assignment : found) {
    const double ticks = double(execute(with_values(r, assignment), "", nullptr).object.cycles);
    low = std::min(low, ticks), high = std::max(high, ticks);
  }
  const Interval i = interval(r);
  EXPECT_EQ(i.low, low);
  EXPECT_EQ(i.high, high);
  EXPECT_LT(low, nominal);
  EXPECT_GT(high, nominal);
}

TEST_F(IntervalTest, ReachesTheCornersEvenWhereRatesAndDelaysRunAgainstEachOther) {
  const Interval i = interval(request());
  // Fastest: dense, a = 5, b = c = 4, 200 words/s. Slowest: plain, a = 30, b = c = 8, 50 words/s.
  EXPECT_EQ(50 + 13, i.low);
  EXPECT_EQ(200 + 2 * 46, i.high);
}

TEST_F(IntervalTest, SaysHowFarEachAssumptionAloneMovesTheTime) {
  const Interval i = interval(request());
  EXPECT_EQ("rate.words_per_s", i.contributions.front().key);
  EXPECT_EQ(50 + 36, i.contributions.front().low);
  EXPECT_EQ(200 + 36, i.contributions.front().high);
  EXPECT_EQ(136 - 10, find(i, "delay.a_ticks").low);
  EXPECT_EQ(136 + 40, find(i, "delay.a_ticks").high);
  EXPECT_EQ(136 + 16, find(i, "delay.b_ticks").high) << "its follower moves with it";
  EXPECT_EQ(136 - 18, find(i, "mode.kind").low);
}

TEST_F(IntervalTest, AnEndThatIsTheNominalValueIsNotRunAgain) {
  interval(request());
  // a: 2 ends, b: 1, rate: 2, kind: 1; all low, all high, fastest, slowest.
  EXPECT_EQ(6 + 4, runs_);
}

TEST_F(IntervalTest, WhatTheUserSetIsNotVaried) {
  const Interval i = interval(request({"parameters.rate.words_per_s=100"}));
  EXPECT_THROW(find(i, "rate.words_per_s"), std::runtime_error);
  EXPECT_EQ(100 + 2 * 46, i.high);
}

TEST_F(IntervalTest, AnImpossibleCornerGivesUpOnlyTheParameterThatIsToBlame) {
  // Dense words make everything slower here than c > 6 allows: with b = 8, c follows to 8 and the machine
  // refuses.
  RunRequest r = request({"parameters.mode.kind=dense"});
  const Interval i = interval(r);
  const std::string notes = i.notes.empty() ? "" : i.notes.front();
  EXPECT_NE(std::string::npos, notes.find("delay.b_ticks = 8: too slow for dense words")) << notes;
  EXPECT_EQ(200 + 30 + 4 + 4, i.high) << "a and the rate are still at their slow ends";
}

TEST_F(IntervalTest, SamplesStayInsideTheRangesAndAreTheSameEveryTime) {
  const Interval corners = interval(request());
  const Interval sampled = interval(request(), 50);
  EXPECT_EQ(corners.low, sampled.low) << "the fake is monotonic, so no sample lies outside its corners";
  EXPECT_EQ(corners.high, sampled.high);
}

TEST_F(IntervalTest, ALatinHypercubeHasOnePointInEveryStratumOfEveryParameter) {
  const auto parameters = varied_parameters(request().preset.parameters);
  constexpr int kPoints = 26;  // the first range holds as many integers
  const auto points = latin_hypercube(parameters, kPoints, 7);
  ASSERT_EQ(std::size_t{kPoints}, points.size());
  std::set<std::int64_t> whole, strata;
  int dense = 0;
  for (const Assignment& point : points) {
    whole.insert(std::get<std::int64_t>(point.at("delay.a_ticks")));
    const double rate = std::get<double>(point.at("rate.words_per_s"));
    strata.insert(static_cast<std::int64_t>(std::floor(std::log2(rate / 50) / 2 * kPoints)));
    dense += std::get<std::string>(point.at("mode.kind")) == "dense";
  }
  EXPECT_EQ(std::size_t{kPoints}, whole.size()) << "5 to 30, each once";
  EXPECT_EQ(std::size_t{kPoints}, strata.size()) << "a logarithmic range has strata of equal ratio";
  EXPECT_EQ(kPoints / 2, dense);
  EXPECT_EQ(points, latin_hypercube(parameters, kPoints, 7));
  EXPECT_NE(points, latin_hypercube(parameters, kPoints, 8));
  EXPECT_TRUE(latin_hypercube(parameters, 0, 7).empty());
}

TEST_F(IntervalTest, WorkersGiveWhatThisProcessGives) {
  const RunRequest r = request();
  const std::vector<Metric> metrics = {
      {"ticks", [](const stats::RunObject& run) { return double(run.cycles); }}};
  const auto here_object = execute(r, "", nullptr).object;
  Progress silent("off");
  const Interval there = propagate(r, here_object, metrics, worker_runs(2, &silent, "toy")).front();
  const Interval i = interval(r);
  EXPECT_EQ(i.low, there.low);
  EXPECT_EQ(i.high, there.high);
}

}  // namespace
}  // namespace dendro::study
