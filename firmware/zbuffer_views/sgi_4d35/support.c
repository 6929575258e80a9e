#include "firmware/zbuffer_views/sgi_4d35/support.h"

enum { kReadOnly = 0, kWriteOnly = 1, kCreate = 0x100, kTruncate = 0x200, kSeekSet = 0, kSeekEnd = 2 };

void fail(const char* file, const char* format, ...) {
  char text[400];
  const int used = snprintf(text, 200, "%s: ", file);
  const size_t at = used < 200 ? (size_t)used : 199;
  va_list list;
  va_start(list, format);
  vsnprintf(text + at, sizeof text - at - 1, format, list);
  va_end(list);
  const size_t length = strlen(text);
  text[length] = '\n';
  dendro_call(kSysWrite, 2, (long)text, (long)length + 1);
  exit(2);
}

void* need(size_t bytes, const char* file) {
  void* block = malloc(bytes);
  if (!block) fail(file, "needs %u more bytes of memory than there are", (unsigned)bytes);
  return block;
}

struct input open_input(const char* path, uint32_t magic, const char* what, struct zbv_head* head) {
  struct input from = {path, dendro_call(kSysOpen, (long)path, kReadOnly, 0), 0};
  if (from.file < 0) fail(path, "cannot be opened (error %ld)", -from.file);
  const long size = dendro_call(kSysLseek, from.file, 0, kSeekEnd);
  if (size < (long)sizeof *head) fail(path, "is no %s file", what);
  from.bytes = (uint32_t)size;
  seek_input(&from, 0);
  read_input(&from, head, sizeof *head);
  if (head->magic != magic) fail(path, "is no %s file, or was not finished", what);
  if (head->version != kZbvVersion)
    fail(path, "has version %u, this program reads version %d", head->version, kZbvVersion);
  if (head->bytes > from.bytes) fail(path, "is truncated: %u of %u bytes", from.bytes, head->bytes);
  if (head->bytes < from.bytes) fail(path, "has %u bytes where its head says %u", from.bytes, head->bytes);
  return from;
}

void read_input(const struct input* from, void* to, size_t bytes) {
  char* at = to;
  while (bytes > 0) {
    const long got = dendro_call(kSysRead, from->file, (long)at, (long)bytes);
    if (got < 0) fail(from->path, "cannot be read (error %ld)", -got);
    if (got == 0) fail(from->path, "is truncated");
    at += got;
    bytes -= (size_t)got;
  }
}

void seek_input(const struct input* from, uint32_t position) {
  if (dendro_call(kSysLseek, from->file, (long)position, kSeekSet) < 0)
    fail(from->path, "cannot be read from byte %u on", position);
}

void close_input(const struct input* from) { dendro_call(kSysClose, from->file, 0, 0); }

struct output open_output(const char* path, size_t head_bytes) {
  static const char kZero[256];
  struct output to = {path, dendro_call(kSysOpen, (long)path, kWriteOnly | kCreate | kTruncate, 0666)};
  if (to.file < 0) fail(path, "cannot be written (error %ld)", -to.file);
  write_output(&to, kZero, head_bytes);
  return to;
}

void write_output(const struct output* to, const void* from, size_t bytes) {
  const char* at = from;
  while (bytes > 0) {
    const long done = dendro_call(kSysWrite, to->file, (long)at, (long)bytes);
    if (done <= 0) fail(to->path, "cannot be written (error %ld)", -done);
    at += done;
    bytes -= (size_t)done;
  }
}

void finish_output(const struct output* to, const void* head, size_t head_bytes) {
  if (dendro_call(kSysLseek, to->file, 0, kSeekSet) < 0) fail(to->path, "is no file with positions");
  write_output(to, head, head_bytes);
  if (dendro_call(kSysClose, to->file, 0, 0) < 0) fail(to->path, "cannot be written");
}

void check_range(const char* file, const char* key, uint32_t value, uint32_t low, uint32_t high) {
  if (value < low || value > high) fail(file, "%s: is %u, allowed are %u to %u", key, value, low, high);
}

void check_finite(const char* file, const char* what, const float* values, size_t count) {
  typedef uint32_t word_alias __attribute__((may_alias));
  const word_alias* words = (const word_alias*)values;
  for (size_t i = 0; i < count; ++i)
    if ((words[i] & 0x7F800000) == 0x7F800000) fail(file, "%s: holds a value that is not finite", what);
}

void check_near(const char* file, const char* what, const float* values, size_t count) {
  check_finite(file, what, values, count);
  for (size_t i = 0; i < count; ++i)
    if (values[i] >= kZbvMostDistance || values[i] <= -kZbvMostDistance)
      fail(file, "%s: lies %d units or more from the origin", what, kZbvMostDistance);
}

struct zbv_colour* load_colours(const struct input* from, uint32_t colours) {
  check_range(from->path, "colours", colours, 1, kZbvMostColours);
  struct zbv_colour* table = need(colours * sizeof *table, from->path);
  read_input(from, table, colours * sizeof *table);
  for (uint32_t i = 0; i < colours; ++i) {
    if (table[i].part > kZbvLeaf || table[i].below >= colours || table[i].rgb > 0xFFFFFF)
      fail(from->path, "colour %u: is none", i);
  }
  return table;
}

double turn_sine(long a, long b) {
  const double kHalfPi = 1.5707963267948966;
  a %= b;
  if (a < 0) a += b;
  const long quarter = 4 * a / b, rest = 4 * a - quarter * b;
  double value;
  if (quarter & 1)
    value = 2 * rest > b ? sin(kHalfPi * (double)(b - rest) / (double)b)
                         : cos(kHalfPi * (double)rest / (double)b);
  else
    value = 2 * rest > b ? cos(kHalfPi * (double)(b - rest) / (double)b)
                         : sin(kHalfPi * (double)rest / (double)b);
  return quarter & 2 ? -value : value;
}

void turn_back(const struct zbv_placement* tree, const double world[3], double own[3]) {
  const double c = turn_cosine((long)tree->turn, kZbvTurns), s = turn_sine((long)tree->turn, kZbvTurns);
  own[0] = world[0] * c - world[2] * s;
  own[1] = world[1];
  own[2] = world[0] * s + world[2] * c;
}
