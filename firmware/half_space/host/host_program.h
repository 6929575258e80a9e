#pragma once

#include "firmware/half_space/host/prepare.h"
#include "firmware/half_space/host/rds_driver.h"

namespace dendro::half_space {

/// Throws UserError unless the microprogram has the scratch areas `box`, `params` and `records`, and the
/// plane records fit between `records` and the end of `scratch_words`. `where` is the scene's.
void check_fits(const Prepared& prepared, const ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where);

/// The words of the look-up table: entry f of every 256 the shade of face f, 8 bits widened to 10.
std::vector<std::uint32_t> look_up_table(const std::vector<Rgb>& shades);

/// What the VAX does: loads microprogram, planes and tables, lets the processor run passes 0 to 4, and waits.
void run(HostPort& host, const Prepared& prepared, const ProgramImage& image);

}  // namespace dendro::half_space
