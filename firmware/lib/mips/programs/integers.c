#include "firmware/lib/mips/dendro.h"

static uint64_t state = 88172645463325252ull;
static uint64_t draw(void) {
  state ^= state << 13;
  state ^= state >> 7;
  return state ^= state << 17;
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

/* 64-bit arithmetic, shifts and conversions on numbers of all sizes: a line of "operation a b result" each.
 */
int main(void) {
  for (int i = 0; i < 400; ++i) {
    const unsigned down = (unsigned)draw() & 63, down_b = (unsigned)draw() & 63;
    const uint64_t a = draw() >> down, b = (draw() >> down_b) | 1;
    const int64_t sa = (int64_t)(draw() & 1 ? a : -a), sb = (int64_t)(draw() & 1 ? b : -b);
    printf("udiv %llx %llx %llx %llx\n", a, b, a / b, a % b);
    printf("sdiv %llx %llx %llx %llx\n", sa, sb, sa / sb, sa % sb);
    printf("mul %llx %llx %llx\n", a, b, a * b);
    printf("shift %llx %x %llx %llx %llx\n", sa, down, (uint64_t)sa << down, (uint64_t)sa >> down,
           sa >> down);
    printf("todouble %llx %llx %llx\n", sa, bits((double)sa), bits((double)(uint64_t)sa));
    printf("tosingle %llx %x %x\n", sa, bits_single((float)sa), bits_single((float)(uint64_t)sa));
    const double d = (double)sa * 0.37, ud = (double)a * 0.37;
    printf("fromdouble %llx %llx %llx %llx\n", bits(d), (int64_t)d, bits(ud), (uint64_t)ud);
    printf("fromsingle %x %x %x\n", bits_single((float)(uint32_t)a * 0.49f),
           (int32_t)((float)(uint32_t)a * 0.49f), (uint32_t)((float)(uint32_t)a * 0.49f));
  }
  printf("[%5d] [%-5d] [%05d] [%x] [%08X] [%s] [%-4s] [%.2s] [%c] [%%] [%5.2f] [%e] [%lld]\n", -42, -42, -42,
         0xBEEFu, 0xBEEFu, "text", "ab", "abcdef", 'z', 3.14159, -12345.678, -1234567890123456789ll);
  return 0;
}
