#pragma once

#include <optional>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/prepare_hulls.h"
#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::half_space {

/// Throws UserError unless the microprogram has the scratch areas `box`, `params` and `records`, and the
/// records of every hull and trunk fit between `records` and the end of `scratch_words`. `where` is the
/// scene's.
void check_fits(const PreparedHulls& prepared, const lib::ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where);

/// hulls.gia as the VAX drives it: what it draws with, one start after another.
class HullsDriver {
 public:
  HullsDriver(HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image)
      : host_(host), driver_(driver), image_(image), entry_(image.entry) {}

  /// The entry point where the program lies now.
  void set_entry(std::uint32_t entry) { entry_ = entry; }

  /// nearest := maxdepth in the whole picture.
  void clear(int width, int height, int maxdepth);

  void draw(const PlaneProgram& program, HullAction action);

  /// kMerge of what lies in the box.
  void merge(const PlaneProgram& program, const Box& box);

  void paint(const Trapezium& trapezium, int maxdepth);

  /// After kPasses: the pixels that the box shrank to; no value when it is empty.
  std::optional<Box> box_left();

 private:
  void send(const PlaneProgram& program, HullAction action, const std::vector<std::uint32_t>& records);

  HostPort& host_;
  lib::RdsDriver& driver_;
  const lib::ProgramImage& image_;
  std::uint32_t entry_;
};

/// What the VAX does: one program load, nearest cleared, then the hulls one after another: records, start,
/// wait. `repeat_field`: see RdsDriver::set_viewport.
void run(HostPort& host, const PreparedHulls& prepared, const lib::ProgramImage& image,
         bool repeat_field = false);

}  // namespace dendro::half_space
