#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/study/run.h"
#include "sim/study/worker.h"

namespace dendro::study {

/// Values put in place of the preset's, by key.
using Assignment = std::map<std::string, config::Value>;

/// One varied run, or why it is impossible.
struct VariedRun {
  Assignment assignment;
  stats::RunObject object;
  std::string impossible;  ///< empty: the run was made
};

/// A figure of a run that grows with time: seconds of the run, of a phase, of a plane.
struct Metric {
  std::string name;
  std::function<double(const stats::RunObject&)> of;
};

/// A metric over everything that the assumptions allow.
struct Interval {
  double low = 0;
  double high = 0;
  std::vector<stats::Contribution>
      contributions;               ///< one per varied parameter, widest first; in the metric's unit
  std::vector<std::string> notes;  ///< what had to be left out
};

/// Makes runs of these requests, in their order; an impossible one comes back with its error instead.
using RunMaker = std::function<std::vector<Outcome>(const std::vector<RunRequest>&)>;

/// Parameters that an interval varies: assumed, with a range or choices of their own. One that follows
/// another and has no range moves with it.
std::vector<config::Parameter> varied_parameters(const config::ParameterSet& parameters);

/// Points over all ranges at once: each parameter's range is cut into `count` strata of equal share (a choice
/// is a share too), and every stratum holds exactly one point. The seed decides everything.
std::vector<Assignment> latin_hypercube(const std::vector<config::Parameter>& parameters, int count,
                                        std::uint64_t seed);

/// Propagates every assumption's range through the run: all low, all high, each parameter at each of its ends
/// and choices alone, and per metric the two corners made of each parameter's faster and slower end;
/// `samples` adds as many points of a Latin hypercube over all ranges at once (seeded, always the same). A
/// combination that the machine refuses puts the key it blames back to its nominal value and is tried again.
/// Nothing is skipped: a parameter without effect shows as a contribution of width 0.
std::vector<Interval> propagate(const RunRequest& request, const stats::RunObject& nominal,
                                const std::vector<Metric>& metrics, const RunMaker& make_runs,
                                int samples = 0);

/// The combinations that propagate() tries beside single parameters: all low, all high, and per metric the two
/// corners made of each parameter's faster and slower end. Found with a small run, they serve for dear ones.
std::vector<Assignment> corners(const RunRequest& request, const stats::RunObject& nominal,
                                const std::vector<Metric>& metrics, const RunMaker& make_runs);

/// The request with these values in its parameters. Throws UserError.
RunRequest with_values(const RunRequest& request, const Assignment& assignment);

}  // namespace dendro::study
