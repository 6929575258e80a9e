#include "firmware/zbuffer_views/sgi_4d35/directions.h"

uint32_t circle_views(uint32_t bands, uint32_t k) {
  if (k == 0 || k == bands) return 1;
  /* The sine of a rational part of a half turn is rational at the sixths and the half only: everywhere else
     2 * bands * sin is no integer, and double precision tells which ones it lies between. */
  if (2 * k == bands) return 2 * bands + 1;
  if (6 * k == bands || 6 * k == 5 * bands) return bands + 1;
  return (uint32_t)(int)(2.0 * bands * turn_sine((long)k, 2 * (long)bands)) + 1;
}

uint32_t all_views(uint32_t bands) {
  uint32_t views = 0;
  for (uint32_t k = 0; k <= bands; ++k) views += circle_views(bands, k);
  return views;
}

static void make_view(uint32_t bands, struct zbv_view* view) {
  const double kPi = 3.1415926535897931;
  const long k = (long)view->circle, n = (long)bands, j = (long)view->number, m = (long)view->circle_views;
  const double st = turn_sine(k, 2 * n), ct = turn_cosine(k, 2 * n), sp = turn_sine(j, m),
               cp = turn_cosine(j, m);
  const double rows[9] = {cp, 0, -sp, -ct * sp, st, -ct * cp, -st * sp, -ct, -st * cp};
  view->theta = (float)(kPi * (double)k / (double)n);
  view->phi = (float)(2 * kPi * (double)j / (double)m);
  for (int i = 0; i < 9; ++i) view->frame[i] = (float)rows[i];
}

void make_views(uint32_t bands, struct zbv_view* views) {
  for (uint32_t k = 0; k <= bands; ++k) {
    const uint32_t count = circle_views(bands, k);
    for (uint32_t j = 0; j < count; ++j, ++views) {
      memset(views, 0, sizeof *views);
      views->circle = k;
      views->number = j;
      views->circle_views = count;
      make_view(bands, views);
    }
  }
}
