#pragma once

/* Scan conversion of one triangle with parallel projection (V4, V9). */

#include "firmware/zbuffer_views/sgi_4d35/rounding.h"
#include "firmware/zbuffer_views/sgi_4d35/support.h"

/* Corners lie on a grid of 1/256 of a sample, so that coverage is exact in integers. ASSUMED DEV-150. */
enum {
  kFractionBits = 8,
  kUnit = 1 << kFractionBits,
  kGuard =
      5000 * kUnit /* where corners may lie: sums of an edge's products with a fraction stay below 2^31 */
};

struct corner {
  int32_t x, y;
  float z;
};

/* Samples left..right - 1 of a row; z at the left one and its step. */
typedef void span_function(void* to, int32_t row, int32_t left, int32_t right, float z, float step);

static inline int32_t first_sample(int32_t x) { return (x + kUnit - 1) >> kFractionBits; }

/* The first sample at or right of an edge, row after row: x and a remainder. */
struct edge {
  int32_t x, rest, step, rest_step, whole;
};

static inline int32_t floor_quotient(int32_t a, int32_t b, int32_t* rest) {
  int32_t quotient = a / b, left = a - quotient * b;
  if (left < 0) {
    left += b;
    --quotient;
  }
  *rest = left;
  return quotient;
}

/* From `top` to `bottom` (in order of y), in row `row`, which lies between them; the edge crosses `rows` rows
 * from there on. */
static inline void start_edge(struct edge* e, const struct corner* top, const struct corner* bottom,
                              int32_t row, int32_t rows) {
  const int32_t dx = bottom->x - top->x, dy = bottom->y - top->y, ahead = row * kUnit - top->y;
  const int32_t column = top->x >> kFractionBits, fraction = top->x & (kUnit - 1);
  e->whole = dy << kFractionBits;
  if (ahead < kUnit) {
    e->x = column + floor_quotient(fraction * dy + ahead * dx + e->whole - 1, e->whole, &e->rest);
  } else { /* rows above the picture were left out */
    const int64_t from = (int64_t)fraction * dy + (int64_t)ahead * dx + e->whole - 1;
    int64_t quotient = from / e->whole;
    if (from - quotient * e->whole < 0) --quotient;
    e->rest = (int32_t)(from - quotient * e->whole);
    e->x = column + (int32_t)quotient;
  }
  e->step = e->rest_step = 0;
  if (rows > 1) {
    e->step = floor_quotient(dx, dy, &e->rest_step);
    e->rest_step <<= kFractionBits;
  }
}

static inline void next_row(struct edge* e) {
  e->x += e->step;
  e->rest += e->rest_step;
  if (e->rest >= e->whole) {
    e->rest -= e->whole;
    ++e->x;
  }
}

/* Depth of a triangle's plane. In double: in thin triangles, large slopes cancel. */
struct plane {
  double across, down; /* a unit of the grid */
};

static inline void order_by_y(const struct corner** a, const struct corner** b) {
  if ((*a)->y > (*b)->y) {
    const struct corner* t = *a;
    *a = *b;
    *b = t;
  }
}

static inline int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t most(int32_t a, int32_t b) { return a > b ? a : b; }

/* Calls `span` for what a triangle covers of width * height samples: a sample on a left edge or at the lower
 * end belongs to it, one on a right edge or at the upper end does not. Corners lie within the guard. */
static inline __attribute__((always_inline)) void scan_triangle(const struct corner* a,
                                                                const struct corner* b,
                                                                const struct corner* c, int32_t width,
                                                                int32_t height, span_function* span,
                                                                void* to) {
  order_by_y(&a, &b);
  order_by_y(&b, &c);
  order_by_y(&a, &b);
  const int32_t first = most(first_sample(a->y), 0), end = least(first_sample(c->y), height);
  if (first >= end) return;
  const int32_t left_most = most(first_sample(least(a->x, least(b->x, c->x))), 0);
  if (left_most >= least(first_sample(most(a->x, most(b->x, c->x))), width)) return;

  const double bx = b->x - a->x, by = b->y - a->y, cx = c->x - a->x, cy = c->y - a->y;
  const double area = bx * cy - cx * by;
  if (area == 0) return;
  const int corner_is_left = area < 0;
  struct plane depth = {0, 0};
  int has_depth = 0;
  struct edge whole, part;
  start_edge(&whole, a, c, first, end - first);
  int32_t row = first;
  for (int half = 0; half < 2; ++half) {
    const struct corner *top = half ? b : a, *bottom = half ? c : b;
    const int32_t stop = half ? end : least(first_sample(b->y), end);
    if (row >= stop) continue;
    start_edge(&part, top, bottom, row, stop - row);
    for (;;) {
      const int32_t left = most(corner_is_left ? part.x : whole.x, 0),
                    right = least(corner_is_left ? whole.x : part.x, width);
      if (left < right) {
        if (!has_depth) {
          const double bz = (double)b->z - a->z, cz = (double)c->z - a->z, inverse = 1.0 / area;
          depth.across = (bz * cy - cz * by) * inverse;
          depth.down = (cz * bx - bz * cx) * inverse;
          has_depth = 1;
        }
        const double z = a->z + (left * kUnit - a->x) * depth.across + (row * kUnit - a->y) * depth.down;
        span(to, row, left, right, (float)z, (float)(depth.across * kUnit));
      }
      if (++row < end) next_row(&whole);
      if (row >= stop) break;
      next_row(&part);
    }
  }
}
