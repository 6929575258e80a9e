#include "sim/study/worker.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "sim/base/check.h"

namespace dendro::study {
namespace {

TEST(Workers, ResultsComeInTheOrderOfTheTasks) {
  std::vector<std::function<std::string()>> tasks;
  for (int i = 0; i < 9; ++i)
    tasks.push_back([i] { return std::string(static_cast<std::size_t>(i) * 50000, char('a' + i)); });
  std::size_t finished = 0;
  const auto outcomes = run_in_workers(tasks, 3, [&](std::size_t i, const Outcome& o) {
    ++finished;
    EXPECT_EQ(i * 50000, o.bytes.size());
  });
  EXPECT_EQ(9u, finished);
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(std::string(i * 50000, static_cast<char>('a' + i)), outcomes[i].value());
}

TEST(Workers, AreProcessesOfTheirOwn) {
  const std::string here = std::to_string(::getpid());
  EXPECT_NE(here, run_in_worker([] { return std::to_string(::getpid()); }));
}

TEST(Workers, AUserErrorReachesTheParentWhole) {
  try {
    run_in_worker([]() -> std::string { throw UserError("f.toml", 3, "a.b", "is wrong"); });
    FAIL();
  } catch (const UserError& e) {
    EXPECT_STREQ("f.toml:3: a.b: is wrong", e.what());
    EXPECT_EQ("a.b", e.key());
  }
}

TEST(Workers, ASignalIsACrash) {
  try {
    run_in_worker([]() -> std::string {
      ::raise(SIGKILL);
      return "";
    });
    FAIL();
  } catch (const WorkerCrash& e) {
    EXPECT_STREQ("a run ended by signal 9 (Killed)", e.what());
  }
}

TEST(Workers, AFailedCheckHasSaidWhyAlready) {
  try {
    run_in_worker([]() -> std::string {
      ::close(STDERR_FILENO);
      DENDRO_CHECK(1 + 1 == 3, "arithmetic");
      return "";
    });
    FAIL();
  } catch (const WorkerCrash& e) {
    EXPECT_STREQ("", e.what());
  }
}

}  // namespace
}  // namespace dendro::study
