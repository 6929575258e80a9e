#include <gtest/gtest.h>

#include <fmt/format.h>

#include <optional>
#include <random>

#include "models/machines/pixel_planes/timing.h"

namespace dendro::pixel_planes {
namespace {

struct Job {
  unsigned fifo_words = 1;
  bool expression = false;
  std::uint64_t words = 1;
  std::int64_t pause_ps = 0;  ///< the host computes before it
};

struct Times {
  std::vector<CommandTimes> commands;
  std::int64_t host_ps = 0, idle_from = 0;
};

/// The rules of models/parts/igc/README.md, clock after clock.
class Stepper {
 public:
  Stepper(const Spec& spec, std::vector<Job> jobs) : spec_(spec), jobs_(std::move(jobs)) {}

  Times run(std::uint64_t limit) {
    host_ps_ = jobs_.empty() ? 0 : jobs_[0].pause_ps + spec_.host.word_ps;
    for (; clock_ < static_cast<std::int64_t>(limit); ++clock_) {
      step();
      if (host_job_ == jobs_.size() && taken_ == jobs_.size() && !executing_ && in_flight_.empty() && fifo_.empty()) break;
    }
    times_.idle_from = clock_ + 1;
    return times_;
  }

  ControllerCounters counters;

 private:
  struct Word {
    std::size_t job;
    bool last;
  };

  void step() {
    const bool stolen = steal();
    const std::size_t waiting = fifo_.size();
    const bool translating = job_in_translator_.has_value();
    const bool ready = translating && words_left_ == 0 && setup_left_ == 0;
    const bool busy = executing_ > 0;
    // Controller and array, from the state at the beginning of the clock.
    bool take = false;
    if (!stolen) {
      for (std::int64_t& left : in_flight_) --left;
      while (!in_flight_.empty() && in_flight_.front() == 0) in_flight_.erase(in_flight_.begin());
      if (executing_ == 0 && ready) {
        take = true;
        executing_ = jobs_[*job_in_translator_].words;
        times_.commands.push_back({clock_, 0});
      }
      if (executing_ > 0) {
        ++counters.busy;
        in_flight_.push_back(spec_.latency());
        if (--executing_ == 0) times_.commands.back().free = clock_ + 1;
      }
    }
    if (stolen && (busy || ready)) ++(stolen_by_video_ ? counters.stall_video : counters.stall_refresh);
    if (!busy && !ready && (translating || waiting > 0)) ++counters.stall_translator;
    // Translator.
    if (translating && words_left_ == 0 && setup_left_ > 0) {
      --setup_left_;
    } else if ((translating && words_left_ > 0) || !translating) {
      if (waiting > 0) {
        if (!translating) job_in_translator_ = fifo_.front().job, words_left_ = jobs_[fifo_.front().job].fifo_words;
        fifo_.erase(fifo_.begin());
        if (--words_left_ == 0) setup_left_ = jobs_[*job_in_translator_].expression ? spec_.setup_clocks : 0;
      }
    }
    if (take) job_in_translator_.reset(), ++taken_;
    // One word of the host lands.
    if (host_job_ < jobs_.size() && host_ps_ / spec_.tick_ps <= clock_ && waiting < static_cast<std::size_t>(spec_.fifo_words)) {
      host_ps_ = std::max(host_ps_, clock_ * spec_.tick_ps);
      fifo_.push_back({host_job_, ++host_word_ == jobs_[host_job_].fifo_words});
      times_.host_ps = host_ps_;
      if (fifo_.back().last) {
        host_word_ = 0;
        if (++host_job_ < jobs_.size()) host_ps_ += jobs_[host_job_].pause_ps;
      }
      host_ps_ += spec_.host.word_ps;
    }
  }

  bool steal() {
    // Both kinds of events queue up; the array serves one a clock, by time, refresh first.
    for (;;) {
      const std::int64_t refresh = spec_.refresh_interval_ps > 0 ? (refreshes_ + 1) * spec_.refresh_interval_ps : INT64_MAX;
      const std::int64_t video = spec_.video_interval_ps > 0 ? (videos_ + 1) * spec_.video_interval_ps : INT64_MAX;
      const std::int64_t next = std::min(refresh, video);
      if (next > clock_ * spec_.tick_ps) return false;
      stolen_by_video_ = video < refresh;
      ++(stolen_by_video_ ? videos_ : refreshes_);
      return true;
    }
  }

