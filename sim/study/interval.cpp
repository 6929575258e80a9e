#include "sim/study/interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "sim/base/check.h"

namespace dendro::study {
namespace {

using config::Parameter;
using config::Value;

Value typed_as(const Value& like, double number) {
  if (std::holds_alternative<std::int64_t>(like)) return static_cast<std::int64_t>(std::llround(number));
  return number;
}

/// Everything the parameter may be instead of its nominal value.
std::vector<Value> alternatives(const Parameter& p) {
  std::vector<Value> values;
  if (p.spread->low) {
    values = {typed_as(p.value, *p.spread->low), typed_as(p.value, *p.spread->high)};
  } else {
    values = p.spread->choices;
  }
  values.erase(std::remove(values.begin(), values.end(), p.value), values.end());
  return values;
}

/// Runs of assignments; what the machine refuses goes back to nominal until it accepts the rest.
class Explorer {
 public:
  Explorer(const RunRequest& request, const RunMaker& make_runs) : request_(request), make_runs_(make_runs) {}

  /// `settle`: give up single keys of an impossible combination instead of the whole.
  std::vector<VariedRun> run(const std::vector<Assignment>& assignments, bool settle) {
    std::vector<VariedRun> runs(assignments.size());
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < assignments.size(); ++i) {
      runs[i].assignment = assignments[i];
      open.push_back(i);
    }
    while (!open.empty()) open = attempt(runs, open, settle);
    return runs;
  }

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::vector<std::size_t> attempt(std::vector<VariedRun>& runs, const std::vector<std::size_t>& open,
                                   bool settle) {
    std::vector<std::size_t> again, asked;
    std::vector<RunRequest> requests;
    for (const std::size_t i : open) {
      try {
        requests.push_back(with_values(request_, runs[i].assignment));
        asked.push_back(i);
      } catch (const UserError& error) {
        if (refuse(runs[i], error, settle)) again.push_back(i);
      }
    }
    const std::vector<Outcome> outcomes = make_runs_(requests);
    for (std::size_t n = 0; n < asked.size(); ++n) {
      VariedRun& run = runs[asked[n]];
      if (!outcomes[n].error)
        run.object = from_bytes(outcomes[n].bytes).object;
      else if (refuse(run, *outcomes[n].error, settle))
        again.push_back(asked[n]);
    }
    return again;
  }

  /// True when the run is to be tried again without the key that is to blame.
  bool refuse(VariedRun& run, const UserError& error, bool settle) {
    const bool alone = run.assignment.size() == 1;
    const std::string key = alone ? run.assignment.begin()->first : blamed(run.assignment, error.key());
    if (run.assignment.count(key) == 0) throw error;
    const std::string value = config::to_text(run.assignment[key]);
    if (!settle || alone) {
      run.impossible = fmt::format("{} = {}: {}", key, value, error.message());
      notes_.push_back(run.impossible);
      return false;
    }
    notes_.push_back(
        fmt::format("{} stays nominal in a corner, {} is impossible there: {}", key, value, error.message()));
    run.assignment.erase(key);
    return true;
  }

  /// The assigned parameter behind a key that the machine complained about: itself, or the one that it
  /// follows.
  std::string blamed(const Assignment& assignment, std::string key) const {
    const config::ParameterSet& parameters = request_.preset.parameters;
    for (const Parameter* p = parameters.find(key); p && !assignment.count(key); p = parameters.find(key))
      key = p->follows;
    return key;
  }

  const RunRequest& request_;
  const RunMaker& make_runs_;
  std::vector<std::string> notes_;
};

Assignment ends(const std::vector<Parameter>& parameters, bool high) {
  Assignment assignment;
  for (const Parameter& p : parameters)
    if (p.spread->low) assignment[p.key] = typed_as(p.value, high ? *p.spread->high : *p.spread->low);
  return assignment;
}

/// One parameter's alternatives, each alone.
struct Alone {
  const Parameter* parameter;
  std::vector<const VariedRun*> runs;
};

stats::Contribution contribution(const Alone& alone, const Metric& metric, double nominal) {
  stats::Contribution c{alone.parameter->key, nominal, nominal, alone.parameter->source};
  for (const VariedRun* run : alone.runs) {
    if (!run->impossible.empty()) continue;
    c.low = std::min(c.low, metric.of(run->object));
    c.high = std::max(c.high, metric.of(run->object));
  }
  return c;
}

/// The corner in which every parameter stands where it alone makes the metric smallest (or largest).
Assignment corner(const std::vector<Alone>& all, const Metric& metric, double nominal, bool largest) {
  Assignment assignment;
  for (const Alone& alone : all) {
    double best = nominal;
    for (const VariedRun* run : alone.runs) {
      if (!run->impossible.empty()) continue;
      const double value = metric.of(run->object);
      if (largest ? value > best : value < best) {
        best = value;
        assignment[alone.parameter->key] = run->assignment.at(alone.parameter->key);
      }
    }
  }
  return assignment;
}

/// Every parameter at each of its ends and choices, alone.
struct Singles {
  Singles(const RunRequest& request, Explorer& explorer) : parameters(varied_parameters(request.preset.parameters)) {
    std::vector<Assignment> assignments;
    for (const Parameter& p : parameters)
      for (const Value& value : alternatives(p)) assignments.push_back({{p.key, value}});
    runs = explorer.run(assignments, false);
    std::size_t next = 0;
    for (const Parameter& p : parameters) {
      alone.push_back({&p, {}});
      for (std::size_t i = 0; i < alternatives(p).size(); ++i) alone.back().runs.push_back(&runs[next++]);
    }
  }
  Singles(const Singles&) = delete;
  Singles& operator=(const Singles&) = delete;

