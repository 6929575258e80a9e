#include "models/machines/sgi_4d35/estimate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/debug.h"
#include "models/machines/sgi_4d35/pipeline.h"
#include "models/parts/r3000/r3000.h"

namespace dendro::sgi_4d35 {
namespace {

/// Sums over whole windows.
struct Sums {
  std::uint64_t windows = 0;
  double cycles = 0, squares = 0;

  void add(double clocks) {
    ++windows;
    cycles += clocks;
    squares += clocks * clocks;
  }
};

/// Standard errors on both sides of a mean of n windows that hold it with 99.7 %: Student's quantile in the expansion of
/// Cornish and Fisher about 3.
double errors_of(double n) {
  const double v = n - 1;
  return 3 + 7.5 / v + 17.25 / (v * v) + 30.2 / (v * v * v);
}

/// `exact` clocks have passed, and `words` words whose windows these are.
UnitStats estimate_of(std::uint64_t exact, const Sums& sums, const Sampling& sampling, double words) {
  double rest = 0, half = 0;
  if (words != 0) {
    const auto n = static_cast<double>(sums.windows), size = static_cast<double>(sampling.window);
    const double mean = sums.cycles / n;
    const double variance = std::max(0.0, (sums.squares - n * mean * mean) / (n - 1));
    rest = mean * words / size;
    half = errors_of(n) * std::sqrt(variance / n) * words / size;
  }
  const auto whole = [](double x) { return static_cast<std::uint64_t>(std::llround(std::max(x, 0.0))); };
  const std::uint64_t cycles = exact + whole(rest);
  return {"sgi_4d35.estimate",
          {{"cycles", cycles},
           {"busy", cycles},
           {"idle", 0},
           {"low", exact + whole(std::floor(rest - half))},
           {"high", exact + whole(std::ceil(rest + half))},
           {"windows", words == 0 ? 0 : sums.windows}}};
}

}  // namespace

ProgramResult run_estimate(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, const MachineOptions& options, const Sampling& sampling) {
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board, Pipeline> core(spec.processor, board, spec);
  start(core.state(), image);
  std::mt19937_64 random(sampling.seed);
  Sums first, rest;
  const auto exactly = [&core](std::uint64_t words) { return core.run(words); };
  std::uint64_t left = debugged(options.debugger, core, exactly, board, limit);
  const std::uint64_t let_go = left;
  const auto run = [&](std::uint64_t words) {
    const std::uint64_t budget = std::min(left, words), unused = core.run(budget);
    left -= budget - unused;
    return budget == words && unused == 0;
  };
  const auto window = [&](Sums& sums) {
    const std::uint64_t begin = core.time().bias;
    if (run(sampling.window)) sums.add(static_cast<double>(core.time().bias - begin));
  };
  const auto going = [&] { return left != 0 && !board.stopped(); };
  // The beginning is exact: a short program is, and there is always a window.
  while (going() && let_go - left < sampling.exact) window(first);
  const std::uint64_t exact_words = limit - left, exact = core.time().bias;
  while (going()) {
    const std::uint64_t before = random() % (sampling.period - sampling.lead_in - sampling.window);
    core.warm(true);
    run(before);
    core.warm(false);
    run(sampling.lead_in);
    window(rest);
    core.warm(true);
    run(sampling.period - before - sampling.lead_in - sampling.window);
    core.warm(false);
    if (options.progress) options.progress(static_cast<std::int64_t>(core.time().bias));
  }
  ProgramResult result = result_of(core.state(), board, spec);
  if (limit != 0) core.settle();
  const auto sampled = static_cast<double>(limit - left - exact_words);
  const std::uint64_t known = sampled != 0 ? exact : limit != 0 ? core.time().bias + 1 : 0;
  result.units.push_back(estimate_of(known, rest.windows < 2 ? first : rest, sampling, sampled));
  result.cycles = static_cast<std::int64_t>(result.units.front().values.front().second);
  return result;
}

}  // namespace dendro::sgi_4d35
