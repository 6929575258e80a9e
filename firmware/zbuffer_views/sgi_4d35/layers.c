#include "firmware/zbuffer_views/sgi_4d35/layers.h"

void make_layers(struct layers* to, const struct zbv_job* job, const char* job_path) {
  const size_t samples = job->view_width * job->view_height;
  to->width = (int32_t)job->view_width;
  to->height = (int32_t)job->view_height;
  to->count = (int32_t)job->layers;
  to->threshold = job->threshold;
  to->samples = need(samples * job->layers * sizeof *to->samples, job_path);
  to->rows = need(job->view_height * sizeof *to->rows, job_path);
  for (uint32_t j = 0; j < job->view_height; ++j)
    to->rows[j] = to->samples + j * job->view_width * job->layers;
  to->before = to->now = NULL;
  if (job->rule == kZbvPeel) {
    to->before = need(samples * sizeof *to->before, job_path);
    to->now = need(samples * sizeof *to->now, job_path);
  }
}

void clear_layers(struct layers* to) {
  const size_t count = (size_t)(to->width * to->height * to->count);
  for (struct sample *s = to->samples, *end = s + count; s != end; ++s) {
    s->z = kZbvEmptyDepth;
    s->attributes = kZbvEmptyColour;
  }
}

struct fragments {
  struct layers* layers;
  uint32_t attributes, triangle;
  int32_t layer; /* peel */
};

static void put_sample(struct sample* layers, int32_t count, float threshold, float z, uint32_t attributes) {
  for (struct sample *k = layers, *end = layers + count; k != end; ++k) {
    if (z < k->z) {
      if (!(k->z - z < threshold))
        for (struct sample* last = end - 1; last != k; --last) *last = last[-1];
      k->z = z;
      k->attributes = attributes;
      return;
    }
    if (z - k->z < threshold) return;
  }
}

/* Not inlined, so that a profile by function tells insertion from scan conversion. */
static __attribute__((noinline)) void insert_span(void* to, int32_t row, int32_t left, int32_t right, float z,
                                                  float step) {
  const struct fragments* f = to;
  const struct layers* l = f->layers;
  const int32_t count = l->count;
  const float threshold = l->threshold;
  const uint32_t attributes = f->attributes;
  struct sample* at = l->rows[row] + left * count;
  for (; left < right; ++left, at += count, z += step) put_sample(at, count, threshold, z, attributes);
}

void insert_triangles(struct layers* to, const struct corner* corners, const struct zbv_triangle* triangles,
                      const uint32_t* attributes, uint32_t count) {
  struct fragments f = {to, 0, 0, 0};
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t* corner = triangles[i].corner;
    f.attributes = attributes[i];
    scan_triangle(corners + corner[0], corners + corner[1], corners + corner[2], to->width, to->height,
                  insert_span, &f);
  }
}

/* The nearest fragment that lies behind the layer above by the threshold; of equal ones the first triangle's.
 */
static __attribute__((noinline)) void peel_span(void* to, int32_t row, int32_t left, int32_t right, float z,
                                                float step) {
  const struct fragments* f = to;
  const struct layers* l = f->layers;
  for (int32_t i = left; i < right; ++i, z += step) {
    const int32_t at = row * l->width + i;
    struct sample* here = l->samples + at * l->count + f->layer;
    if (!(z < here->z)) continue;
    if (f->layer > 0) {
      const float above = here[-1].z;
      if (!(z - above >= l->threshold) || z < above) continue;
      if (z == above && f->triangle <= l->before[at]) continue;
    }
    here->z = z;
    here->attributes = f->attributes;
    l->now[at] = f->triangle;
  }
}

void peel_triangles(struct layers* to, const struct corner* corners, const struct zbv_triangle* triangles,
                    const uint32_t* attributes, uint32_t count) {
  for (int32_t layer = 0; layer < to->count; ++layer) {
    struct fragments f = {to, 0, 0, layer};
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t* corner = triangles[i].corner;
      f.attributes = attributes[i];
      f.triangle = i;
      scan_triangle(corners + corner[0], corners + corner[1], corners + corner[2], to->width, to->height,
                    peel_span, &f);
    }
    uint32_t* swap = to->before;
    to->before = to->now;
    to->now = swap;
  }
}

void write_layers(const struct layers* from, void* planes, const struct output* to) {
  const size_t samples = (size_t)(from->width * from->height);
  const int32_t count = from->count;
  for (int32_t layer = 0; layer < count; ++layer) {
    const struct sample* s = from->samples + layer;
    float *z = planes, *const end = z + samples;
    uint8_t *latitude = (uint8_t*)end, *longitude = latitude + samples, *colour = longitude + samples;
    for (; z != end; s += count) {
      const uint32_t attributes = s->attributes;
      *z++ = s->z;
      *latitude++ = (uint8_t)(attributes >> 16);
      *longitude++ = (uint8_t)(attributes >> 8);
      *colour++ = (uint8_t)attributes;
    }
    write_output(to, planes, kZbvSampleBytes * samples);
  }
}