  /// All low, all high, and per metric the two corners of each parameter's faster and slower end.
  std::vector<Assignment> corners(const stats::RunObject& nominal, const std::vector<Metric>& metrics) const {
    std::vector<Assignment> together = {ends(parameters, false), ends(parameters, true)};
    for (const Metric& metric : metrics)
      for (const bool largest : {false, true}) {
        const Assignment a = corner(alone, metric, metric.of(nominal), largest);
        if (std::find(together.begin(), together.end(), a) == together.end()) together.push_back(a);
      }
    return together;
  }

  std::vector<Parameter> parameters;
  std::vector<VariedRun> runs;
  std::vector<Alone> alone;
};

constexpr std::uint64_t kSampleSeed = 1986;

// Not std::uniform_real_distribution and std::shuffle: their numbers differ between libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) / 9007199254740992.0; }

/// The parameter's value at a share of its range: integers uniform over the range inclusive, reals uniform,
/// or uniform in the logarithm where that is meant.
Value at_share(const Parameter& p, double u) {
  if (!p.spread->low) {
    const auto& choices = p.spread->choices;
    return choices[static_cast<std::size_t>(u * static_cast<double>(choices.size()))];
  }
  const double low = *p.spread->low, high = *p.spread->high;
  if (std::holds_alternative<std::int64_t>(p.value) && !p.spread->logarithmic)
    return static_cast<std::int64_t>(low + std::floor(u * (high - low + 1)));
  return typed_as(p.value, p.spread->logarithmic ? low * std::pow(high / low, u) : low + u * (high - low));
}

}  // namespace

std::vector<Parameter> varied_parameters(const config::ParameterSet& parameters) {
  std::vector<Parameter> varied;
  for (const Parameter& p : parameters.all())
    if (p.spread && p.source.compare(0, 7, "ASSUMED") == 0) varied.push_back(p);
  return varied;
}

RunRequest with_values(const RunRequest& request, const Assignment& assignment) {
  RunRequest varied = request;
  for (const auto& [key, value] : assignment) varied.preset.parameters.set(key, value, {"--interval", 0});
  return varied;
}

std::vector<Assignment> latin_hypercube(const std::vector<Parameter>& parameters, int count,
                                        std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Assignment> points(static_cast<std::size_t>(std::max(count, 0)));
  std::vector<std::size_t> strata(points.size());
  for (const Parameter& p : parameters) {
    std::iota(strata.begin(), strata.end(), std::size_t{0});
    for (std::size_t i = strata.size(); i > 1; --i) std::swap(strata[i - 1], strata[random() % i]);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i][p.key] = at_share(
          p, (static_cast<double>(strata[i]) + uniform(random)) / static_cast<double>(points.size()));
  }
  return points;
}

std::vector<Assignment> corners(const RunRequest& request, const stats::RunObject& nominal,
                                const std::vector<Metric>& metrics, const RunMaker& make_runs) {
  Explorer explorer(request, make_runs);
  return Singles(request, explorer).corners(nominal, metrics);
}

std::vector<Interval> propagate(const RunRequest& request, const stats::RunObject& nominal,
                                const std::vector<Metric>& metrics, const RunMaker& make_runs, int samples) {
  Explorer explorer(request, make_runs);
  const Singles singles(request, explorer);
  std::vector<Assignment> together = singles.corners(nominal, metrics);
  const std::vector<Assignment> points = latin_hypercube(singles.parameters, samples, kSampleSeed);
  together.insert(together.end(), points.begin(), points.end());
  const std::vector<VariedRun> corner_runs = explorer.run(together, true);

  std::vector<Interval> intervals;
  for (const Metric& metric : metrics) {
    const double value = metric.of(nominal);
    Interval interval{value, value, {}, explorer.notes()};
    for (const auto* runs : {&singles.runs, &corner_runs})
      for (const VariedRun& run : *runs) {
        if (!run.impossible.empty()) continue;
        interval.low = std::min(interval.low, metric.of(run.object));
        interval.high = std::max(interval.high, metric.of(run.object));
      }
    for (const Alone& a : singles.alone) interval.contributions.push_back(contribution(a, metric, value));
    std::stable_sort(interval.contributions.begin(), interval.contributions.end(),
                     [](const auto& a, const auto& b) { return a.high - a.low > b.high - b.low; });
    intervals.push_back(std::move(interval));
  }
  return intervals;
}

}  // namespace dendro::study
