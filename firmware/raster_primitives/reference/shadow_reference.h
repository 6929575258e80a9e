#pragma once

#include "firmware/raster_primitives/reference/reference.h"

namespace dendro::raster_primitives {

/// Marks the pixels whose point a caster hides from the light and halves their colours. A caster hides what lies behind its plane
/// by more than its bias, as on the machine.
void cast_shadows(const Prepared& prepared, Reference& picture);

}  // namespace dendro::raster_primitives
