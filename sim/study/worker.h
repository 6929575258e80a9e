#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/base/error.h"

namespace dendro::study {

/// A worker died of a bug; the command exits with 70. An empty what() means that the worker has said why.
class WorkerCrash : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Ctrl-C or a request to terminate; every worker is gone when this is thrown.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal) : std::runtime_error("interrupted"), signal_number(signal) {}
  int signal_number;
};

/// What a worker handed back: its bytes, or the error of the user that it ran into.
struct Outcome {
  std::string bytes;
  std::optional<UserError> error;

  /// The bytes; throws the error.
  const std::string& value() const;
};

/// Runs each task in a process of its own, at most `jobs` at once, and gathers what they return in their
/// order. SystemC allows one elaboration per process, so no task may have started one in this process.
/// `finished(i)` is called after each with its result in place. Throws WorkerCrash or Interrupted after
/// ending the workers that still run.
std::vector<Outcome> run_in_workers(const std::vector<std::function<std::string()>>& tasks, int jobs,
                                    const std::function<void(std::size_t, const Outcome&)>& finished = {});

/// One task in a worker.
std::string run_in_worker(const std::function<std::string()>& task);

/// Number of workers that keep this computer busy.
int default_jobs();

/// Makes Ctrl-C reach run_in_workers as Interrupted, and a file that may not grow a failed write. Called once, by the command.
void catch_interrupts();

/// Throws Interrupted when a signal has come since.
void check_interrupt();

}  // namespace dendro::study
