/* Finishes what the R3010 gives up on: operations with denormal operands or results, by integers alone. */
#include <stdint.h>

enum {
  kSingle = 16,
  kDouble = 17,
  kAdd = 0,
  kSub = 1,
  kMul = 2,
  kDiv = 3,
  kCvtS = 32,
  kCvtD = 33,
  kCvtW = 36
};
enum { kInexact = 1, kUnderflow = 2, kOverflow = 4, kDivideByZero = 8, kInvalid = 16 };

/* The monitor's copy of the program's registers; monitor.S knows the offsets. */
struct frame {
  uint32_t r[32];
  uint32_t f[32];
  uint32_t control, epc, cause;
};

/* A number: sign, and significand * 2^(exponent - 62) with bit 62 the top one, or zero or infinite. */
struct number {
  int negative, zero, infinite, exponent;
  uint64_t significand;
};

static int fraction_bits(int format) { return format == kDouble ? 52 : 23; }
static int bias(int format) { return format == kDouble ? 1023 : 127; }

/* Shifts right; what falls out leaves a mark in bit 0. */
static uint64_t jam(uint64_t value, int count) {
  if (count <= 0) return value;
  if (count > 63) return value != 0;
  return value >> count | ((value & (((uint64_t)1 << count) - 1)) != 0);
}

static void normalise(struct number* n) {
  while (!(n->significand >> 62)) {
    n->significand <<= 1;
    --n->exponent;
  }
}

static struct number unpack(const struct frame* p, int format, unsigned reg) {
  struct number n = {0, 0, 0, 0, 0};
  uint64_t all = format == kDouble ? (uint64_t)p->f[reg | 1] << 32 | p->f[reg & 30] : p->f[reg];
  const int bits = fraction_bits(format);
  const unsigned top = 2 * (unsigned)bias(format) + 1;
  const unsigned exponent = (unsigned)(all >> bits) & top;
  n.negative = format == kDouble ? (int)(all >> 63) : (int)(all >> 31);
  all &= ((uint64_t)1 << bits) - 1;
  n.zero = exponent == 0 && all == 0;
  n.infinite = exponent == top;
  n.exponent = (exponent ? (int)exponent : 1) - bias(format);
  n.significand = (all | (exponent ? (uint64_t)1 << bits : 0)) << (62 - bits);
  if (!n.zero) normalise(&n);
  return n;
}

static int rounds_up(int mode, int negative, int odd, uint64_t rest, uint64_t half) {
  if (mode == 0) return rest > half || (rest == half && odd);
  return rest && (mode == 2 ? !negative : mode == 3 && negative);
}

static void store(struct frame* p, int format, unsigned reg, uint64_t bits) {
  if (format == kDouble) {
    p->f[reg & 30] = (uint32_t)bits;
    p->f[reg | 1] = (uint32_t)(bits >> 32);
  } else {
    p->f[reg] = (uint32_t)bits;
  }
}

/* Rounds into the register; the exceptions. */
static unsigned pack(struct frame* p, int format, unsigned reg, struct number n) {
  const int bits = fraction_bits(format), mode = (int)p->control & 3, lowest = 1 - bias(format);
  const uint64_t sign = (uint64_t)(n.negative != 0) << (format == kDouble ? 63 : 31);
  const uint64_t infinity = (uint64_t)(2 * (unsigned)bias(format) + 1) << bits;
  unsigned exceptions = 0;
  if (n.zero || n.infinite) {
    store(p, format, reg, sign | (n.infinite ? infinity : 0));
    return 0;
  }
  const int tiny = n.exponent < lowest;
  if (tiny) n.significand = jam(n.significand, lowest - n.exponent);
  const uint64_t unit = (uint64_t)1 << (62 - bits), rest = n.significand & (unit - 1);
  uint64_t kept = n.significand >> (62 - bits);
  if (rest) exceptions = kInexact | (tiny ? kUnderflow : 0);
  kept += (uint64_t)rounds_up(mode, n.negative, (int)kept & 1, rest, unit >> 1);
  /* The hidden bit adds one to the exponent, and so does a carry out of the fraction. */
  kept += (uint64_t)(uint32_t)(tiny ? 0 : n.exponent - lowest) << bits;
  if (kept >= infinity) {
    exceptions = kOverflow | kInexact;
    kept = mode == 0 || mode == (n.negative ? 3 : 2) ? infinity : infinity - 1;
  }
  store(p, format, reg, sign | kept);
  return exceptions;
}

static struct number add(struct number a, struct number b, int mode) {
  if (a.infinite) return a;
  if (b.infinite) return b;
  if (a.zero || (!b.zero && b.exponent > a.exponent)) {
    const struct number swap = a;
    a = b;
    b = swap;
  }
  if (b.zero) return a;
  /* One bit of room above, and bits below: with 53 of 62 in use a mark in bit 0 is far from the rounding. */
  uint64_t x = a.significand >> 1, y = jam(b.significand >> 1, a.exponent - b.exponent);
  a.exponent += 1;
  if (a.negative == b.negative) {
    a.significand = x + y;
  } else if (x == y) {
    a.zero = 1;
    a.negative = mode == 3;
    return a;
  } else {
    if (x < y) a.negative = b.negative;
    a.significand = x < y ? y - x : x - y;
  }
  normalise(&a);
  return a;
}

