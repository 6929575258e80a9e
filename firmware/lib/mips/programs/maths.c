#include "firmware/lib/mips/dendro.h"

static uint32_t state = 2463534242u;
static uint32_t draw(void) {
  state ^= state << 13;
  state ^= state >> 17;
  return state ^= state << 5;
}

static uint64_t bits(double x) {
  uint64_t b;
  memcpy(&b, &x, 8);
  return b;
}
static uint32_t bits_single(float x) {
  uint32_t b;
  memcpy(&b, &x, 4);
  return b;
}

/* A number of any size between 2^low and 2^high, either sign. */
static double number(int low, int high) {
  const uint64_t exponent = (uint64_t)(1023 + low + (int)(draw() % (unsigned)(high - low)));
  const uint64_t all = exponent << 52 | (uint64_t)(draw() & 0xFFFFF) << 32 | draw();
  double x;
  memcpy(&x, &all, 8);
  return draw() & 1 ? -x : x;
}
static double size(double x) { return x < 0 ? -x : x; }

/* "name x y result" in bits, a line each; float results behind "f". Call with the number of rounds, 300
 * without. */
int main(int argc, char** argv) {
  int rounds = 0;
  for (const char* at = argc > 1 ? argv[1] : "300"; *at >= '0' && *at <= '9'; ++at)
    rounds = rounds * 10 + *at - '0';
  for (int i = 0; i < rounds; ++i) {
    const double any = size(number(-1000, 1000)), angle = number(-20, 20), near = number(-4, 3),
                 other = number(-60, 60), y = number(-60, 60);
    const float any_single = (float)size(number(-120, 120)), angle_single = (float)angle, y_single = (float)y,
                other_single = (float)other;
    const double power = number(-10, 9);
    const float power_single = (float)number(-10, 6);
    printf("sqrt %llx 0 %llx\n", bits(any), bits(sqrt(any)));
    printf("sin %llx 0 %llx\n", bits(angle), bits(sin(angle)));
    printf("cos %llx 0 %llx\n", bits(angle), bits(cos(angle)));
    printf("sin %llx 0 %llx\n", bits(near), bits(sin(near)));
    printf("cos %llx 0 %llx\n", bits(near), bits(cos(near)));
    printf("atan2 %llx %llx %llx\n", bits(y), bits(other), bits(atan2(y, other)));
    const double beside = number(-4, 3);
    printf("atan2 %llx %llx %llx\n", bits(near), bits(beside), bits(atan2(near, beside)));
    printf("exp %llx 0 %llx\n", bits(power), bits(exp(power)));
    printf("log %llx 0 %llx\n", bits(any), bits(log(any)));
    printf("log %llx 0 %llx\n", bits(size(near)), bits(log(size(near))));
    printf("floor %llx 0 %llx\n", bits(other), bits(floor(other)));
    printf("fsqrt %x 0 %x\n", bits_single(any_single), bits_single(sqrtf(any_single)));
    printf("fsin %x 0 %x\n", bits_single(angle_single), bits_single(sinf(angle_single)));
    printf("fcos %x 0 %x\n", bits_single(angle_single), bits_single(cosf(angle_single)));
    printf("fatan2 %x %x %x\n", bits_single(y_single), bits_single(other_single),
           bits_single(atan2f(y_single, other_single)));
    printf("fexp %x 0 %x\n", bits_single(power_single), bits_single(expf(power_single)));
    printf("flog %x 0 %x\n", bits_single(any_single), bits_single(logf(any_single)));
    printf("ffloor %x 0 %x\n", bits_single(other_single), bits_single(floorf(other_single)));
  }
  return 0;
}
