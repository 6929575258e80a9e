#pragma once

#include <vector>

#include "sim/study/table.h"

namespace dendro::study {

/// Rows on the machine that FG86 6.3 proposes: A22 to A25, A38; none in a catalogue without it. `picture` is A7a, the
/// icosahedron on the frame-buffer machine.
std::vector<TableRow> fg86_planes_rows(const TableContext& context, const TableRow& picture);

}  // namespace dendro::study
