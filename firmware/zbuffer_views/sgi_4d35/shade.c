#include "firmware/zbuffer_views/sgi_4d35/shade.h"

void make_angles(struct angles* angles) {
  for (long b = 0; b < 256; ++b) {
    angles->sine_latitude[b] = (float)-turn_cosine(b, 510);
    angles->cosine_latitude[b] = (float)turn_sine(b, 510);
    angles->sine_longitude[b] = (float)turn_sine(b, 256);
    angles->cosine_longitude[b] = (float)turn_cosine(b, 256);
  }
}

/* The product of a direction with all normals is cos(latitude) * across[longitude] + up[latitude]. */
struct direction {
  float across[256], up[256];
};

static void make_direction(struct direction* d, const struct angles* angles, const float* v) {
  for (int b = 0; b < 256; ++b) {
    d->across[b] = angles->sine_longitude[b] * v[0] + angles->cosine_longitude[b] * v[2];
    d->up[b] = angles->sine_latitude[b] * v[1];
  }
}

static inline float product(const struct direction* d, const struct angles* angles, uint32_t latitude,
                            uint32_t longitude) {
  return angles->cosine_latitude[latitude] * d->across[longitude] + d->up[latitude];
}

/* A vector that is linear in a pixel's column and row. */
struct ray {
  float at[3], step[3], row_step[3], row[3];
};

/* m is 3 by 3, from the camera's coordinates; the third of them is 1 (perspective) or left to the depth. */
static void make_ray(struct ray* ray, const double* m, const struct zbv_job* job, const double* start) {
  const double pixel = 1.0 / (double)job->scale;
  for (int i = 0; i < 3; ++i) {
    ray->step[i] = (float)(m[3 * i] * pixel);
    ray->row_step[i] = (float)(m[3 * i + 1] * pixel);
    ray->row[i] =
        (float)(start[i] - (m[3 * i] * (double)job->centre_x + m[3 * i + 1] * (double)job->centre_y) * pixel);
  }
}

static inline void start_row(struct ray* ray) {
  for (int i = 0; i < 3; ++i) {
    ray->at[i] = ray->row[i];
    ray->row[i] += ray->row_step[i];
  }
}
static inline void next_pixel(struct ray* ray) {
  for (int i = 0; i < 3; ++i) ray->at[i] += ray->step[i];
}

/* From the camera's coordinates to those of the light, column and row (with 1/2 added) included. */
struct to_light {
  struct ray ray; /* parallel: of the point with depth 0; perspective: of depth 1, without `offset` */
  float depth[3], offset[3];
  float epsilon; /* world units */
};

static void make_to_light(struct to_light* to, const struct zbv_job* job, const struct zbv_frame* frame,
                          const struct screen* light) {
  double m[9], offset[3];
  for (int i = 0; i < 3; ++i) {
    const double* row = light->frame + 3 * i;
    const double scale = i < 2 ? light->scale : 1;
    for (int j = 0; j < 3; ++j) {
      const float* axis = frame->frame + 3 * j;
      m[3 * i + j] = scale * (row[0] * axis[0] + row[1] * axis[1] + row[2] * axis[2]);
    }
    offset[i] = scale * (row[0] * (frame->eye[0] - light->eye[0]) + row[1] * (frame->eye[1] - light->eye[1]) +
                         row[2] * (frame->eye[2] - light->eye[2]));
  }
  offset[0] += light->centre_x + 0.5;
  offset[1] += light->centre_y + 0.5;
  const double third[3] = {m[2], m[5], m[8]};
  make_ray(&to->ray, m, job, job->projection == kZbvPerspective ? third : offset);
  for (int i = 0; i < 3; ++i) {
    to->depth[i] = (float)third[i];
    to->offset[i] = (float)offset[i];
  }
  to->epsilon = (float)((double)job->epsilon / light->scale);
}

static inline int in_shadow(const struct to_light* t, const struct target* buffer, float depth,
                            int perspective) {
  float p[3];
  for (int i = 0; i < 3; ++i)
    p[i] = perspective ? t->ray.at[i] * depth + t->offset[i] : t->ray.at[i] + depth * t->depth[i];
  const uint32_t i = (uint32_t)floor_to_int(p[0]), j = (uint32_t)floor_to_int(p[1]);
  if (i >= (uint32_t)buffer->width || j >= (uint32_t)buffer->height) return 0;
  return p[2] - buffer->rows[j][i] > t->epsilon;
}

