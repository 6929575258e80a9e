#include "firmware/lib/mips/dendro.h"

static volatile int sink;

static __attribute__((noinline)) int deeper(int n) {
  volatile char frame[4096];
  frame[n & 4095] = (char)n;
  return n == 0 ? 0 : deeper(n + 1) + frame[n & 4095];
}

static __attribute__((noinline)) int spin(int go) {
  while (go) sink += go;
  return sink;
}

static __attribute__((noinline)) int outer(int go) {
  sink = go;
  return spin(go) + 1;
}

/* Does what its argument says and a processor dislikes. */
int main(int argc, char** argv) {
  const char what = argc > 1 ? argv[1][0] : 0;
  volatile unsigned* const nowhere = (volatile unsigned*)0x70000000;
  volatile unsigned zero = 0, many = 7;
  if (what == 'u') return (int)*(volatile unsigned*)((uintptr_t)argv | 2);
  if (what == 'n') return (int)*nowhere;
  if (what == 'k') return (int)*(volatile unsigned*)0x80000000;
  if (what == 'd') return (int)(many / zero);
  if (what == 'r') __asm__ volatile(".word 0x7000003f");
  if (what == 'l')
    while (!zero) {
    }
  if (what == 's') return deeper(1);
  if (what == 'h') /* heap: what brk has not given */
    for (volatile char* p = malloc(64);; p += 1024) *p = 1;
  if (what == 'w') *(volatile unsigned*)((uintptr_t)argv | 2) = 1;
  if (what == 'c') {
    printf("endless\n");
    return outer(argc) + 1;
  }
  if (what == 'm') { /* the smallest normal number, halved: the R3010 gives up */
    volatile double small = 2.2250738585072014e-308;
    small *= 0.5;
  }
  return 0;
}
