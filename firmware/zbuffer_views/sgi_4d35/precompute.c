/* V1 to V4: the views of a tree. */
#include "firmware/zbuffer_views/sgi_4d35/directions.h"
#include "firmware/zbuffer_views/sgi_4d35/layers.h"
#include "firmware/zbuffer_views/sgi_4d35/tree.h"

static void print_directions(const char* text) {
  uint32_t bands = 0;
  for (const char* c = text; *c >= '0' && *c <= '9' && bands < 1000; ++c)
    bands = bands * 10 + (uint32_t)(*c - '0');
  check_range("--directions", "bands", bands, kZbvLeastBands, kZbvMostBands);
  printf("%u bands, %u views:", bands, all_views(bands));
  for (uint32_t k = 0; k <= bands; ++k) printf(" %u", circle_views(bands, k));
  printf("\n");
}

static uint32_t byte_of(double value) { return (uint32_t)(int)floor(value + 0.5) & 0xFF; }

/* Latitude and longitude in bytes; a normal of length 0 gets any. */
static uint32_t normal_bytes(const double n[3]) {
  const double kPi = 3.1415926535897931;
  const double latitude = atan2(n[1], sqrt(n[0] * n[0] + n[2] * n[2])), longitude = atan2(n[0], n[2]);
  return byte_of((latitude + kPi / 2) / kPi * 255) << 16 | byte_of(longitude / (2 * kPi) * 256) << 8;
}

static void describe_triangles(const struct tree* tree, uint32_t* attributes) {
  for (uint32_t i = 0; i < tree->facts.triangles; ++i) {
    double normal[3];
    triangle_normal(tree, tree->triangles + i, normal);
    attributes[i] = normal_bytes(normal) | tree->triangles[i].colour;
  }
}

/* What *early* makes of a leaf whose lower side the view sees: the colour below, and the normal turned over.
 */
static uint32_t seen_from_below(uint32_t attributes, const struct tree* tree) {
  const uint32_t below = tree->colours[attributes & 0xFF].below;
  return (255 - (attributes >> 16)) << 16 | (((attributes >> 8) + 128) & 0xFF) << 8 | below;
}

static void choose_sides(const struct tree* tree, const struct zbv_view* view, const uint32_t* from,
                         uint32_t* to) {
  const float* forward = view->frame + 6;
  for (uint32_t i = 0; i < tree->facts.triangles; ++i) {
    to[i] = from[i];
    if (tree->colours[from[i] & 0xFF].part != kZbvLeaf) continue;
    double n[3];
    triangle_normal(tree, tree->triangles + i, n);
    if (n[0] * forward[0] + n[1] * forward[1] + n[2] * forward[2] > 0) to[i] = seen_from_below(from[i], tree);
  }
}

/* V3: one pitch for all views. */
static float find_pitch(const struct tree* tree, const struct zbv_view* views, uint32_t count,
                        const struct zbv_job* job) {
  float height = 0;
  for (uint32_t v = 0; v < count; ++v) {
    const float ux = views[v].frame[3], uy = views[v].frame[4], uz = views[v].frame[5];
    for (uint32_t i = 0; i < tree->facts.vertices; ++i) {
      const float* p = tree->vertices[i];
      const float y = ux * p[0] + uy * p[1] + uz * p[2], size = y < 0 ? -y : y;
      if (size > height) height = size;
    }
  }
  const float across = 2.04f * tree->radius / (float)job->view_width,
              upright = 2.04f * height / (float)job->view_height;
  return across > upright ? across : upright;
}

static void project_vertices(const struct tree* tree, const struct zbv_view* view, float pitch,
                             struct corner* corners) {
  const float unit = (float)kUnit / pitch, *frame = view->frame;
  const float xx = frame[0] * unit, xz = frame[2] * unit, x0 = view->x0 * unit;
  const float yx = frame[3] * unit, yy = frame[4] * unit, yz = frame[5] * unit, y0 = view->y0 * unit;
  const float zx = frame[6], zy = frame[7], zz = frame[8];
  for (uint32_t i = 0; i < tree->facts.vertices; ++i) {
    const float *p = tree->vertices[i], a = p[0], b = p[1], c = p[2];
    const float x = xx * a + xz * c - x0, y = yx * a + yy * b + yz * c - y0;
    corners[i].z = zx * a + zy * b + zz * c;
    corners[i].x = round_to_int(x);
    corners[i].y = round_to_int(y);
  }
}

struct work {
  const struct zbv_job* job;
  struct tree tree;
  uint32_t* attributes; /* of each triangle; with *early* another set follows, of the present view */
  struct corner* corners;
  struct layers layers;
  void* planes;
};

