#pragma once

#include <string>
#include <vector>

#include "sim/study/table_rows.h"

namespace dendro::study {

/// What one run of the workstation's programs tells.
double mo95_frame_seconds(const stats::RunObject& run);       ///< a picture: without reading and what is done once
double mo95_precompute_seconds(const stats::RunObject& run);  ///< all views, the whole program; 0 if it was not timed
double mo95_tree_seconds(const stats::RunObject& run);        ///< reading a tree and its normals, once a sequence

/// A run of one frame of a shipped scene with these settings.
SceneRun mo95_scene(const std::string& scene, const std::vector<std::string>& settings);

/// Runs in workers, in their order, from the cache where it has them. Throws UserError for the first that
/// failed.
std::vector<stats::RunObject> mo95_runs(const TableContext& context, const std::vector<SceneRun>& runs,
                                        const std::string& name);

/// A scene at the nominal machine and at all corners of the assumptions, and other readings at the nominal
/// machine.
struct Mo95Spread {
  stats::RunObject nominal;
  std::vector<stats::RunObject> corners, readings;
  std::vector<std::string> assumptions;  ///< of the parameters that move a time
};

/// Corners are those of a small tree's views and frame: which end of a parameter is the faster one does not
/// depend on the tree.
Mo95Spread mo95_spread(const TableContext& context, const SceneRun& run, const std::vector<SceneRun>& readings,
                       const std::string& name);

/// The metric's nominal value and its extremes over corners and readings.
void set_spread(TableRow& row, const Mo95Spread& spread, const std::function<double(const stats::RunObject&)>& metric);

/// Why a figure outside of its interval may be there, or nothing.
std::string outside_note(const TableRow& row, const std::string& slower, const std::string& faster);

std::vector<RowGroup> mo95_frame_groups();  ///< B3, B4, B6 to B9, B11: stored views, frames and their making
std::vector<RowGroup> mo95_tree_groups();   ///< B1, B10, B12: directions, polygons, trees of several sizes

}  // namespace dendro::study
