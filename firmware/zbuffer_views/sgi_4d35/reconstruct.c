/* V5 to V8: pictures from stored views. */
#include "firmware/zbuffer_views/sgi_4d35/shade.h"

struct work {
  struct job job;
  const char* job_path;
  struct views views;
  struct target seen, light;
  struct picture picture;
  struct angles angles;
  struct shading shading;
  struct screen sun;
  const struct zbv_frame* lit_by; /* the frame whose light the light buffer has */
};

static struct screen camera_screen(const struct zbv_job* job, const struct zbv_frame* frame) {
  struct screen screen;
  for (int i = 0; i < 9; ++i) screen.frame[i] = frame->frame[i];
  for (int i = 0; i < 3; ++i) screen.eye[i] = frame->eye[i];
  screen.scale = job->scale;
  screen.centre_x = job->centre_x;
  screen.centre_y = job->centre_y;
  return screen;
}

/* V2's frame for a direction, at the poles with longitude 0. */
static void frame_of(const float* direction, double frame[9]) {
  const double x = direction[0], y = direction[1], z = direction[2], h = sqrt(x * x + z * z);
  const double size = sqrt(h * h + y * y), st = h / size, ct = y / size;
  const double sp = h > 0 ? x / h : 0, cp = h > 0 ? z / h : 1;
  const double rows[9] = {cp, 0, -sp, -ct * sp, st, -ct * cp, -st * sp, -ct, -st * cp};
  for (int i = 0; i < 9; ++i) frame[i] = rows[i];
}

/* The light's picture holds the cylinders of all trees, with the margin of the stored views. ASSUMED DEV-152.
 */
static struct screen light_screen(const struct work* work, const struct zbv_frame* frame) {
  const struct zbv_job* job = &work->job.facts;
  const double radius = work->views.facts.radius, half_height = work->views.facts.half_height;
  struct screen screen;
  double low[2], high[2];
  frame_of(frame->light, screen.frame);
  for (int i = 0; i < 3; ++i) screen.eye[i] = work->job.trees[0].at[i];
  for (uint32_t t = 0; t < job->trees; ++t)
    for (int axis = 0; axis < 2; ++axis) {
      const double *row = screen.frame + 3 * axis, level = row[1] < 0 ? -row[1] : row[1];
      const float* at = work->job.trees[t].at;
      const double middle = row[0] * (at[0] - screen.eye[0]) + row[1] * (at[1] - screen.eye[1]) +
                            row[2] * (at[2] - screen.eye[2]);
      const double reach = radius * sqrt(row[0] * row[0] + row[2] * row[2]) + half_height * level;
      if (t == 0 || middle - reach < low[axis]) low[axis] = middle - reach;
      if (t == 0 || middle + reach > high[axis]) high[axis] = middle + reach;
    }
  const double across = job->light_width / (1.02 * (high[0] - low[0])),
               upright = job->light_height / (1.02 * (high[1] - low[1]));
  screen.scale = job->light_scale > 0 ? (double)job->light_scale : across < upright ? across : upright;
  screen.centre_x = 0.5 * (double)(int32_t)(job->light_width - 1) - screen.scale * 0.5 * (low[0] + high[0]);
  screen.centre_y = 0.5 * (double)(int32_t)(job->light_height - 1) - screen.scale * 0.5 * (low[1] + high[1]);
  return screen;
}

/* The views around `direction`, a world vector from the tree to the viewer; returns how many. */
static uint32_t reproject_tree(struct work* work, const struct zbv_placement* tree, const double direction[3],
                               const struct screen* screen, enum zbv_phase phase, const struct target* to) {
  const struct zbv_job* job = &work->job.facts;
  const struct zbv_views* facts = &work->views.facts;
  double own[3];
  begin_phase(kZbvChoose);
  turn_back(tree, direction, own);
  const struct chosen chosen = choose_views(facts, own);
  for (uint32_t i = 0; i < chosen.count; ++i) {
    const struct zbv_view* view = work->views.views + chosen.view[i];
    const uint8_t* planes = view_planes(&work->views, chosen.view[i]);
    struct warp warp;
    begin_phase(phase);
    warp.perspective = phase == kZbvCamera && job->projection == kZbvPerspective;
    warp.full_product = (job->options & kZbvFullProduct) != 0;
    warp.skip_empty = (job->options & kZbvSkipEmpty) != 0;
    warp.near = job->near;
    warp.turn = tree->turn;
    make_warp(screen, tree, view, &warp);
    reproject(facts, view, planes, &warp, to);
  }
  return chosen.count;
}

