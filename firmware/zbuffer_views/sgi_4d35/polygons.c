/* V9: the same trees by scan conversion of all their triangles, in parallel projection. */
#include "firmware/zbuffer_views/sgi_4d35/scan.h"
#include "firmware/zbuffer_views/sgi_4d35/shade.h"
#include "firmware/zbuffer_views/sgi_4d35/tree.h"

struct work {
  struct job job;
  const char* job_path;
  struct tree tree;
  float (*normals)[3];
  struct corner* corners;
  struct shade_colour* colours;
  float* z;         /* rows from the lowest up */
  uint32_t* pixels; /* colour index << 24 | red << 16 | green << 8 | blue */
  struct picture picture;
};

static void find_normals(struct work* work) {
  const struct tree* tree = &work->tree;
  for (uint32_t i = 0; i < tree->facts.triangles; ++i) {
    double n[3];
    triangle_normal(tree, tree->triangles + i, n);
    const double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), inverse = size > 0 ? 1.0 / size : 0;
    for (int k = 0; k < 3; ++k) work->normals[i][k] = (float)(n[k] * inverse);
  }
}

/* No edge is so long that it could lead from the picture to beyond the guard. */
static void check_edges(const struct work* work) {
  const struct tree* tree = &work->tree;
  const float most = (float)(kGuard / kUnit - kZbvMostSide - 1) / work->job.facts.scale;
  for (uint32_t i = 0; i < tree->facts.triangles; ++i) {
    const uint32_t* corner = tree->triangles[i].corner;
    for (int k = 0; k < 3; ++k) {
      const float *a = tree->vertices[corner[k]], *b = tree->vertices[corner[k == 2 ? 0 : k + 1]];
      const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
      if (x * x + y * y + z * z > most * most)
        fail(work->job_path, "scale: is too large: triangle %u is thousands of pixels long", i);
    }
  }
}

static float within_guard(float value) {
  const float guard = (float)(kGuard + kUnit);
  return value < -guard ? -guard : value > guard ? guard : value;
}

static void project_vertices(struct work* work, const struct zbv_frame* frame,
                             const struct zbv_placement* tree) {
  const struct zbv_job* job = &work->job.facts;
  double rows[3][4];
  for (int i = 0; i < 3; ++i) {
    const double world[3] = {frame->frame[3 * i], frame->frame[3 * i + 1], frame->frame[3 * i + 2]};
    const double scale = i < 2 ? (double)job->scale * kUnit : 1;
    turn_back(tree, world, rows[i]);
    rows[i][3] = 0;
    for (int k = 0; k < 3; ++k) {
      rows[i][k] *= scale;
      rows[i][3] += scale * world[k] * ((double)tree->at[k] - (double)frame->eye[k]);
    }
  }
  rows[0][3] += (double)job->centre_x * kUnit;
  rows[1][3] += (double)job->centre_y * kUnit;
  float m[3][4];
  for (int i = 0; i < 12; ++i) m[i / 4][i % 4] = (float)rows[i / 4][i % 4];
  for (uint32_t i = 0; i < work->tree.facts.vertices; ++i) {
    const float *p = work->tree.vertices[i], a = p[0], b = p[1], c = p[2];
    struct corner* to = work->corners + i;
    to->x = round_to_int(within_guard(m[0][0] * a + m[0][1] * b + m[0][2] * c + m[0][3]));
    to->y = round_to_int(within_guard(m[1][0] * a + m[1][1] * b + m[1][2] * c + m[1][3]));
    to->z = m[2][0] * a + m[2][1] * b + m[2][2] * c + m[2][3];
  }
}

struct drawing {
  struct work* work;
  float light[3], viewer[3]; /* in the tree's axes */
  uint32_t triangle, pixel, has_pixel;
};

static float dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static uint32_t shade_triangle(const struct drawing* d) {
  const struct work* work = d->work;
  const float* normal = work->normals[d->triangle];
  uint32_t index = work->tree.triangles[d->triangle].colour;
  float cosine = dot(normal, d->light), shade = work->job.facts.ambient;
  if (work->colours[index].is_leaf && dot(normal, d->viewer) < 0) {
    index = work->colours[index].below;
    cosine = -cosine;
  }
  if (cosine > 0) shade += work->job.facts.diffuse * cosine;
  const float* channel = work->colours[index].channel;
  return index << 24 | (uint32_t)shaded(channel[0], shade) << 16 | (uint32_t)shaded(channel[1], shade) << 8 |
         shaded(channel[2], shade);
}

static void draw_span(void* to, int32_t row, int32_t left, int32_t right, float z, float step) {
  struct drawing* d = to;
  const struct work* work = d->work;
  const int32_t first = row * (int32_t)work->job.facts.width + left;
  float *at = work->z + first, *const end = at + (right - left);
  uint32_t* pixel = work->pixels + first;
  for (; at != end; ++at, ++pixel, z += step) {
    if (!(z < *at)) continue;
    if (!d->has_pixel) {
      d->pixel = shade_triangle(d);
      d->has_pixel = 1;
    }
    *at = z;
    *pixel = d->pixel;
  }
}

