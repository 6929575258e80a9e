#pragma once

#include <vector>

#include "sim/scene/image_io.h"
#include "sim/study/table.h"

namespace dendro::study {

/// Every row whose figure has a published one beside it and is not simply equal to it, as an interval over
/// the published value, on a logarithmic axis: bar from low to high, tick at the nominal figure, green when
/// the published value is inside. Rows of figures that are not positive are left out. No value when no row is
/// left.
std::optional<scene::RgbImage> draw_table(const std::vector<TableRow>& rows);

}  // namespace dendro::study
