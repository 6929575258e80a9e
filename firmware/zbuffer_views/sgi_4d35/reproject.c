#include "firmware/zbuffer_views/sgi_4d35/reproject.h"

#include "firmware/zbuffer_views/sgi_4d35/rounding.h"

#define ALWAYS_INLINE static inline __attribute__((always_inline))

void make_target(struct target* to, uint32_t width, uint32_t height, int with_attributes, const char* path) {
  to->width = (int32_t)width;
  to->height = (int32_t)height;
  to->rows = need(height * sizeof *to->rows, path);
  to->rows[0] = need(width * height * sizeof(float), path);
  for (uint32_t j = 1; j < height; ++j) to->rows[j] = to->rows[j - 1] + width;
  to->attributes = with_attributes ? need(width * height * sizeof *to->attributes, path) : NULL;
}

void clear_target(struct target* to) {
  const size_t pixels = (size_t)(to->width * to->height);
  for (float *z = to->rows[0], *end = z + pixels; z != end; ++z) *z = kZbvFarDepth;
  if (!to->attributes) return;
  for (uint32_t *a = to->attributes, *end = a + pixels; a != end; ++a) *a = kZbvEmptyColour;
}

void make_warp(const struct screen* screen, const struct zbv_placement* tree, const struct zbv_view* view,
               struct warp* warp) {
  const double c = turn_cosine((long)tree->turn, kZbvTurns), s = turn_sine((long)tree->turn, kZbvTurns);
  const double move[3] = {tree->at[0] - screen->eye[0], tree->at[1] - screen->eye[1],
                          tree->at[2] - screen->eye[2]};
  double m[3][4];
  for (int i = 0; i < 3; ++i) {
    const double* row = screen->frame + 3 * i;
    /* The screen's row in the tree's own axes, then in the view's. */
    const double own[3] = {row[0] * c - row[2] * s, row[1], row[0] * s + row[2] * c};
    for (int j = 0; j < 3; ++j) {
      const float* axis = view->frame + 3 * j;
      m[i][j] = own[0] * axis[0] + own[1] * axis[1] + own[2] * axis[2];
    }
    m[i][3] = row[0] * move[0] + row[1] * move[1] + row[2] * move[2];
  }
  for (int j = 0; j < 4; ++j) {
    const double last = warp->perspective ? m[2][j] : j == 3;
    warp->m[0][j] = (float)(screen->scale * m[0][j] + (screen->centre_x + 0.5) * last);
    warp->m[1][j] = (float)(screen->scale * m[1][j] + (screen->centre_y + 0.5) * last);
    warp->m[2][j] = (float)m[2][j];
  }
}

/* One row of one layer. */
struct row {
  const float* z;
  const uint8_t *latitude, *longitude, *colour;
  int32_t samples;
  float x0, y, pitch;
};

enum kind { kPerspective = 1, kFull = 2, kSkip = 4, kDepthOnly = 8 };

/* Every call has a constant `kind`, and so leaves out what that kind does not need. */
ALWAYS_INLINE void warp_row(const struct row* r, const struct warp* w, const struct target* to, int kind) {
  const float m00 = w->m[0][0], m10 = w->m[1][0], m20 = w->m[2][0];
  const float m01 = w->m[0][1], m11 = w->m[1][1], m21 = w->m[2][1];
  const float m02 = w->m[0][2], m12 = w->m[1][2], m22 = w->m[2][2];
  const float m03 = w->m[0][3], m13 = w->m[1][3], m23 = w->m[2][3];
  const float dx = m00 * r->pitch, dy = m10 * r->pitch, dz = m20 * r->pitch, near = w->near;
  float x = m00 * r->x0 + m01 * r->y + m03, y = m10 * r->x0 + m11 * r->y + m13,
        z = m20 * r->x0 + m21 * r->y + m23;
  float** const rows = to->rows;
  float* const first = rows[0];
  uint32_t* const attributes = to->attributes;
  const uint32_t width = (uint32_t)to->width, height = (uint32_t)to->height, turn = w->turn;
  const float *at = r->z, *const end = at + r->samples;
  for (; at != end; ++at, x += dx, y += dy, z += dz) {
    const float stored = *at;
    if ((kind & kSkip) && stored == kZbvEmptyDepth) continue;
    float px, py, depth;
    if (kind & kFull) {
      const float sx = r->x0 + (float)(int32_t)(at - r->z) * r->pitch, sy = r->y;
      px = m00 * sx + m01 * sy + m02 * stored + m03;
      py = m10 * sx + m11 * sy + m12 * stored + m13;
      depth = m20 * sx + m21 * sy + m22 * stored + m23;
    } else {
      px = x + stored * m02;
      py = y + stored * m12;
      depth = z + stored * m22;
    }
    if (kind & kPerspective) {
      if (!(depth > near)) continue;
      const float inverse = 1.0f / depth;
      px *= inverse;
      py *= inverse;
    }
    const uint32_t i = (uint32_t)floor_to_int(px), j = (uint32_t)floor_to_int(py);
    if (i >= width || j >= height) continue;
    float* const pixel = rows[j] + i;
    if (!(depth < *pixel)) continue;
    *pixel = depth;
    if (!(kind & kDepthOnly)) {
      const int32_t n = (int32_t)(at - r->z);
      attributes[pixel - first] =
          (uint32_t)r->latitude[n] << 16 | ((r->longitude[n] + turn) & 0xFF) << 8 | r->colour[n];
    }
  }
}

#define ZBV_KINDS(kind) \
  kind(0) kind(1) kind(2) kind(3) kind(4) kind(5) kind(6) kind(7) kind(8) kind(10) kind(12) kind(14)
#define ZBV_ROW_OF(kind)                                                                            \
  static void warp_row_##kind(const struct row* r, const struct warp* w, const struct target* to) { \
    warp_row(r, w, to, kind);                                                                       \
  }
#define ZBV_ENTRY_OF(kind) [kind] = warp_row_##kind,
ZBV_KINDS(ZBV_ROW_OF)

typedef void row_function(const struct row* r, const struct warp* w, const struct target* to);

void reproject(const struct zbv_views* facts, const struct zbv_view* view, const uint8_t* planes,
               const struct warp* warp, const struct target* to) {
  static row_function* const kRows[16] = {ZBV_KINDS(ZBV_ENTRY_OF)};
  row_function* const warp_one =
      kRows[(warp->perspective ? kPerspective : 0) | (warp->full_product ? kFull : 0) |
            (warp->skip_empty ? kSkip : 0) | (to->attributes ? 0 : kDepthOnly)];
  const uint32_t samples = facts->width * facts->height;
  for (uint32_t layer = 0; layer < facts->layers; ++layer, planes += kZbvSampleBytes * samples) {
    struct row r = {(const float*)planes,
                    planes + 4 * samples,
                    planes + 5 * samples,
                    planes + 6 * samples,
                    (int32_t)facts->width,
                    view->x0,
                    0,
                    facts->pitch};
    for (uint32_t j = 0; j < facts->height; ++j) {
      r.y = view->y0 + (float)(int32_t)j * facts->pitch;
      warp_one(&r, warp, to);
      r.z += facts->width;
      r.latitude += facts->width;
      r.longitude += facts->width;
      r.colour += facts->width;
    }
  }
}
