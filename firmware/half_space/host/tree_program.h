#pragma once

#include <functional>
#include <vector>

#include "firmware/half_space/host/prepare_tree.h"
#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::half_space {

/// The microprograms of a complete tree; only those that the tree needs have words.
struct TreePrograms {
  lib::ProgramImage hulls, roughen, texture, colour;
};

/// What the host program must know of the machine beside its programs.
struct TreeSite {
  std::uint32_t control_store_words = 4096;
  bool repeat_field = false;  ///< see RdsDriver::set_viewport
};

/// What the VAX does for a complete tree: the cube is made, or `cube`, made beforehand, is sent; each crown
/// is scanned, roughened and merged; then come the trunks, the nearest first; then colour replaces depth. A
/// program is loaded when it is not in the control store. `before_colour` is called when the nearest register
/// is complete.
void run(HostPort& host, const PreparedTree& tree, const TreePrograms& programs, const CubeBytes& cube,
         const TreeSite& site, const std::function<void()>& before_colour);

}  // namespace dendro::half_space
