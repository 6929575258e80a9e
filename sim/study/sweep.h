#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sim/study/study_file.h"
#include "sim/study/sweep_results.h"

namespace dendro::study {

struct SweepOptions {
  std::string folder;  ///< holds results.sqlite; made when it is not there
  int jobs = 1;
};

struct SweepOutcome {
  std::vector<SweepRow> rows;  ///< one per run of the study, in its order
  std::size_t made = 0;        ///< runs that this call made
  std::size_t found = 0;       ///< runs that were in the folder already
  std::size_t refused = 0;     ///< of all rows
};

/// Makes every run of the study that is not in the folder yet, in worker processes, and stores each when it is
/// finished: a sweep that was ended in any way goes on where it stopped. What machine or program refuses becomes a row
/// that says why. Throws UserError before the first run for anything that is wrong in the study itself, for outputs
/// that runs do not have, for a folder that cannot be used, and when every run is refused.
SweepOutcome sweep(const Catalogue& catalogue, const Study& study, const SweepOptions& options, Progress* progress);

/// One output of a row; NaN where the run has no such figure.
double output_of(const SweepRow& row, const std::string& output);

}  // namespace dendro::study
