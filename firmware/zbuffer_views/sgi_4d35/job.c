#include "firmware/zbuffer_views/sgi_4d35/support.h"

void load_job(const char* path, struct job* job) {
  struct zbv_job* facts = &job->facts;
  const struct input from = open_input(path, kZbvJobMagic, "job", &facts->head);
  if (from.bytes < sizeof *facts) fail(path, "is truncated");
  read_input(&from, (char*)facts + sizeof facts->head, sizeof *facts - sizeof facts->head);
  check_range(path, "trees", facts->trees, 0, kZbvMostTrees);
  check_range(path, "frames", facts->frames, 0, kZbvMostFrames);
  const size_t placements = facts->trees * sizeof *job->trees, frames = facts->frames * sizeof *job->frames;
  if (from.bytes != sizeof *facts + placements + frames)
    fail(path, "has %u bytes where its counts need %u", from.bytes,
         (unsigned)(sizeof *facts + placements + frames));
  job->trees = need(placements + frames + 1, path);
  job->frames = (struct zbv_frame*)(job->trees + facts->trees);
  read_input(&from, job->trees, placements + frames);
  close_input(&from);
}

void check_build(const char* path, const struct zbv_job* job) {
  check_range(path, "bands", job->bands, kZbvLeastBands, kZbvMostBands);
  check_range(path, "layers", job->layers, 1, kZbvMostLayers);
  check_range(path, "view width", job->view_width, kZbvLeastSide, kZbvMostSide);
  check_range(path, "view height", job->view_height, kZbvLeastSide, kZbvMostSide);
  if (job->view_width & 3) fail(path, "view width: is %u, no multiple of 4", job->view_width);
  check_range(path, "rule", job->rule, kZbvInsert, kZbvPeel);
  check_range(path, "leaf side", job->leaf_side, kZbvLate, kZbvEarly);
  check_finite(path, "pitch and threshold", &job->pitch, 2);
  if (job->pitch < 0) fail(path, "pitch: is below 0");
  if (job->threshold < 0) fail(path, "threshold: is below 0");
}

static float product(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static int is_near(float a, float b) { return a - b < 1e-3f && b - a < 1e-3f; }

static void check_frame(const char* path, uint32_t number, const struct zbv_frame* frame) {
  check_near(path, "a frame", frame->eye, 15);
  const float* rows = frame->frame;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      if (!is_near(product(rows + 3 * i, rows + 3 * j), i == j))
        fail(path, "frame %u: its axes are not orthonormal", number);
  if (!is_near(product(frame->light, frame->light), 1))
    fail(path, "frame %u: the light's direction is no unit vector", number);
}

void check_pictures(const char* path, const struct job* job) {
  const struct zbv_job* facts = &job->facts;
  check_range(path, "width", facts->width, 1, kZbvMostSide);
  check_range(path, "height", facts->height, 1, kZbvMostSide);
  check_range(path, "projection", facts->projection, kZbvParallel, kZbvPerspective);
  check_finite(path, "the picture", &facts->scale, 6);
  if (!(facts->scale > 0)) fail(path, "scale: is not above 0");
  if (facts->projection == kZbvPerspective && !(facts->near > 0)) fail(path, "near: is not above 0");
  if (facts->ambient < 0 || facts->diffuse < 0 || facts->ambient + facts->diffuse > 1.0001f)
    fail(path, "ambient, diffuse: are below 0 or together above 1");
  check_range(path, "background", facts->background, 0, 0xFFFFFF);
  check_range(path, "shadows", facts->shadows, 0, 1);
  check_finite(path, "the light", &facts->light_scale, 2);
  if (facts->shadows) {
    check_range(path, "light width", facts->light_width, kZbvLeastSide, kZbvMostLightSide);
    check_range(path, "light height", facts->light_height, kZbvLeastSide, kZbvMostLightSide);
    if (facts->light_scale < 0 || facts->epsilon < 0) fail(path, "light: a value is below 0");
  }
  check_range(path, "options", facts->options, 0, kZbvSkipEmpty | kZbvFullProduct | kZbvReuseLight);
  check_range(path, "trees", facts->trees, 1, kZbvMostTrees);
  check_range(path, "frames", facts->frames, 1, kZbvMostFrames);
  for (uint32_t i = 0; i < facts->trees; ++i) {
    check_near(path, "a tree's place", job->trees[i].at, 3);
    check_range(path, "turn", job->trees[i].turn, 0, kZbvTurns - 1);
  }
  for (uint32_t i = 0; i < facts->frames; ++i) check_frame(path, i, job->frames + i);
}

uint32_t file_bytes(const char* path, size_t head, uint32_t count, size_t piece) {
  const uint64_t bytes = head + (uint64_t)count * piece;
  if (bytes > 0x7FFFFFFF)
    fail(path, "asks for a file of %llu bytes, which end at 2 GB", (unsigned long long)bytes);
  return (uint32_t)bytes;
}

void check_digest(const char* path, const struct zbv_head* head, const struct zbv_job* job) {
  if (memcmp(head->digest, job->head.digest, sizeof head->digest) != 0)
    fail(path, "is of another tree than the job's");
}
