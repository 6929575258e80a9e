#include "sim/study/worker.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <nlohmann/json.hpp>
#include <thread>

#include "sim/base/check.h"

namespace dendro::study {
namespace {

using Json = nlohmann::json;

volatile std::sig_atomic_t signal_seen = 0;

void remember_signal(int number) { signal_seen = number; }

struct Worker {
  std::size_t task = 0;
  pid_t pid = -1;
  int pipe = -1;
  std::string bytes;
};

void write_all(int fd, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = ::write(fd, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) std::_Exit(70);
    at += static_cast<std::size_t>(n);
  }
}

std::string message_of(const std::function<std::string()>& task) {
  Json message;
  try {
    message["bytes"] = Json::binary_t([&] {
      const std::string bytes = task();
      return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
    }());
  } catch (const UserError& e) {
    message["error"] = {{"file", e.file()}, {"line", e.line()}, {"key", e.key()}, {"message", e.message()}};
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dendro: bug: %s\n", e.what());
    std::_Exit(70);
  }
  const auto cbor = Json::to_cbor(message);
  return std::string(cbor.begin(), cbor.end());
}

[[noreturn]] void work(const std::function<std::string()>& task, int fd) {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  write_all(fd, message_of(task));
  ::close(fd);
  // Destructors of a SystemC that was elaborated here have nothing to do that the end of the process does
  // not.
  std::fflush(nullptr);
  std::_Exit(0);
}

Worker start(std::size_t index, const std::function<std::string()>& task) {
  std::fflush(nullptr);
  int ends[2];
  if (::pipe(ends) != 0) throw UserError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  const pid_t pid = ::fork();
  if (pid < 0) throw UserError(fmt::format("cannot start a worker: {}", std::strerror(errno)));
  if (pid == 0) {
    ::close(ends[0]);
    work(task, ends[1]);
  }
  ::close(ends[1]);
  Worker worker;
  worker.task = index;
  worker.pid = pid;
  worker.pipe = ends[0];
  return worker;
}

void end_all(std::deque<Worker>& workers) {
  for (const Worker& w : workers) ::kill(w.pid, SIGKILL);
  for (const Worker& w : workers) {
    ::waitpid(w.pid, nullptr, 0);
    ::close(w.pipe);
  }
  workers.clear();
}

/// The end of a worker whose pipe is at its end.
Outcome collect(const Worker& worker) {
  ::close(worker.pipe);
  int status = 0;
  while (::waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    throw WorkerCrash(
        fmt::format("a run ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
  if (WEXITSTATUS(status) == 70) throw WorkerCrash("");
  if (WEXITSTATUS(status) != 0)
    throw WorkerCrash(fmt::format("a run ended with status {}", WEXITSTATUS(status)));
  const Json message = Json::from_cbor(worker.bytes);
  Outcome outcome;
  if (message.contains("error")) {
    const Json& e = message["error"];
    outcome.error = UserError(e["file"].get<std::string>(), e["line"].get<int>(), e["key"].get<std::string>(),
                              e["message"].get<std::string>());
  } else {
    const auto& bytes = message.at("bytes").get_binary();
    outcome.bytes.assign(bytes.begin(), bytes.end());
  }
  return outcome;
}

/// Reads what is there; true at the end of the pipe.
bool drain(Worker& worker) {
  char buffer[65536];
  const ssize_t n = ::read(worker.pipe, buffer, sizeof buffer);
  if (n > 0) worker.bytes.append(buffer, static_cast<std::size_t>(n));
  return n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN);
}

void wait_for_any(const std::deque<Worker>& workers, std::vector<pollfd>& polls) {
  polls.clear();
  for (const Worker& w : workers) polls.push_back({w.pipe, POLLIN, 0});
  if (::poll(polls.data(), polls.size(), 200) < 0)
    for (pollfd& p : polls) p.revents = 0;
}

}  // namespace

const std::string& Outcome::value() const {
  if (error) throw *error;
  return bytes;
}

std::vector<Outcome> run_in_workers(const std::vector<std::function<std::string()>>& tasks, int jobs,
                                    const std::function<void(std::size_t, const Outcome&)>& finished) {
  std::vector<Outcome> outcomes(tasks.size());
  std::deque<Worker> running;
  std::vector<pollfd> polls;
  std::size_t next = 0;
  try {
    while (next < tasks.size() || !running.empty()) {
      check_interrupt();
      while (next < tasks.size() && running.size() < static_cast<std::size_t>(std::max(jobs, 1))) {
        running.push_back(start(next, tasks[next]));
        ++next;
      }
      wait_for_any(running, polls);
      for (std::size_t i = polls.size(); i-- > 0;) {
        if (polls[i].revents == 0 || !drain(running[i])) continue;
        const Worker done = std::move(running[i]);
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        outcomes[done.task] = collect(done);
        if (finished) finished(done.task, outcomes[done.task]);
      }
    }
  } catch (...) {
    end_all(running);
    // A worker that Ctrl-C killed is no bug.
    check_interrupt();
    throw;
  }
  return outcomes;
}

std::string run_in_worker(const std::function<std::string()>& task) {
  return run_in_workers({task}, 1).front().value();
}

int default_jobs() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = remember_signal;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  // A file that may not grow is a write that fails, with its one line, as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

void check_interrupt() {
  if (signal_seen != 0) throw Interrupted(signal_seen);
}

}  // namespace dendro::study
