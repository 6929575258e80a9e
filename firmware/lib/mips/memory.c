#include "firmware/lib/mips/dendro.h"

typedef uint32_t word_alias __attribute__((may_alias));

void* memcpy(void* to, const void* from, size_t bytes) {
  unsigned char* d = to;
  const unsigned char* s = from;
  if ((((uintptr_t)d | (uintptr_t)s) & 3) == 0)
    for (; bytes >= 4; bytes -= 4, d += 4, s += 4) *(word_alias*)d = *(const word_alias*)s;
  while (bytes--) *d++ = *s++;
  return to;
}

void* memmove(void* to, const void* from, size_t bytes) {
  unsigned char* d = to;
  const unsigned char* s = from;
  if ((uintptr_t)d - (uintptr_t)s >= bytes) return memcpy(to, from, bytes);
  while (bytes--) d[bytes] = s[bytes];
  return to;
}

void* memset(void* to, int byte, size_t bytes) {
  unsigned char* d = to;
  const uint32_t word = (unsigned char)byte * 0x01010101u;
  for (; bytes && ((uintptr_t)d & 3); --bytes) *d++ = (unsigned char)byte;
  for (; bytes >= 4; bytes -= 4, d += 4) *(word_alias*)d = word;
  while (bytes--) *d++ = (unsigned char)byte;
  return to;
}

int memcmp(const void* a, const void* b, size_t bytes) {
  const unsigned char *x = a, *y = b;
  for (; bytes; --bytes, ++x, ++y)
    if (*x != *y) return *x - *y;
  return 0;
}

size_t strlen(const char* text) {
  const char* end = text;
  while (*end) ++end;
  return (size_t)(end - text);
}

int strcmp(const char* a, const char* b) {
  while (*a && *a == *b) ++a, ++b;
  return (unsigned char)*a - (unsigned char)*b;
}

void exit(int code) {
  for (;;) dendro_call(kSysExit, code, 0, 0);
}

/* Blocks lie one behind the other from the first brk to the last; each begins with its size, bit 0 set while
 * in use. */
struct block {
  uint32_t size;
  uint32_t unused;
};
static struct block *first_block, *end_block;

static struct block* behind(struct block* b) { return (struct block*)((char*)b + (b->size & ~1u)); }

static int grow(size_t bytes) {
  if (!first_block) {
    const uintptr_t start = ((uintptr_t)dendro_call(kSysBrk, 0, 0, 0) + 7) & ~7u;
    first_block = end_block = (struct block*)start;
  }
  const size_t step = (bytes + 0xFFFF) & ~(size_t)0xFFFF;
  const uintptr_t wanted = (uintptr_t)end_block + step;
  if (step < bytes || wanted < step || (uintptr_t)dendro_call(kSysBrk, (long)wanted, 0, 0) != wanted)
    return 0;
  end_block->size = step;
  end_block = (struct block*)wanted;
  return 1;
}

static struct block* find(size_t bytes) {
  for (struct block* b = first_block; b && b != end_block; b = behind(b)) {
    if (b->size & 1) continue;
    while (behind(b) != end_block && !(behind(b)->size & 1)) b->size += behind(b)->size;
    if (b->size >= bytes) return b;
  }
  return NULL;
}

void* malloc(size_t bytes) {
  if (bytes > 0x7FFF0000u) return NULL;
  const size_t size = ((bytes + 7) & ~(size_t)7) + sizeof(struct block);
  struct block* b = find(size);
  if (!b && (!grow(size) || !(b = find(size)))) return NULL;
  if (b->size - size >= 2 * sizeof(struct block)) {
    struct block* rest = (struct block*)((char*)b + size);
    rest->size = b->size - size;
    b->size = size;
  }
  b->size |= 1;
  return b + 1;
}

void* calloc(size_t count, size_t bytes) {
  if (bytes && count > 0x7FFF0000u / bytes) return NULL;
  void* block = malloc(count * bytes);
  return block ? memset(block, 0, count * bytes) : NULL;
}

void free(void* block) {
  if (block) ((struct block*)block - 1)->size &= ~1u;
}
