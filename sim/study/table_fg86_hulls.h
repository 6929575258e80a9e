#pragma once

#include <vector>

#include "sim/study/table.h"

namespace dendro::study {

/// FG86's claims on growing crowns, boxes and several hulls: A12, A18, A20, A33, A34.
std::vector<TableRow> fg86_hull_rows(const TableContext& context);

}  // namespace dendro::study
