#include "firmware/zbuffer_views/sgi_4d35/shade.h"

void make_picture(struct picture* to, const struct zbv_job* job, const char* job_path) {
  const size_t pixels = job->width * job->height;
  to->width = job->width;
  to->height = job->height;
  to->depth = need(pixels * sizeof *to->depth, job_path);
  to->red = need(4 * pixels, job_path);
  to->green = to->red + pixels;
  to->blue = to->green + pixels;
  to->colour = to->blue + pixels;
}

void write_picture(const struct picture* from, const struct output* to) {
  const size_t pixels = from->width * from->height;
  write_output(to, &from->facts, sizeof from->facts);
  write_output(to, from->depth, pixels * sizeof *from->depth);
  write_output(to, from->red, 4 * pixels);
}

void make_pictures_head(const struct zbv_job* job, const char* job_path, struct zbv_pictures* head) {
  head->head = job->head;
  head->head.magic = kZbvPicturesMagic;
  head->head.bytes = file_bytes(job_path, sizeof *head, job->frames,
                                sizeof(struct zbv_picture) + 8 * job->width * job->height);
  head->width = job->width;
  head->height = job->height;
  head->frames = job->frames;
}

struct shade_colour* shade_colours(const struct zbv_colour* colours, uint32_t count, const char* job_path) {
  struct shade_colour* table = need(count * sizeof *table, job_path);
  for (uint32_t i = 0; i < count; ++i) {
    const struct zbv_colour* c = colours + i;
    for (int k = 0; k < 3; ++k) table[i].channel[k] = (float)(int32_t)(c->rgb >> (16 - 8 * k) & 0xFF);
    table[i].below = c->below;
    table[i].is_leaf = c->part == kZbvLeaf;
  }
  return table;
}
