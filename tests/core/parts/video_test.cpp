#include "models/parts/video/video.h"

#include <gtest/gtest.h>

#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/video/video_timing.h"

namespace dendro::video {
namespace {

Raster raster(DisplayMode mode) { return raster_of(power_on(mode), {mode, 0}, 128); }

TEST(Raster, TheOperatingPointsGiveTheSheetsTimes) {
  const Raster lores = raster(DisplayMode::kLores30);
  EXPECT_EQ(lores.line_ps, 60'000'000);
  EXPECT_EQ(lores.fetch_period_ps, 1'440'000);
  EXPECT_EQ(lores.fetches_per_line, 32);
  EXPECT_EQ(lores.field_lines - lores.blank_lines, 256);
  const Raster fast = raster(DisplayMode::kLores60);
  EXPECT_EQ(fast.line_ps, 28'800'000);
  EXPECT_EQ(fast.fetch_period_ps, 576'000);
  EXPECT_EQ(fast.field_lines - fast.blank_lines, 512);
  const Raster hires = raster(DisplayMode::kHires30);
  EXPECT_EQ(hires.fetch_period_ps, 1'216'000);
  EXPECT_EQ(hires.fetches_per_line, 16);
}

TEST(Raster, ABlankedDisplayFetchesNothingAndIsAlwaysInVerticalBlank) {
  const Raster blanked = raster(DisplayMode::kBlanked);
  EXPECT_EQ(FetchCursor(blanked, 0, 0, 200000).tick(), kNever);
  EXPECT_TRUE((Phase{blanked, 0}.vertical_blank(123456789)));
}

TEST(FetchCursor, VisitsTheClosedFormOfEveryFetchOfAFrame) {
  const Raster r = raster(DisplayMode::kLores30);
  FetchCursor cursor(r, 0, 0, 200000);
  for (std::int64_t field = 0; field < 3; ++field)
    for (std::int64_t line = r.blank_lines; line < r.field_lines; ++line)
      for (std::int64_t i = 0; i < r.fetches_per_line; ++i) {
        const std::int64_t ps = (field * r.field_lines + line) * r.line_ps + r.horizontal_blank_ps + i * r.fetch_period_ps;
        ASSERT_EQ(cursor.tick(), (ps + 199999) / 200000) << field << " " << line << " " << i;
        cursor.advance();
      }
}

TEST(FetchCursor, StartsAtTheFirstFetchNotBeforeItsTime) {
  const Raster r = raster(DisplayMode::kLores30);
  FetchCursor all(r, -5'000'000'000, 0, 200000);
  const std::int64_t first = all.tick();
  EXPECT_GE(first, 0);
  FetchCursor later(r, -5'000'000'000, first * 200000 + 1, 200000);
  all.advance();
  EXPECT_EQ(later.tick(), all.tick());
}

TEST(Monitor, ShowsAPixelThroughCrossbarAndTable) {
  State state = power_on(DisplayMode::kLores30);
  dr64::Core memory({3, 1});
  memory.write(2u << 11 | 3u << 1, 0x030201, bps32::kFnLores);
  Frame straight = monitor(state, memory);
  ASSERT_EQ(straight.width, 512);
  ASSERT_EQ(straight.height, 512);
  const std::uint8_t* pixel = &straight.rgb[3 * (2 * 512 + 3)];
  EXPECT_EQ(pixel[0], 1);
  EXPECT_EQ(pixel[1], 2);
  EXPECT_EQ(pixel[2], 3);

  for (unsigned line = 0; line < 24; ++line) state.crossbar[line] = static_cast<std::uint8_t>(16 + line % 8);
  state.lut[3] = 0x3FFu << 10;  // full green
  const Frame routed = monitor(state, memory);
  pixel = &routed.rgb[3 * (2 * 512 + 3)];
  EXPECT_EQ(pixel[0], 0);
  EXPECT_EQ(pixel[1], 255);
  EXPECT_EQ(pixel[2], 0);
}

TEST(Monitor, ZoomRepeatsPixelsAndTheViewportCropsThem) {
  State state = power_on(DisplayMode::kLores30);
  state.fbc[1] = 3u | 1u << 16;
  state.fbc[3] = 1;  // columns twice
  dr64::Core memory({3, 1});
  memory.write(1u << 1, 0x00000F, bps32::kFnLores);
  const Frame frame = monitor(state, memory);
  ASSERT_EQ(frame.width, 4);
  ASSERT_EQ(frame.height, 2);
  EXPECT_EQ(frame.rgb[3 * 1], 0);
  EXPECT_EQ(frame.rgb[3 * 2], 0x0F);
  EXPECT_EQ(frame.rgb[3 * 3], 0x0F);
}

TEST(Monitor, RepeatFieldShowsEveryLineOnce) {
  const Frame frame = monitor(power_on(DisplayMode::kLores60), dr64::Core({3, 1}));
  EXPECT_EQ(frame.height, 512);
}

}  // namespace
}  // namespace dendro::video
