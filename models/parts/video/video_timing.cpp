#include "models/parts/video/video_timing.h"

namespace dendro::video {
namespace {

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }

}  // namespace

bool Phase::vertical_blank(std::int64_t time_ps) const {
  if (raster.line_ps == 0) return true;
  const std::int64_t line = floor_div(time_ps - origin_ps, raster.line_ps);
  return line - floor_div(line, raster.field_lines) * raster.field_lines < raster.blank_lines;
}

bool Phase::second_field(std::int64_t time_ps) const {
  if (raster.line_ps == 0) return false;
  return floor_div(time_ps - origin_ps, raster.field_ps()) & 1;
}

FetchCursor::FetchCursor(const Raster& raster, std::int64_t origin_ps, std::int64_t from_ps, std::int64_t tick_ps)
    : raster_(raster), origin_ps_(origin_ps), tick_ps_(tick_ps) {
  const bool displays = raster.line_ps > 0 && raster.fetches_per_line > 0 && raster.blank_lines < raster.field_lines;
  if (!displays) return;
  line_start(floor_div(from_ps - origin_ps, raster.line_ps));
  while (next_ps_ < from_ps) advance();
}

void FetchCursor::line_start(std::int64_t line) {
  const std::int64_t field = floor_div(line, raster_.field_lines);
  const std::int64_t in_field = line - field * raster_.field_lines;
  line_ = in_field < raster_.blank_lines ? field * raster_.field_lines + raster_.blank_lines : line;
  index_ = 0;
  next_ps_ = origin_ps_ + line_ * raster_.line_ps + raster_.horizontal_blank_ps;
  aim();
}

void FetchCursor::aim() { tick_ = -floor_div(-next_ps_, tick_ps_); }

void FetchCursor::advance() {
  if (++index_ == raster_.fetches_per_line) {
    line_start(line_ + 1);
    return;
  }
  next_ps_ += raster_.fetch_period_ps;
  aim();
}

}  // namespace dendro::video
