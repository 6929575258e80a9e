#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/lib/stability.h"
#include "sim/study/catalogue.h"
#include "sim/study/progress.h"

namespace dendro::study {

/// The hard numerical cases of one algorithm and the machine on which its firmware runs them.
struct StabilitySuite {
  std::string algorithm;
  std::string machine;  ///< NAME or NAME:PRESET
  std::map<std::string, std::int64_t> parameters;  ///< that differ from the preset's
  std::vector<stability::Case> cases;
};

/// The one list of suites.
const std::vector<StabilitySuite>& stability_suites();

/// A line per case: id, algorithm, machine, what it is about.
std::string stability_list(const std::vector<StabilitySuite>& suites);

struct StabilityOptions {
  std::vector<std::string> cases;  ///< ids; empty: all
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// Runs the cases in worker processes, each on machines at level `function`; results in the suites' order.
/// Throws UserError for a case that is not known.
std::vector<stability::Result> run_stability(const Catalogue& catalogue,
                                             const std::vector<StabilitySuite>& suites,
                                             const StabilityOptions& options, Progress* progress);

/// True when every row passes.
bool all_pass(const std::vector<stability::Result>& results);

std::string stability_json(const std::vector<stability::Result>& results);
std::string stability_text(const std::vector<stability::Result>& results);
std::string stability_csv(const std::vector<stability::Result>& results);

/// A curve's table; a value that is not there is an empty cell.
std::string curve_csv(const stability::Curve& curve);
/// Writes the curve's picture. Throws UserError when the file cannot be written.
void write_curve_picture(const stability::Curve& curve, const std::string& path);

/// A result as bytes, for pipes, and back.
std::string to_bytes(const stability::Result& result);
stability::Result result_from_bytes(const std::string& bytes);

}  // namespace dendro::study
