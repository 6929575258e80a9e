#pragma once

#include "firmware/zbuffer_views/sgi_4d35/reproject.h"
#include "firmware/zbuffer_views/sgi_4d35/rounding.h"

/* Finished pictures: planes with the highest row first. */
struct picture {
  struct zbv_picture facts;
  uint32_t width, height;
  float* depth;
  uint8_t *red, *green, *blue, *colour;
};

void make_picture(struct picture* to, const struct zbv_job* job, const char* job_path);
void write_picture(const struct picture* from, const struct output* to);
void make_pictures_head(const struct zbv_job* job, const char* job_path, struct zbv_pictures* head);

/* Sines and cosines of the bytes of normals. */
struct angles {
  float sine_latitude[256], cosine_latitude[256], sine_longitude[256], cosine_longitude[256];
};
void make_angles(struct angles* angles);

/* A colour of the table, by channels of 0..255. */
struct shade_colour {
  float channel[3];
  uint32_t below, is_leaf;
};
struct shade_colour* shade_colours(const struct zbv_colour* colours, uint32_t count, const char* job_path);

struct shading {
  const struct zbv_job* job;
  const struct angles* angles;
  const struct shade_colour* colours;
  int late; /* leaves have their sides chosen here */
};

/* V8. `buffer` is what the light sees through `light`, NULL without shadows; counts covered and shadowed
 * pixels.
 */
void shade(const struct shading* how, const struct zbv_frame* frame, const struct target* seen,
           const struct screen* light, const struct target* buffer, struct picture* to);

/* c * shade, rounded, for 0 <= shade <= 1. */
static inline uint8_t shaded(float channel, float shade) {
  return (uint8_t)floor_to_int(channel * shade + 0.5f);
}
