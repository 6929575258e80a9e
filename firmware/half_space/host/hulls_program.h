#pragma once

#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::half_space {

/// Throws UserError unless the microprogram has the scratch areas `box`, `params` and `records`, and the
/// records of every hull fit between `records` and the end of `scratch_words`. `where` is the scene's.
void check_fits(const PreparedHulls& prepared, const lib::ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where);

/// What the VAX does: one program load, nearest cleared, then the hulls one after another: records, start,
/// wait. `repeat_field`: see RdsDriver::set_viewport.
void run(HostPort& host, const PreparedHulls& prepared, const lib::ProgramImage& image,
         bool repeat_field = false);

}  // namespace dendro::half_space