/* A triangle with a corner beyond the guard does not reach the picture (check_edges). */
static int is_within(const struct corner* c) {
  return c->x >= -kGuard && c->x <= kGuard && c->y >= -kGuard && c->y <= kGuard;
}

static void draw_tree(struct work* work, const struct zbv_frame* frame, const struct zbv_placement* tree) {
  struct drawing d;
  double own[3];
  const double light[3] = {frame->light[0], frame->light[1], frame->light[2]};
  const double viewer[3] = {-frame->frame[6], -frame->frame[7], -frame->frame[8]};
  begin_phase(kZbvProject);
  project_vertices(work, frame, tree);
  begin_phase(kZbvScan);
  d.work = work;
  turn_back(tree, light, own);
  for (int k = 0; k < 3; ++k) d.light[k] = (float)own[k];
  turn_back(tree, viewer, own);
  for (int k = 0; k < 3; ++k) d.viewer[k] = (float)own[k];
  const int32_t width = (int32_t)work->job.facts.width, height = (int32_t)work->job.facts.height;
  for (d.triangle = 0; d.triangle < work->tree.facts.triangles; ++d.triangle) {
    const uint32_t* corner = work->tree.triangles[d.triangle].corner;
    const struct corner *a = work->corners + corner[0], *b = work->corners + corner[1],
                        *c = work->corners + corner[2];
    if (!is_within(a) || !is_within(b) || !is_within(c)) continue;
    d.has_pixel = 0;
    scan_triangle(a, b, c, width, height, draw_span, &d);
  }
}

static void clear(struct work* work) {
  const uint32_t background = (uint32_t)kZbvEmptyColour << 24 | work->job.facts.background;
  const size_t pixels = work->job.facts.width * work->job.facts.height;
  for (size_t i = 0; i < pixels; ++i) {
    work->z[i] = kZbvFarDepth;
    work->pixels[i] = background;
  }
}

static void finish_picture(const struct work* work, struct picture* to) {
  to->facts.covered = 0;
  for (uint32_t j = 0; j < to->height; ++j) {
    const uint32_t from = j * to->width, at = (to->height - 1 - j) * to->width;
    for (uint32_t i = 0; i < to->width; ++i) {
      const uint32_t pixel = work->pixels[from + i];
      to->depth[at + i] = work->z[from + i];
      to->red[at + i] = (uint8_t)(pixel >> 16);
      to->green[at + i] = (uint8_t)(pixel >> 8);
      to->blue[at + i] = (uint8_t)pixel;
      to->colour[at + i] = (uint8_t)(pixel >> 24);
      if (pixel >> 24 != kZbvEmptyColour) ++to->facts.covered;
    }
  }
}

static void prepare(struct work* work, char** argv) {
  const struct zbv_job* job = &work->job.facts;
  work->job_path = argv[1];
  load_job(argv[1], &work->job);
  check_pictures(argv[1], &work->job);
  if (job->projection != kZbvParallel) fail(argv[1], "projection: polygons are drawn in parallel projection");
  if (job->shadows) fail(argv[1], "shadows: polygons are drawn without");
  load_tree(argv[2], job, argv[1], &work->tree);
  check_edges(work);
  work->normals = need(work->tree.facts.triangles * sizeof *work->normals, argv[1]);
  work->corners = need(work->tree.facts.vertices * sizeof *work->corners, argv[1]);
  work->z = need(job->width * job->height * sizeof *work->z, argv[1]);
  work->pixels = need(job->width * job->height * sizeof *work->pixels, argv[1]);
  work->colours = shade_colours(work->tree.colours, work->tree.facts.colours, argv[1]);
  make_picture(&work->picture, job, argv[1]);
}

int main(int argc, char** argv) {
  static struct work work;
  struct zbv_pictures head;
  if (argc != 4) fail(argv[0], "takes JOB TREE PICTURES");
  begin_phase(kZbvRead);
  prepare(&work, argv);
  begin_phase(kZbvNormals);
  find_normals(&work);
  make_pictures_head(&work.job.facts, argv[1], &head);
  const struct output to = open_output(argv[3], sizeof head);
  for (uint32_t i = 0; i < work.job.facts.frames; ++i) {
    begin_phase(kZbvClear);
    clear(&work);
    for (uint32_t t = 0; t < work.job.facts.trees; ++t)
      draw_tree(&work, work.job.frames + i, work.job.trees + t);
    begin_phase(kZbvWrite);
    finish_picture(&work, &work.picture);
    write_picture(&work.picture, &to);
  }
  finish_output(&to, &head, sizeof head);
  return 0;
}