static struct number multiply(struct number a, const struct number b) {
  a.negative ^= b.negative;
  a.infinite |= b.infinite;
  a.zero |= b.zero;
  if (a.infinite || a.zero) return a;
  const uint32_t ah = (uint32_t)(a.significand >> 32), al = (uint32_t)a.significand;
  const uint32_t bh = (uint32_t)(b.significand >> 32), bl = (uint32_t)b.significand;
  const uint64_t low = (uint64_t)al * bl, m1 = (uint64_t)ah * bl, m2 = (uint64_t)al * bh;
  const uint64_t middle = (low >> 32) + (uint32_t)m1 + (uint32_t)m2;
  const uint64_t high = (uint64_t)ah * bh + (m1 >> 32) + (m2 >> 32) + (middle >> 32);
  /* The product has its top bit at 124 or 125; bits 64 and up are in `high`. */
  a.significand = high << 1 | (((uint32_t)middle | (uint32_t)low) != 0);
  a.exponent += b.exponent + 1;
  if (a.significand >> 62) return a;
  normalise(&a);
  return a;
}

static struct number divide(struct number a, const struct number b) {
  a.negative ^= b.negative;
  if (a.infinite || a.zero) return a;
  if (b.zero || b.infinite) {
    a.infinite = b.zero;
    a.zero = b.infinite;
    return a;
  }
  uint64_t rest = a.significand, quotient = 0;
  for (int i = 0; i < 63; ++i) {
    quotient <<= 1;
    if (rest >= b.significand) {
      rest -= b.significand;
      quotient |= 1;
    }
    rest <<= 1;
  }
  a.significand = quotient | (rest != 0);
  a.exponent -= b.exponent;
  normalise(&a);
  return a;
}

/* A denormal number lies between 0 and one half. */
static unsigned to_word(struct frame* p, unsigned reg, const struct number n) {
  const int mode = (int)p->control & 3;
  p->f[reg] = mode == 2 && !n.negative ? 1 : mode == 3 && n.negative ? 0xFFFFFFFFu : 0;
  return kInexact;
}

static int taken(const struct frame* p, uint32_t word) {
  const int32_t a = (int32_t)p->r[word >> 21 & 31], b = (int32_t)p->r[word >> 16 & 31];
  switch (word >> 26) {
    case 1:
      return (a < 0) != (int)(word >> 16 & 1);
    case 4:
      return a == b;
    case 5:
      return a != b;
    case 6:
      return a <= 0;
    case 7:
      return a > 0;
    case 17:
      return (int)(p->control >> 23 & 1) == (int)(word >> 16 & 1);
    default:
      return 0;
  }
}

/* Where the program goes on behind the word at EPC, or behind the branch there and its slot. */
static uint32_t behind(struct frame* p) {
  if (!(p->cause >> 31)) return p->epc + 4;
  const uint32_t word = *(const uint32_t*)p->epc, major = word >> 26;
  if (major == 0) return p->r[word >> 21 & 31];
  if (major == 2 || major == 3) return ((p->epc + 4) & 0xF0000000u) | (word & 0x3FFFFFF) << 2;
  return taken(p, word) ? p->epc + 4 + (uint32_t)((int32_t)(int16_t)word * 4) : p->epc + 8;
}

/* 1 if the operation is done and the program can go on, 0 if it cannot be. A branch has written its link
 * already. */
int finish_operation(struct frame* p) {
  const uint32_t word = *(const uint32_t*)(p->cause >> 31 ? p->epc + 4 : p->epc);
  const int format = (int)(word >> 21 & 31), operation = (int)(word & 63);
  const unsigned ft = word >> 16 & 31, fs = word >> 11 & 31, fd = word >> 6 & 31;
  unsigned exceptions = 0;
  if (!(p->control >> 17 & 1) || word >> 26 != 17 || (format != kSingle && format != kDouble)) return 0;
  const struct number a = unpack(p, format, fs);
  struct number b = unpack(p, format, ft);
  if (operation == kSub) b.negative = !b.negative;
  if (operation <= kSub)
    exceptions = pack(p, format, fd, add(a, b, (int)p->control & 3));
  else if (operation == kMul && ((a.infinite && b.zero) || (a.zero && b.infinite)))
    return 0;
  else if (operation == kMul)
    exceptions = pack(p, format, fd, multiply(a, b));
  else if (operation == kDiv)
    exceptions = pack(p, format, fd, divide(a, b)) | (b.zero && !a.infinite ? kDivideByZero : 0);
  else if (operation == kCvtS && format == kDouble)
    exceptions = pack(p, kSingle, fd, a);
  else if (operation == kCvtD && format == kSingle)
    exceptions = pack(p, kDouble, fd, a);
  else if (operation == kCvtW)
    exceptions = to_word(p, fd, a);
  else
    return 0;
  p->control = (p->control & ~0x3F000u) | exceptions << 12;
  if (exceptions & (p->control >> 7)) return 0; /* the program asked for the trap */
  p->control |= exceptions << 2;
  p->epc = behind(p);
  return 1;
}
