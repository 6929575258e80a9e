#include "firmware/zbuffer_views/sgi_4d35/tree.h"

static void check_size(const char* path, const struct zbv_tree* facts, uint32_t bytes) {
  if (facts->triangles == 0) fail(path, "has no triangles");
  if (facts->vertices == 0) fail(path, "has no vertices");
  const uint32_t most = bytes / sizeof(float[3]);
  if (facts->vertices > most || facts->triangles > most ||
      bytes != sizeof *facts + facts->colours * sizeof(struct zbv_colour) +
                   facts->vertices * sizeof(float[3]) + facts->triangles * sizeof(struct zbv_triangle))
    fail(path, "has %u bytes, which do not fit to its counts", bytes);
}

static void move_to_centre(struct tree* tree) {
  const float* centre = tree->facts.centre;
  float radius = 0, half_height = 0;
  for (uint32_t i = 0; i < tree->facts.vertices; ++i) {
    float* v = tree->vertices[i];
    for (int axis = 0; axis < 3; ++axis) v[axis] -= centre[axis];
    const float r = v[0] * v[0] + v[2] * v[2], y = v[1] < 0 ? -v[1] : v[1];
    if (r > radius) radius = r;
    if (y > half_height) half_height = y;
  }
  tree->radius = sqrtf(radius);
  tree->half_height = half_height;
}

void load_tree(const char* path, const struct zbv_job* job, const char* job_path, struct tree* tree) {
  struct zbv_tree* facts = &tree->facts;
  const struct input from = open_input(path, kZbvTreeMagic, "tree", &facts->head);
  if (from.bytes < sizeof *facts) fail(path, "is truncated");
  read_input(&from, (char*)facts + sizeof facts->head, sizeof *facts - sizeof facts->head);
  check_digest(path, &facts->head, job);
  check_near(path, "centre", facts->centre, 3);
  tree->colours = load_colours(&from, facts->colours);
  check_size(path, facts, from.bytes);
  tree->vertices = need(facts->vertices * sizeof *tree->vertices, job_path);
  tree->triangles = need(facts->triangles * sizeof *tree->triangles, job_path);
  read_input(&from, tree->vertices, facts->vertices * sizeof *tree->vertices);
  read_input(&from, tree->triangles, facts->triangles * sizeof *tree->triangles);
  close_input(&from);
  check_near(path, "vertices", tree->vertices[0], 3 * facts->vertices);
  for (uint32_t i = 0; i < facts->triangles; ++i) {
    const struct zbv_triangle* t = tree->triangles + i;
    if (t->corner[0] >= facts->vertices || t->corner[1] >= facts->vertices ||
        t->corner[2] >= facts->vertices || t->colour >= facts->colours)
      fail(path, "triangle %u: names a vertex or colour that is none", i);
  }
  move_to_centre(tree);
}

void triangle_normal(const struct tree* tree, const struct zbv_triangle* triangle, double normal[3]) {
  const float *a = tree->vertices[triangle->corner[0]], *b = tree->vertices[triangle->corner[1]],
              *c = tree->vertices[triangle->corner[2]];
  const double ux = (double)b[0] - a[0], uy = (double)b[1] - a[1], uz = (double)b[2] - a[2];
  const double vx = (double)c[0] - a[0], vy = (double)c[1] - a[1], vz = (double)c[2] - a[2];
  normal[0] = uy * vz - uz * vy;
  normal[1] = uz * vx - ux * vz;
  normal[2] = ux * vy - uy * vx;
}