static void check_eye(const struct work* work, const struct zbv_frame* frame) {
  if (work->job.facts.projection != kZbvPerspective) return;
  for (uint32_t t = 0; t < work->job.facts.trees; ++t) {
    const float* at = work->job.trees[t].at;
    const float x = frame->eye[0] - at[0], y = frame->eye[1] - at[1], z = frame->eye[2] - at[2];
    const float radius = work->views.facts.radius, half = work->views.facts.half_height;
    if (x * x + z * z <= radius * radius && y <= half && y >= -half)
      fail(work->job_path, "frame %d: the camera is inside of tree %u", (int)(frame - work->job.frames), t);
  }
}

static void draw_light(struct work* work, const struct zbv_frame* frame) {
  const struct zbv_job* job = &work->job.facts;
  const double direction[3] = {frame->light[0], frame->light[1], frame->light[2]};
  work->picture.facts.light_views = 0;
  if ((job->options & kZbvReuseLight) && work->lit_by &&
      memcmp(work->lit_by->light, frame->light, sizeof frame->light) == 0)
    return;
  work->lit_by = frame;
  work->sun = light_screen(work, frame);
  begin_phase(kZbvClear);
  clear_target(&work->light);
  for (uint32_t t = 0; t < job->trees; ++t)
    work->picture.facts.light_views +=
        reproject_tree(work, work->job.trees + t, direction, &work->sun, kZbvLight, &work->light);
}

static void draw_camera(struct work* work, const struct zbv_frame* frame) {
  const struct zbv_job* job = &work->job.facts;
  const struct screen screen = camera_screen(job, frame);
  work->picture.facts.camera_views = 0;
  begin_phase(kZbvClear);
  clear_target(&work->seen);
  for (uint32_t t = 0; t < job->trees; ++t) {
    double direction[3];
    for (int i = 0; i < 3; ++i)
      direction[i] = job->projection == kZbvPerspective
                         ? (double)frame->eye[i] - (double)work->job.trees[t].at[i]
                         : -(double)frame->frame[6 + i];
    work->picture.facts.camera_views +=
        reproject_tree(work, work->job.trees + t, direction, &screen, kZbvCamera, &work->seen);
  }
}

static void prepare(struct work* work, char** argv) {
  const struct zbv_job* job = &work->job.facts;
  work->job_path = argv[1];
  load_job(argv[1], &work->job);
  check_pictures(argv[1], &work->job);
  open_views(argv[2], job, &work->views);
  for (uint32_t i = 0; i < job->frames; ++i) check_eye(work, work->job.frames + i);
  make_target(&work->seen, job->width, job->height, 1, argv[1]);
  if (job->shadows) make_target(&work->light, job->light_width, job->light_height, 0, argv[1]);
  make_picture(&work->picture, job, argv[1]);
  make_angles(&work->angles);
  work->shading.job = job;
  work->shading.angles = &work->angles;
  work->shading.colours = shade_colours(work->views.colours, work->views.facts.colours, argv[1]);
  work->shading.late = work->views.facts.leaf_side == kZbvLate;
}

int main(int argc, char** argv) {
  static struct work work;
  struct zbv_pictures head;
  if (argc != 4) fail(argv[0], "takes JOB VIEWS PICTURES");
  begin_phase(kZbvRead);
  prepare(&work, argv);
  const struct zbv_job* job = &work.job.facts;
  make_pictures_head(job, argv[1], &head);
  const struct output to = open_output(argv[3], sizeof head);
  for (uint32_t i = 0; i < job->frames; ++i) {
    const struct zbv_frame* frame = work.job.frames + i;
    draw_camera(&work, frame);
    if (job->shadows) draw_light(&work, frame);
    begin_phase(kZbvShade);
    work.picture.facts.light_scale = job->shadows ? (float)work.sun.scale : 0;
    shade(&work.shading, frame, &work.seen, job->shadows ? &work.sun : NULL,
          job->shadows ? &work.light : NULL, &work.picture);
    begin_phase(kZbvWrite);
    write_picture(&work.picture, &to);
  }
  finish_output(&to, &head, sizeof head);
  return 0;
}
