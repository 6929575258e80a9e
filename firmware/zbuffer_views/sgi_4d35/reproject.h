#pragma once

#include "firmware/zbuffer_views/sgi_4d35/views.h"

/* Where samples go: a z-buffer, and for a camera the attributes of its pixels (latitude << 16 | longitude <<
 * 8 | colour). Rows from the lowest up. ASSUMED DEV-153. */
struct target {
  int32_t width, height;
  float** rows;         /* the first z of each row */
  uint32_t* attributes; /* NULL: z only */
};

void make_target(struct target* to, uint32_t width, uint32_t height, int with_attributes, const char* path);
void clear_target(struct target* to);

/* From coordinates of a stored view to the target: column and row (with 1/2 added) and depth. In perspective
 * column and row are still to be divided by the depth. */
struct warp {
  float m[3][4];
  int perspective, full_product, skip_empty;
  float near;
  uint32_t turn; /* added to the longitudes */
};

/* A picture's coordinates: frame, eye (double, so that far places cancel), scale and centre. */
struct screen {
  double frame[9], eye[3], scale, centre_x, centre_y;
};

void make_warp(const struct screen* screen, const struct zbv_placement* tree, const struct zbv_view* view,
               struct warp* warp);

/* V6: all layers of a view, front to back. */
void reproject(const struct zbv_views* facts, const struct zbv_view* view, const uint8_t* planes,
               const struct warp* warp, const struct target* to);
