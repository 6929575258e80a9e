#include "firmware/lib/mips/dendro.h"

static uint64_t state = 88172645463325252ull;
static uint64_t draw(void) {
  state ^= state << 13;
  state ^= state >> 7;
  return state ^= state << 17;
}

static double number(unsigned lowest, unsigned highest) {
  const uint64_t all =
      (draw() & 0x800FFFFFFFFFFFFFull) | (uint64_t)(lowest + (unsigned)draw() % (highest - lowest + 1)) << 52;
  double x;
  memcpy(&x, &all, 8);
  return x;
}
static float single(unsigned lowest, unsigned highest) {
  const uint32_t all = ((uint32_t)draw() & 0x807FFFFFu) | (lowest + (unsigned)draw() % (highest - lowest + 1))
                                                              << 23;
  float x;
  memcpy(&x, &all, 4);
  return x;
}

static uint64_t sum;
static void take(double x) {
  uint64_t b;
  memcpy(&b, &x, 8);
  sum = sum * 31 + b;
  printf(" %llx", b);
}
static void take_single(float x) {
  uint32_t b;
  memcpy(&b, &x, 4);
  printf(" %x", b);
}

static void round_to(unsigned mode) { __asm__ volatile("ctc1 %0, $31\n\tnop" : : "r"(mode)); }
static unsigned control(void) {
  unsigned c;
  __asm__ volatile("cfc1 %0, $31\n\tnop" : "=r"(c));
  return c;
}

/* Operands and results around and below the smallest normal number, in every rounding mode. */
int main(void) {
  for (unsigned i = 0; i < 400; ++i) {
    volatile double a = number(0, 3), b = number(0, 3), c = number(1000, 1080), d = number(960, 1030);
    volatile float s = single(0, 3), t = single(0, 3), u = single(100, 180), v = single(97, 140);
    double r[8];
    float q[8];
    round_to(i & 3);
    r[0] = a + b, r[1] = a - b, r[2] = a * c, r[3] = a / c, r[4] = d * a, r[5] = c / a, r[6] = s,
    r[7] = (double)t + a;
    q[0] = s + t, q[1] = s - t, q[2] = s * u, q[3] = s / u, q[4] = v * t, q[5] = u / t, q[6] = (float)d,
    q[7] = (float)(a * c);
    const unsigned flags = control() & 0x7C;
    volatile float small = (float)(1e-38 * v);
    const float down = floorf(small) * 1.0f;
    round_to(0);
    for (int k = 0; k < 8; ++k) take(r[k]), take_single(q[k]);
    take_single(small);
    take_single(down);
    printf(" flags %x\n", flags);
  }
  printf("%llx\n", sum);
  return 0;
}
