#pragma once

#include <vector>

#include "sim/study/table_rows.h"

namespace dendro::study {

std::vector<RowGroup> fg86_time_groups();     ///< A7, A10, A38: the icosahedron
std::vector<RowGroup> fg86_machine_groups();  ///< A1 to A6, A17: microprograms and sizes
std::vector<RowGroup> fg86_growth_groups();   ///< A11, A12, A18, A20, A21, A31, A32: splitting normals
std::vector<RowGroup> fg86_hull_groups();     ///< A19, A29, A33, A34: boxes, several hulls
std::vector<RowGroup>
fg86_surface_groups();  ///< A6, A8, A16, A27, A28: roughening and colour, programs alone
std::vector<RowGroup> fg86_texture_groups();  ///< A9, A13 to A15, A28: the texture cube, its program alone
std::vector<RowGroup> fg86_tree_groups();     ///< A10, A26, A35, A36: the complete tree, views of it, trunks
std::vector<RowGroup> fg86_planes_groups();   ///< A22 to A25, A38: the machine that FG86 6.3 proposes
std::vector<RowGroup> fg86_texels_groups();   ///< A28 on that machine
std::vector<RowGroup> fg86_open_groups();     ///< claims without an experiment here, and why

}  // namespace dendro::study
