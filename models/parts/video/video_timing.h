#pragma once

#include <cstdint>

#include "models/parts/video/video.h"

namespace dendro::video {

constexpr std::int64_t kNever = INT64_MAX / 4;

/// Blanking and field at any time, in closed form. `origin_ps` is the start of a field 0.
struct Phase {
  Raster raster;
  std::int64_t origin_ps = 0;

  bool vertical_blank(std::int64_t time_ps) const;
  bool second_field(std::int64_t time_ps) const;
};

/// The fetches of a raster one after the other, as ticks: the first edge at or after each fetch's time.
class FetchCursor {
 public:
  FetchCursor() = default;
  /// Starts with the first fetch at or after `from_ps`.
  FetchCursor(const Raster& raster, std::int64_t origin_ps, std::int64_t from_ps, std::int64_t tick_ps);

  std::int64_t tick() const { return tick_; }  ///< of the next fetch; kNever when nothing is displayed
  std::int64_t time_ps() const { return next_ps_; }
  void advance();

 private:
  void line_start(std::int64_t line);
  void aim();

  Raster raster_;
  std::int64_t origin_ps_ = 0, tick_ps_ = 1;
  std::int64_t line_ = 0;   ///< lines since the origin, blank ones counted
  std::int64_t index_ = 0;  ///< fetch in the line
  std::int64_t next_ps_ = 0;
  std::int64_t tick_ = kNever;
};

}  // namespace dendro::video
