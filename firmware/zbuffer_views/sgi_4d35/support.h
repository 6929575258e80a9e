#pragma once

/* What all three programs need: complaints, files, jobs. */

#include "firmware/lib/mips/dendro.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"

/* One line "FILE: text" on standard error, exit code 2. */
void fail(const char* file, const char* format, ...) __attribute__((noreturn, format(printf, 2, 3)));

static inline void begin_phase(enum zbv_phase phase) { dendro_mark(kMarkLabel, phase); }

/* Memory, or a complaint that names `file`. */
void* need(size_t bytes, const char* file);

struct input {
  const char* path;
  long file;
  uint32_t bytes;
};

/* Opens a file and checks its head: kind (`what` is its name in complaints), version, length. The position is
 * behind the head. */
struct input open_input(const char* path, uint32_t magic, const char* what, struct zbv_head* head);
/* All bytes or a complaint. */
void read_input(const struct input* from, void* to, size_t bytes);
void seek_input(const struct input* from, uint32_t position);
void close_input(const struct input* from);

struct output {
  const char* path;
  long file;
};

/* A new file, `head_bytes` of which stay zero until finish_output. */
struct output open_output(const char* path, size_t head_bytes);
void write_output(const struct output* to, const void* from, size_t bytes);
void finish_output(const struct output* to, const void* head, size_t head_bytes);

/* `value` of `key` lies in low..high, or a complaint. */
void check_range(const char* file, const char* key, uint32_t value, uint32_t low, uint32_t high);
/* Every word is a finite single. */
void check_finite(const char* file, const char* what, const float* values, size_t count);
/* Every |value| is below kZbvMostDistance, so that all depths are below kZbvFarDepth. */
void check_near(const char* file, const char* what, const float* values, size_t count);

struct job {
  struct zbv_job facts;
  struct zbv_placement* trees;
  struct zbv_frame* frames;
};

/* Reads a job; the first checks what precompute needs, the second what pictures need. */
void load_job(const char* path, struct job* job);
void check_build(const char* path, const struct zbv_job* job);
void check_pictures(const char* path, const struct job* job);
/* A file's length from that of its head and those of `count` pieces; files end at 2 GB. */
uint32_t file_bytes(const char* path, size_t head, uint32_t count, size_t piece);
void check_digest(const char* path, const struct zbv_head* head, const struct zbv_job* job);

/* The colour table of a tree or of its views. */
struct zbv_colour* load_colours(const struct input* from, uint32_t colours);

/* Sine and cosine of a share a/b of a full turn, b > 0: exact at quarters, and with their symmetry. */
double turn_sine(long a, long b);
static inline double turn_cosine(long a, long b) { return turn_sine(4 * a + b, 4 * b); }

/* A direction of the world in the axes of a tree. */
void turn_back(const struct zbv_placement* tree, const double world[3], double own[3]);
