#pragma once

#include <string>

#include "firmware/lib/stability.h"
#include "firmware/lib/workstation_rig.h"
#include "firmware/zbuffer_views/stability/program_files.h"

namespace dendro::zbuffer_views {

using stability::Bound;

/// Counts faults and keeps the first one's description.
struct Faults {
  std::int64_t count = 0;
  std::string first;

  void fault(const std::string& where) {
    if (count++ == 0) first = where;
  }
};

/// Runs a program of the rig's machine. The rig has to be that of a workstation.
std::string exec(const stability::Rig& rig, const std::string& program, const std::vector<std::string>& arguments,
                 stability::Files& files);

/// What the shipped programs make of files on a machine.
ViewsFile precomputed(const stability::Rig& rig, const TreeFile& tree, const JobFile& job);
Pictures reconstructed(const stability::Rig& rig, const ViewsFile& views, const JobFile& job);
Pictures polygons(const stability::Rig& rig, const TreeFile& tree, const JobFile& job);

/// Views without samples, `bands` bands, one layer of side * side samples a view, `pitch` apart, the middle of the window at
/// the tree's centre; every colour has both sides alike.
struct Blank {
  TreeFile tree;
  ViewsFile views;
  JobFile job;  ///< parallel, 40 x 40 pixels, frames are to be set
};
Blank blank_views(const stability::Rig& rig, int bands, int side, float pitch);

/// Puts a sample into layer 0; its normal points up.
void put_sample(ViewsFile& views, std::size_t view, int i, int j, float z, std::uint8_t colour);

/// A row that counts faults, of which there may be none.
stability::Row no_fault(const char* id, const std::string& what, const Faults& tally, const char* unit, const char* reference);
/// A row of a fault that has to show.
stability::Row must_show(const char* id, const std::string& what, double measured, const char* unit, const char* reference);

/// A camera far away in direction `to_viewer`, of any length but zero; right and up are horizontal where they can be.
zbv_frame facing(const std::array<double, 3>& to_viewer, double distance);

}  // namespace dendro::zbuffer_views
