#pragma once

#include <cstdint>

#include "models/parts/video/video.h"

namespace dendro::rds3000 {

/// The display scan of the clocked level: counters that walk through fields, lines and fetches in
/// picoseconds.
class ClockedDisplay {
 public:
  /// Field 0, line 0 starts at `start_ps`; events before `first_ps` are dropped.
  void restart(const video::Raster& raster, std::int64_t start_ps, std::int64_t first_ps);

  /// Moves to `now_ps` (never back); returns how many fetches fell due since the call before, `now_ps`
  /// included.
  unsigned step(std::int64_t now_ps) { return now_ps < next_ps_ ? 0 : advance(now_ps); }

  const video::Raster& raster() const { return raster_; }
  bool vertical_blank() const { return raster_.line_ps == 0 || line_ < raster_.blank_lines; }
  bool field() const { return field_; }
  std::int64_t line() const { return line_; }

 private:
  unsigned advance(std::int64_t now_ps);
  void start_line();
  void find_next();

  video::Raster raster_;
  std::int64_t line_start_ps_ = 0, line_ = 0;
  std::int64_t fetches_left_ = 0, fetch_ps_ = INT64_MAX;
  std::int64_t next_ps_ = INT64_MAX;  ///< the next fetch or the next line, whichever comes first
  bool field_ = false;
};

}  // namespace dendro::rds3000
