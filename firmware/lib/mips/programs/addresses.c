#include "firmware/lib/mips/dendro.h"

/* Calls with addresses in and around kseg0, kseg1 and kseg2, and ranges that reach them. */
static void kernel(void) {
  static char inside[16] = "inside";
  const uint32_t first[] = {0x80000000u, 0x80000080u, 0x80400000u, 0x9FFFFFFFu, 0xA0000000u, 0xBF000000u,
                            0xC0000000u, 0xFFFFFFF0u, 0xFFFFFFFFu, 0x7FFFFFF0u, (uint32_t)(uintptr_t)inside};
  const uint32_t bytes[] = {1, 4, 0x40, 0x2000, 0x7FFFFFFF, 0x80000000u, 0x80000001u, 0xFFFFFFF0u, 0xFFFFFFFFu};
  for (unsigned i = 0; i < sizeof first / sizeof *first; ++i) {
    for (unsigned k = 0; k < sizeof bytes / sizeof *bytes; ++k) {
      const uint32_t count = bytes[k];
      if ((first[i] | count | (first[i] + count - 1)) < 0x80000000u) continue; /* may lie in user space */
      const long wrote = dendro_call(kSysWrite, 1, (long)first[i], (long)count);
      const long got = dendro_call(kSysRead, 0, (long)first[i], (long)count);
      printf("%u %x: write %ld, read %ld\n", i, count, wrote, got);
    }
    if (first[i] >= 0x80000000u) printf("%u: open %ld\n", i, dendro_call(kSysOpen, (long)first[i], 0, 0));
  }
  printf("%s\n", inside);
}

/* A stack whose last byte is 0x7FFFFFFF. */
static void top(void) {
  volatile char* const last = (volatile char*)0x7FFFFFC0;
  for (int i = 0; i < 64; ++i) last[i] = 'x';
  const long fits = dendro_call(kSysWrite, 1, (long)last, 64), over = dendro_call(kSysWrite, 1, (long)last, 65);
  printf("\nfits %ld, over %ld, path %ld\n", fits, over, dendro_call(kSysOpen, (long)last, 0, 0));
}

static uint32_t state = 7;
static uint32_t draw(uint32_t below) {
  state = state * 1664525u + 1013904223u;
  return (state >> 8) % below;
}

/* The break up and down by odd numbers of bytes. */
static void up_and_down(void) {
  unsigned char* const start = (unsigned char*)dendro_call(kSysBrk, 0, 0, 0);
  uint32_t size = 0;
  for (int turn = 0; turn < 60; ++turn) {
    const uint32_t next = turn % 8 == 7 ? draw(16) : draw(turn % 3 ? 40000 : 200000);
    const uintptr_t want = (uintptr_t)start + next;
    const int given = (uintptr_t)dendro_call(kSysBrk, (long)want, 0, 0) == want;
    unsigned kept = 0, dirty = 0;
    for (uint32_t i = 0; i < next; ++i)
      if (i < size)
        kept += start[i] == (unsigned char)(i % 251 + 1);
      else
        dirty += start[i] != 0;
    for (uint32_t i = size; i < next; ++i) start[i] = (unsigned char)(i % 251 + 1);
    printf("%d: %u bytes, given %d, kept %u, dirty %u\n", turn, next, given, kept, dirty);
    size = next;
  }
  const uintptr_t now = (uintptr_t)start + size;
  printf("too much %d\n", (uintptr_t)dendro_call(kSysBrk, 0x7FFFF000, 0, 0) == now);
}

int main(int argc, char** argv) {
  const char what = argc > 1 ? argv[1][0] : 0;
  if (what == 'k') kernel();
  if (what == 't') top();
  if (what == 'b') up_and_down();
  return 0;
}
