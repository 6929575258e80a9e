#pragma once

#include "firmware/half_space/host/prepare.h"
#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::half_space {

using lib::ProgramImage;
using lib::RdsDriver;
using lib::ScratchArea;

/// Throws UserError unless the microprogram has the scratch areas `box`, `params` and `records`, and the
/// plane records fit between `records` and the end of `scratch_words`. `where` is the scene's.
void check_fits(const Prepared& prepared, const ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where);

/// Throws UserError unless the microprogram has these scratch areas with at least so many words.
void check_areas(const ProgramImage& image, const std::vector<std::pair<std::string, std::uint32_t>>& areas);

/// Throws UserError unless the records fit between `records` and the end of the scratchpad.
void check_records(const PlaneProgram& program, const ProgramImage& image, std::uint32_t scratch_words,
                   const scene::Where& where);

/// Throws UserError for a program that needs an adder which the microprogram does not have.
[[noreturn]] void refuse_saturation(const scene::Where& where);

/// The words of the scratch area `box`.
std::vector<std::uint32_t> box_words(const Box& box);

/// The host's arithmetic before the first plane is sent: grows (phase "grow"), then sets up (phase `set_up`).
void compute_set_up(HostPort& host, const Work& growth, std::uint64_t setup_flops, std::string_view set_up);

/// The words of the look-up table: entry f of every 256 the shade of face f, 8 bits widened to 10.
std::vector<std::uint32_t> look_up_table(const std::vector<Rgb>& shades);

/// What the VAX does: loads microprogram, planes and tables, lets the processor run passes 0 to 4, and waits.
/// `repeat_field`: see RdsDriver::set_viewport.
void run(HostPort& host, const Prepared& prepared, const ProgramImage& image, bool repeat_field = false);

}  // namespace dendro::half_space
