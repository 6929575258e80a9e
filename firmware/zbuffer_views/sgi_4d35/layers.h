#pragma once

#include "firmware/zbuffer_views/sgi_4d35/scan.h"

/* What one layer holds at one sample: z, and latitude, longitude, colour in one word. While a view is drawn
 * the layers of a sample lie together; the file has planes. */
struct sample {
  float z;
  uint32_t attributes; /* latitude << 16 | longitude << 8 | colour */
};

struct layers {
  int32_t width, height, count;
  float threshold;
  struct sample* samples;
  struct sample** rows; /* the first sample of each */
  uint32_t* before;     /* peel: the triangle that each sample's layer above came from */
  uint32_t* now;
};

void make_layers(struct layers* to, const struct zbv_job* job, const char* job_path);
void clear_layers(struct layers* to);

/* Draws triangles in their order with the rule *insert*: one pass, whose result depends on the order. */
void insert_triangles(struct layers* to, const struct corner* corners, const struct zbv_triangle* triangles,
                      const uint32_t* attributes, uint32_t count);
/* With the rule *peel*: one pass a layer, independent of the order. */
void peel_triangles(struct layers* to, const struct corner* corners, const struct zbv_triangle* triangles,
                    const uint32_t* attributes, uint32_t count);

/* Planes of one view behind what the file holds; `planes` has room for one layer's. */
void write_layers(const struct layers* from, void* planes, const struct output* to);
