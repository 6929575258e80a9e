/* What the compiler calls for 64-bit integers and their conversions on a 32-bit MIPS I. */
#include "firmware/lib/mips/dendro.h"

typedef union {
  uint64_t all;
  struct {
    uint32_t high, low;
  };
} wide;

uint64_t __ashldi3(uint64_t value, int count) {
  wide v = {value};
  if (count >= 32) {
    v.high = v.low << (count - 32);
    v.low = 0;
  } else if (count) {
    v.high = v.high << count | v.low >> (32 - count);
    v.low <<= count;
  }
  return v.all;
}

uint64_t __lshrdi3(uint64_t value, int count) {
  wide v = {value};
  if (count >= 32) {
    v.low = v.high >> (count - 32);
    v.high = 0;
  } else if (count) {
    v.low = v.low >> count | v.high << (32 - count);
    v.high >>= count;
  }
  return v.all;
}

int64_t __ashrdi3(int64_t value, int count) {
  wide v = {(uint64_t)value};
  if (count >= 32) {
    v.low = (uint32_t)((int32_t)v.high >> (count - 32));
    v.high = (uint32_t)((int32_t)v.high >> 31);
  } else if (count) {
    v.low = v.low >> count | v.high << (32 - count);
    v.high = (uint32_t)((int32_t)v.high >> count);
  }
  return (int64_t)v.all;
}

int __clzsi2(uint32_t value) {
  int count = 0;
  if (!value) return 32;
  if (!(value >> 16)) count += 16, value <<= 16;
  if (!(value >> 24)) count += 8, value <<= 8;
  if (!(value >> 28)) count += 4, value <<= 4;
  if (!(value >> 30)) count += 2, value <<= 2;
  return count + !(value >> 31);
}

int __clzdi2(uint64_t value) {
  const wide v = {value};
  return v.high ? __clzsi2(v.high) : 32 + __clzsi2(v.low);
}

int __ctzsi2(uint32_t value) { return 31 - __clzsi2(value & -value); }

static uint64_t divide(uint64_t a, uint64_t b, uint64_t* rest) {
  uint64_t quotient = 0;
  if (!b) __builtin_trap();
  if (!((a | b) >> 32)) {
    *rest = (uint32_t)a % (uint32_t)b;
    return (uint32_t)a / (uint32_t)b;
  }
  int shift = a < b ? -1 : __clzdi2(b) - __clzdi2(a);
  for (uint64_t d = shift > 0 ? b << shift : b; shift >= 0; --shift, d >>= 1) {
    quotient <<= 1;
    if (a >= d) {
      a -= d;
      quotient |= 1;
    }
  }
  *rest = a;
  return quotient;
}

static uint64_t magnitude(int64_t value) { return value < 0 ? -(uint64_t)value : (uint64_t)value; }

uint64_t __udivdi3(uint64_t a, uint64_t b) {
  uint64_t rest;
  return divide(a, b, &rest);
}
uint64_t __umoddi3(uint64_t a, uint64_t b) {
  uint64_t rest;
  divide(a, b, &rest);
  return rest;
}
int64_t __divdi3(int64_t a, int64_t b) {
  uint64_t rest;
  const uint64_t quotient = divide(magnitude(a), magnitude(b), &rest);
  return (int64_t)((a < 0) != (b < 0) ? -quotient : quotient);
}
int64_t __moddi3(int64_t a, int64_t b) {
  uint64_t rest;
  divide(magnitude(a), magnitude(b), &rest);
  return (int64_t)(a < 0 ? -rest : rest);
}

int __ucmpdi2(uint64_t a, uint64_t b) { return a < b ? 0 : a > b ? 2 : 1; }
int __cmpdi2(int64_t a, int64_t b) { return a < b ? 0 : a > b ? 2 : 1; }

/* Unsigned and 64-bit conversions. To integers they cut off; what does not fit is not defined by C. */
double __floatunsidf(uint32_t value) { return (int32_t)(value >> 1) * 2.0 + (int32_t)(value & 1); }
float __floatunsisf(uint32_t value) { return (float)__floatunsidf(value); }
uint32_t __fixunsdfsi(double x) {
  return x >= 2147483648.0 ? (uint32_t)(int32_t)(x - 2147483648.0) + 0x80000000u : (uint32_t)(int32_t)x;
}
uint32_t __fixunssfsi(float x) { return __fixunsdfsi(x); }

/* One rounding: the two halves are exact, and so is the product. */
double __floatundidf(uint64_t value) {
  const wide v = {value};
  return __floatunsidf(v.high) * 4294967296.0 + __floatunsidf(v.low);
}
double __floatdidf(int64_t value) {
  const wide v = {(uint64_t)value};
  return (int32_t)v.high * 4294967296.0 + __floatunsidf(v.low);
}
/* More than 53 bits would be rounded twice: what lies below bit 12 becomes one sticky bit first. */
static uint64_t sticky(uint64_t value) {
  return value >> 53 ? (value & ~(uint64_t)0xFFF) | (value & 0xFFF ? 0x800 : 0) : value;
}
float __floatundisf(uint64_t value) { return (float)__floatundidf(sticky(value)); }
float __floatdisf(int64_t value) {
  const float size = __floatundisf(magnitude(value));
  return value < 0 ? -size : size;
}

uint64_t __fixunsdfdi(double x) {
  wide v;
  v.high = __fixunsdfsi(x * (1 / 4294967296.0));
  v.low = __fixunsdfsi(x - __floatunsidf(v.high) * 4294967296.0);
  return v.all;
}
int64_t __fixdfdi(double x) { return x < 0 ? -(int64_t)__fixunsdfdi(-x) : (int64_t)__fixunsdfdi(x); }
uint64_t __fixunssfdi(float x) { return __fixunsdfdi(x); }
int64_t __fixsfdi(float x) { return __fixdfdi(x); }
