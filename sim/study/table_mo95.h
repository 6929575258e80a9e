#pragma once

#include <string>
#include <vector>

#include "sim/study/table_rows.h"

namespace dendro::study {

/// What one run of the workstation's programs tells.
double mo95_frame_seconds(const stats::RunObject& run);  ///< a picture: without reading and what is done once
double mo95_precompute_seconds(const stats::RunObject& run);  ///< all views, the whole program; 0 if untimed
double mo95_tree_seconds(const stats::RunObject& run);   ///< reading a tree and its normals, once a sequence
double mo95_sample_cycles(const stats::RunObject& run);  ///< of a frame, by the samples that it visits
double mo95_cycles_an_instruction(const stats::RunObject& run);
/// Shares of all cycles in which the processor waited, the largest three: "of all cycles 16.3 % wait for
/// multiply divide, ...".
std::string mo95_stalls(const stats::RunObject& run);

/// A run of one frame of a shipped scene with these settings.
SceneRun mo95_scene(const std::string& scene, const std::vector<std::string>& settings);

/// Runs in workers, in their order, from the cache where it has them. Throws UserError for the first that
/// failed.
std::vector<stats::RunObject> mo95_runs(const TableContext& context, const std::vector<SceneRun>& runs,
                                        const std::string& name);

/// Another reading of what MO95 leaves open, or another way to do it.
struct Mo95Variant {
  std::string name;
  std::vector<std::string> settings;  ///< after the run's own
};

/// What is run for a row.
struct Mo95Plan {
  std::string scene;
  std::vector<std::string> settings;
  std::vector<Mo95Variant> readings;  ///< belong to the interval
  std::vector<Mo95Variant> others;    ///< do not: they only tell
};

/// The plan's runs: the nominal machine, all corners of the assumptions, and at the nominal machine the
/// others.
struct Mo95Spread {
  Mo95Plan plan;
  stats::RunObject nominal;
  std::vector<stats::RunObject> corners, readings, others;
  std::vector<std::string> assumptions;  ///< of the parameters that move a time

  /// Of the plan's readings or others, by name.
  const stats::RunObject& run(const std::string& name) const;
};

/// Corners are those of a small tree's views and frame: which end of a parameter is the faster one does not
/// depend on the tree.
Mo95Spread mo95_spread(const TableContext& context, const Mo95Plan& plan);

using Mo95Metric = std::function<double(const stats::RunObject&)>;

/// The metric's nominal value and its extremes over corners and those readings that have one (not 0).
void set_spread(TableRow& row, const Mo95Spread& spread, const Mo95Metric& metric);

/// The row's figures become those of a case like the nominal one, its ends in the same proportion.
void scale_to(TableRow& row, double nominal);

/// "NAME 1.23 s, NAME 4.56 s" of variants that have the metric.
std::string told(const std::vector<Mo95Variant>& variants, const std::vector<stats::RunObject>& runs,
                 const Mo95Metric& metric);

/// Where the nominal figure lies when what is published is itself a range.
std::string beside(const TableRow& row, double low, double high);

/// Why a figure outside of its interval may be there, or nothing.
std::string outside_note(const TableRow& row, const std::string& slower, const std::string& faster);

/// Programs of a reading: -O1, through FCR31 instead of the sum with a constant, unmapped.
std::vector<Mo95Variant> mo95_program_variants();

std::vector<RowGroup> mo95_frame_groups();  ///< B3, B4, B6 to B9, B11: stored views, frames and their making
std::vector<RowGroup> mo95_tree_groups();   ///< B10, B12: polygons, trees of several sizes
std::vector<RowGroup> mo95_processor_groups();  ///< P: figures of the processor, from the fact sheet

}  // namespace dendro::study
