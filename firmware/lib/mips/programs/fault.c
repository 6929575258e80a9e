#include "firmware/lib/mips/dendro.h"

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
  if (what == 'm') { /* the smallest normal number, halved: the R3010 gives up */
    volatile double small = 2.2250738585072014e-308;
    small *= 0.5;
  }
  return 0;
}