  Spec spec_;
  std::vector<Job> jobs_;
  std::int64_t clock_ = 0, host_ps_ = 0, refreshes_ = 0, videos_ = 0;
  bool stolen_by_video_ = false;
  std::size_t host_job_ = 0, taken_ = 0;
  unsigned host_word_ = 0, words_left_ = 0;
  int setup_left_ = 0;
  std::uint64_t executing_ = 0;
  std::optional<std::size_t> job_in_translator_;
  std::vector<Word> fifo_;
  std::vector<std::int64_t> in_flight_;
  Times times_;
};

Times closed_form(const Spec& spec, const std::vector<Job>& jobs, ControllerCounters& counters) {
  Timing timing(spec);
  Times times;
  std::int64_t host = 0;
  for (const Job& job : jobs) {
    host += job.pause_ps;
    for (unsigned k = 0; k < job.fifo_words; ++k) host = timing.offer_word(host + spec.host.word_ps);
    times.commands.push_back(timing.command(job.fifo_words, job.expression, job.words));
  }
  times.host_ps = host, times.idle_from = timing.idle_from();
  timing.finish(times.idle_from);
  counters = timing.controller();
  return times;
}

void expect_same(const Spec& spec, const std::vector<Job>& jobs) {
  ControllerCounters counters;
  const Times found = closed_form(spec, jobs, counters);
  Stepper stepper(spec, jobs);
  const Times wanted = stepper.run(1 << 20);
  ASSERT_EQ(wanted.commands.size(), found.commands.size());
  for (std::size_t k = 0; k < wanted.commands.size(); ++k) {
    ASSERT_EQ(wanted.commands[k].taken, found.commands[k].taken) << "command " << k;
    ASSERT_EQ(wanted.commands[k].free, found.commands[k].free) << "command " << k;
  }
  EXPECT_EQ(wanted.host_ps, found.host_ps);
  EXPECT_EQ(wanted.idle_from, found.idle_from);
  EXPECT_EQ(stepper.counters.busy, counters.busy);
  EXPECT_EQ(stepper.counters.stall_refresh, counters.stall_refresh);
  EXPECT_EQ(stepper.counters.stall_video, counters.stall_video);
  EXPECT_EQ(stepper.counters.stall_translator, counters.stall_translator);
  EXPECT_EQ(counters.busy + counters.stall_refresh + counters.stall_video + counters.stall_translator +
                counters.stall_drain + counters.idle,
            static_cast<std::uint64_t>(found.idle_from));
}

TEST(Timing, ClosedFormsEqualTheRulesClockAfterClock) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    std::mt19937_64 random(seed);
    const auto pick = [&](std::int64_t low, std::int64_t high) { return std::uniform_int_distribution<std::int64_t>(low, high)(random); };
    Spec spec;
    spec.setup_clocks = static_cast<int>(pick(0, 9));
    spec.fifo_words = static_cast<int>(pick(8, 24));
    spec.host.word_ps = pick(1, 4) * pick(20000, 90000);
    spec.refresh_interval_ps = pick(0, 1) * pick(400000, 3000000);
    spec.video_interval_ps = pick(0, 1) * pick(400000, 3000000);
    std::vector<Job> jobs;
    for (int k = 0; k < 80; ++k) {
      const bool expression = pick(0, 1) == 1;
      jobs.push_back({static_cast<unsigned>(expression ? pick(4, 6) : pick(1, 3)), expression,
                      static_cast<std::uint64_t>(pick(1, 90)), pick(0, 3) == 0 ? pick(0, 9000000) : 0});
    }
    expect_same(spec, jobs);
  }
}

TEST(Timing, AFullFifoHoldsTheHostAndLosesNothing) {
  Spec spec;
  spec.fifo_words = 8;
  spec.host.word_ps = spec.tick_ps;
  const std::vector<Job> jobs(50, Job{4, true, 100, 0});
  expect_same(spec, jobs);
  ControllerCounters counters;
  const Times times = closed_form(spec, jobs, counters);
  EXPECT_EQ(counters.busy, 5000u);
  EXPECT_GT(times.host_ps, 45 * 100 * spec.tick_ps) << "the host got ahead by what the FIFO holds only";
}

TEST(Timing, RefreshGoesBeforeVideoOnOneClock) {
  Spec spec;
  spec.refresh_interval_ps = spec.video_interval_ps = 10 * spec.tick_ps;
  StolenClocks stolen(spec);
  EXPECT_EQ(stolen.first_free(9), 9);
  EXPECT_EQ(stolen.first_free(10), 12);
  EXPECT_EQ(stolen.count(10, 11).first, 1u);
  EXPECT_EQ(stolen.count(11, 12).second, 1u);
  EXPECT_EQ(stolen.advance(9, 1), 12);
}

TEST(Timing, AnIdleMachineEndsWhenItsLastWordLeftTheTree) {
  Spec spec;
  ControllerCounters counters;
  const Times times = closed_form(spec, {{4, true, 59, 0}}, counters);
  EXPECT_EQ(times.idle_from, times.commands[0].free + spec.latency());
  EXPECT_EQ(counters.stall_drain, 18u);
}

}  // namespace
}  // namespace dendro::pixel_planes
