#include "models/machines/rds3000/clocked_display.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::rds3000 {

void ClockedDisplay::restart(const video::Raster& raster, std::int64_t start_ps, std::int64_t first_ps) {
  raster_ = raster;
  line_start_ps_ = start_ps;
  line_ = 0;
  field_ = false;
  fetch_ps_ = next_ps_ = INT64_MAX;
  if (raster.line_ps == 0) return;
  DENDRO_CHECK(raster.line_ps > 0 && raster.field_lines > 0, "line {} ps, {} lines", raster.line_ps,
               raster.field_lines);
  DENDRO_CHECK(raster.fetches_per_line == 0 || raster.fetch_period_ps > 0, "fetch period {}",
               raster.fetch_period_ps);
  start_line();
  step(first_ps - 1);
}

void ClockedDisplay::start_line() {
  fetches_left_ = line_ < raster_.blank_lines ? 0 : raster_.fetches_per_line;
  fetch_ps_ = line_start_ps_ + raster_.horizontal_blank_ps;
  find_next();
}

void ClockedDisplay::find_next() {
  const std::int64_t line_end = line_start_ps_ + raster_.line_ps;
  if (fetches_left_ == 0 || fetch_ps_ >= line_end) fetch_ps_ = INT64_MAX;
  next_ps_ = std::min(fetch_ps_, line_end);
}

unsigned ClockedDisplay::advance(std::int64_t now_ps) {
  unsigned due = 0;
  while (next_ps_ <= now_ps) {
    if (next_ps_ == fetch_ps_) {
      ++due;
      --fetches_left_;
      fetch_ps_ += raster_.fetch_period_ps;
      find_next();
      continue;
    }
    line_start_ps_ += raster_.line_ps;
    if (++line_ == raster_.field_lines) {
      line_ = 0;
      field_ = !field_;
    }
    start_line();
  }
  return due;
}

}  // namespace dendro::rds3000