struct tables {
  struct direction light, viewer; /* the viewer's is for parallel projection */
  struct ray view;                /* perspective: from the eye through a pixel, world */
  struct to_light to_light;
};

static void make_tables(struct tables* t, const struct shading* how, const struct zbv_frame* frame,
                        const struct screen* light) {
  const float* rows = frame->frame;
  const float viewer[3] = {-rows[6], -rows[7], -rows[8]};
  make_direction(&t->light, how->angles, frame->light);
  make_direction(&t->viewer, how->angles, viewer);
  double columns[9], forward[3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) columns[3 * i + j] = rows[3 * j + i];
    forward[i] = rows[6 + i];
  }
  make_ray(&t->view, columns, how->job, forward);
  if (light) make_to_light(&t->to_light, how->job, frame, light);
}

/* Whether the viewer sees the side that the normal points away from. */
static inline int seen_from_below(const struct tables* t, const struct angles* a, uint32_t latitude,
                                  uint32_t longitude, int perspective) {
  if (!perspective) return product(&t->viewer, a, latitude, longitude) < 0;
  const float* ray = t->view.at;
  const float across = a->sine_longitude[longitude] * ray[0] + a->cosine_longitude[longitude] * ray[2];
  return a->cosine_latitude[latitude] * across + a->sine_latitude[latitude] * ray[1] > 0;
}

struct row_of_picture {
  const float* z;
  const uint32_t* attributes;
  size_t at; /* of its first pixel in the picture's planes */
};

static inline __attribute__((always_inline)) void shade_row(const struct shading* how, struct tables* t,
                                                            const struct row_of_picture* row,
                                                            const struct target* buffer, struct picture* to,
                                                            int perspective) {
  const struct zbv_job* job = how->job;
  const uint32_t background = job->background, width = to->width;
  const float ambient = job->ambient, diffuse = job->diffuse;
  uint32_t covered = 0, shadowed = 0;
  for (uint32_t i = 0; i < width; ++i) {
    const size_t at = row->at + i;
    const uint32_t attributes = row->attributes[i], index = attributes & 0xFF;
    const float z = row->z[i];
    to->depth[at] = z;
    if (index == kZbvEmptyColour) {
      to->red[at] = (uint8_t)(background >> 16);
      to->green[at] = (uint8_t)(background >> 8);
      to->blue[at] = (uint8_t)background;
      to->colour[at] = kZbvEmptyColour;
    } else {
      const uint32_t latitude = attributes >> 16, longitude = attributes >> 8 & 0xFF;
      const struct shade_colour* colour = how->colours + index;
      float cosine = product(&t->light, how->angles, latitude, longitude), shade = ambient;
      uint32_t shown = index;
      ++covered;
      if (how->late && colour->is_leaf && seen_from_below(t, how->angles, latitude, longitude, perspective)) {
        shown = colour->below;
        cosine = -cosine;
      }
      if (buffer && in_shadow(&t->to_light, buffer, z, perspective))
        ++shadowed;
      else if (cosine > 0)
        shade += diffuse * cosine;
      const float* channel = how->colours[shown].channel;
      to->red[at] = shaded(channel[0], shade);
      to->green[at] = shaded(channel[1], shade);
      to->blue[at] = shaded(channel[2], shade);
      to->colour[at] = (uint8_t)shown;
    }
    if (perspective) next_pixel(&t->view);
    if (buffer) next_pixel(&t->to_light.ray);
  }
  to->facts.covered += covered;
  to->facts.shadowed += shadowed;
}

void shade(const struct shading* how, const struct zbv_frame* frame, const struct target* seen,
           const struct screen* light, const struct target* buffer, struct picture* to) {
  static struct tables tables;
  make_tables(&tables, how, frame, light);
  to->facts.covered = to->facts.shadowed = 0;
  for (uint32_t j = 0; j < to->height; ++j) {
    const struct row_of_picture row = {seen->rows[j], seen->attributes + j * to->width,
                                       (to->height - 1 - j) * to->width};
    start_row(&tables.view);
    if (buffer) start_row(&tables.to_light.ray);
    if (how->job->projection == kZbvPerspective)
      shade_row(how, &tables, &row, buffer, to, 1);
    else
      shade_row(how, &tables, &row, buffer, to, 0);
  }
}
