#include "firmware/zbuffer_views/sgi_4d35/views.h"

#include "firmware/zbuffer_views/sgi_4d35/directions.h"

static void check_facts(const char* path, const struct zbv_views* facts) {
  check_range(path, "bands", facts->bands, kZbvLeastBands, kZbvMostBands);
  check_range(path, "layers", facts->layers, 1, kZbvMostLayers);
  check_range(path, "width", facts->width, kZbvLeastSide, kZbvMostSide);
  check_range(path, "height", facts->height, kZbvLeastSide, kZbvMostSide);
  if (facts->width & 3) fail(path, "width: is %u, no multiple of 4", facts->width);
  check_range(path, "rule", facts->rule, kZbvInsert, kZbvPeel);
  check_range(path, "leaf side", facts->leaf_side, kZbvLate, kZbvEarly);
  check_near(path, "pitch, threshold, radius, half height", &facts->pitch, 4);
  if (!(facts->pitch > 0)) fail(path, "pitch: is not above 0");
  if (facts->threshold < 0 || facts->radius < 0 || facts->half_height < 0)
    fail(path, "threshold, radius or half height: is below 0");
  const uint32_t wanted = all_views(facts->bands);
  if (facts->views != wanted)
    fail(path, "has %u views where %u bands have %u", facts->views, facts->bands, wanted);
}

/* The directions' order and number are the programs' own; only that it is theirs is looked at. */
static void check_views(const char* path, const struct views* views) {
  struct zbv_view* wanted = need(views->facts.views * sizeof *wanted, path);
  make_views(views->facts.bands, wanted);
  for (uint32_t i = 0; i < views->facts.views; ++i) {
    const struct zbv_view *a = views->views + i, *b = wanted + i;
    check_finite(path, "a view", &a->theta, 13);
    if (a->circle != b->circle || a->number != b->number || a->circle_views != b->circle_views)
      fail(path, "view %u: is of another direction than it should be", i);
    for (int k = 0; k < 9; ++k)
      if (a->frame[k] - b->frame[k] > 1e-5f || b->frame[k] - a->frame[k] > 1e-5f)
        fail(path, "view %u: is of another direction than it should be", i);
  }
  free(wanted);
}

static uint32_t view_bytes(const struct zbv_views* facts) {
  return facts->layers * facts->width * facts->height * kZbvSampleBytes;
}

static uint32_t planes_at(const struct views* views) {
  const struct zbv_views* facts = &views->facts;
  return sizeof *facts + facts->colours * sizeof *views->colours + facts->views * sizeof *views->views;
}

void open_views(const char* path, const struct zbv_job* job, struct views* views) {
  struct zbv_views* facts = &views->facts;
  views->file = open_input(path, kZbvViewsMagic, "views", &facts->head);
  if (views->file.bytes < sizeof *facts) fail(path, "is truncated");
  read_input(&views->file, (char*)facts + sizeof facts->head, sizeof *facts - sizeof facts->head);
  check_digest(path, &facts->head, job);
  check_facts(path, facts);
  views->colours = load_colours(&views->file, facts->colours);
  const uint64_t bytes = planes_at(views) + (uint64_t)facts->views * view_bytes(facts);
  if (bytes != views->file.bytes)
    fail(path, "has %u bytes where its counts need %llu", views->file.bytes, (unsigned long long)bytes);
  views->views = need(facts->views * sizeof *views->views, path);
  read_input(&views->file, views->views, facts->views * sizeof *views->views);
  check_views(path, views);
  views->planes = need(facts->views * sizeof *views->planes, path);
  views->last_use = need(facts->views * sizeof *views->last_use, path);
  memset(views->planes, 0, facts->views * sizeof *views->planes);
  memset(views->last_use, 0, facts->views * sizeof *views->last_use);
  views->uses = 0;
}

static void add_view(struct chosen* chosen, uint32_t view) {
  for (uint32_t i = 0; i < chosen->count; ++i)
    if (chosen->view[i] == view) return;
  uint32_t at = chosen->count++;
  for (; at > 0 && chosen->view[at - 1] > view; --at) chosen->view[at] = chosen->view[at - 1];
  chosen->view[at] = view;
}

struct chosen choose_views(const struct zbv_views* facts, const double direction[3]) {
  const double kPi = 3.1415926535897931;
  struct chosen chosen = {0, {0}};
  const double across = sqrt(direction[0] * direction[0] + direction[2] * direction[2]);
  const double theta = atan2(across, direction[1]);
  double phi = across > 0 ? atan2(direction[0], direction[2]) : 0;
  if (phi < 0) phi += 2 * kPi;
  uint32_t band = (uint32_t)(int)(theta * facts->bands / kPi);
  if (band >= facts->bands) band = facts->bands - 1;
  uint32_t first = 0;
  for (uint32_t k = 0; k < band; ++k) first += circle_views(facts->bands, k);
  for (uint32_t k = band; k <= band + 1; ++k) {
    const uint32_t count = circle_views(facts->bands, k),
                   j = (uint32_t)(int)(phi * count / (2 * kPi)) % count;
    add_view(&chosen, first + j);
    add_view(&chosen, first + (j + 1) % count);
    first += count;
  }
  return chosen;
}

static uint8_t* room_for_view(struct views* views) {
  uint8_t* room = malloc(view_bytes(&views->facts));
  if (room) return room;
  uint32_t oldest = views->facts.views;
  for (uint32_t v = 0; v < views->facts.views; ++v)
    if (views->planes[v] && (oldest == views->facts.views || views->last_use[v] < views->last_use[oldest]))
      oldest = v;
  if (oldest == views->facts.views) fail(views->file.path, "memory does not hold one view");
  room = views->planes[oldest];
  views->planes[oldest] = NULL;
  return room;
}

const uint8_t* view_planes(struct views* views, uint32_t view) {
  const uint32_t bytes = view_bytes(&views->facts);
  if (!views->planes[view]) {
    begin_phase(kZbvRead);
    uint8_t* room = room_for_view(views);
    seek_input(&views->file, planes_at(views) + view * bytes);
    read_input(&views->file, room, bytes);
    views->planes[view] = room;
  }
  views->last_use[view] = ++views->uses;
  return views->planes[view];
}