static void draw_view(struct work* work, const struct zbv_view* view, float pitch) {
  const struct tree* tree = &work->tree;
  const uint32_t triangles = tree->facts.triangles, *attributes = work->attributes;
  begin_phase(kZbvProject);
  project_vertices(tree, view, pitch, work->corners);
  if (work->job->leaf_side == kZbvEarly) {
    choose_sides(tree, view, attributes, work->attributes + triangles);
    attributes += triangles;
  }
  begin_phase(kZbvClear);
  clear_layers(&work->layers);
  begin_phase(kZbvScan);
  if (work->job->rule == kZbvPeel)
    peel_triangles(&work->layers, work->corners, tree->triangles, attributes, triangles);
  else
    insert_triangles(&work->layers, work->corners, tree->triangles, attributes, triangles);
}

static void make_facts(const struct work* work, uint32_t views, float pitch, const char* job_path,
                       struct zbv_views* facts) {
  const struct zbv_job* job = work->job;
  const struct zbv_tree* tree = &work->tree.facts;
  memset(facts, 0, sizeof *facts);
  facts->head = tree->head;
  facts->head.magic = kZbvViewsMagic;
  facts->bands = job->bands;
  facts->views = views;
  facts->layers = job->layers;
  facts->width = job->view_width;
  facts->height = job->view_height;
  facts->colours = tree->colours;
  facts->rule = job->rule;
  facts->leaf_side = job->leaf_side;
  facts->pitch = pitch;
  facts->threshold = job->threshold;
  facts->radius = work->tree.radius;
  facts->half_height = work->tree.half_height;
  const size_t head = sizeof *facts + tree->colours * sizeof(struct zbv_colour);
  const size_t planes = job->layers * job->view_width * job->view_height * kZbvSampleBytes;
  facts->head.bytes = file_bytes(job_path, head, views, sizeof(struct zbv_view) + planes);
}

static void make_room(struct work* work, const char* job_path) {
  const uint32_t triangles = work->tree.facts.triangles;
  const uint32_t sets = work->job->leaf_side == kZbvEarly ? 2 : 1;
  work->attributes = need(sets * triangles * sizeof *work->attributes, job_path);
  work->corners = need(work->tree.facts.vertices * sizeof *work->corners, job_path);
  make_layers(&work->layers, work->job, job_path);
  work->planes = need(work->job->view_width * work->job->view_height * kZbvSampleBytes, job_path);
}

int main(int argc, char** argv) {
  static struct work work;
  static struct job job;
  struct zbv_views facts;
  if (argc == 3 && strcmp(argv[1], "--directions") == 0) return print_directions(argv[2]), 0;
  if (argc != 4) fail(argv[0], "takes JOB TREE VIEWS, or --directions and a number of bands");
  begin_phase(kZbvRead);
  load_job(argv[1], &job);
  check_build(argv[1], &job.facts);
  work.job = &job.facts;
  load_tree(argv[2], &job.facts, argv[1], &work.tree);

  begin_phase(kZbvDirections);
  const uint32_t count = all_views(job.facts.bands);
  struct zbv_view* views = need(count * sizeof *views, argv[1]);
  make_views(job.facts.bands, views);
  const float pitch =
      job.facts.pitch > 0 ? job.facts.pitch : find_pitch(&work.tree, views, count, &job.facts);
  if (!(pitch > 0)) fail(argv[2], "has no extent");
  /* A corner is at most this far from a window's middle, and so within the guard. */
  if ((work.tree.radius + work.tree.half_height) / pitch > (float)(kGuard / kUnit - kZbvMostSide))
    fail(argv[1], "pitch: is too small: the tree is thousands of samples wide");
  for (uint32_t v = 0; v < count; ++v) {
    views[v].x0 = -0.5f * (float)(job.facts.view_width - 1) * pitch;
    views[v].y0 = -0.5f * (float)(job.facts.view_height - 1) * pitch;
  }
  make_room(&work, argv[1]);
  begin_phase(kZbvNormals);
  describe_triangles(&work.tree, work.attributes);
  make_facts(&work, count, pitch, argv[1], &facts);

  const struct output to = open_output(argv[3], sizeof facts);
  write_output(&to, work.tree.colours, facts.colours * sizeof *work.tree.colours);
  write_output(&to, views, count * sizeof *views);
  for (uint32_t v = 0; v < count; ++v) {
    draw_view(&work, views + v, pitch);
    begin_phase(kZbvWrite);
    write_layers(&work.layers, work.planes, &to);
  }
  finish_output(&to, &facts, sizeof facts);
  return 0;
}
