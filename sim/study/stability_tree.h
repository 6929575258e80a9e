#pragma once

#include <vector>

#include "firmware/lib/stability.h"

namespace dendro::study {

/// Drives the nodes of a pixel array's tree, clock by clock, as stability::Rig::tree() says. Sides are powers of two.
std::vector<std::vector<std::int64_t>> drive_tree(int width, int height, const stability::TreeDrive& drive,
                                                  const std::vector<stability::TreeStream>& streams,
                                                  const std::vector<stability::TreePixel>& pixels);

}  // namespace dendro::study
