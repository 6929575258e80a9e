#pragma once

/* From floating point to integers on a processor that truncates only by changing its rounding mode. */

#include <stdint.h>

/* The bits of a double by words, without a way through memory. */
static inline int32_t high_word(double value) {
  int32_t word;
  __asm__("mfc1\t%0,%D1" : "=r"(word) : "f"(value));
  return word;
}
static inline int32_t low_word(double value) {
  int32_t word;
  __asm__("mfc1\t%0,%1" : "=r"(word) : "f"(value));
  return word;
}

#ifdef ZBV_ROUND_BY_FCR31

/* As the assembler's macros for conversions do it: rounding towards minus infinity for one instruction. */
static inline int32_t floor_to_int(float value) {
  int32_t old, now;
  float converted;
  __asm__ volatile(
      "cfc1\t%0,$31\n\t"
      "ori\t%1,%0,3\n\t"
      "ctc1\t%1,$31\n\t"
      "cvt.w.s\t%2,%3\n\t"
      "ctc1\t%0,$31\n\t"
      "mfc1\t%1,%2"
      : "=&r"(old), "=&r"(now), "=&f"(converted)
      : "f"(value));
  return now;
}

#else

/* 1.5 * 2^20 puts the units of a sum at the end of a double's high word, and 32 bits of fraction below it:
   exact for |value| < 2^19, but for what lies within 2^-33 below an integer. Beyond 2^19 the result is no
   floor, but lies far outside of every picture (kZbvMostLightSide), as a float that large does. */
static inline int32_t floor_to_int(float value) {
  return (int32_t)((uint32_t)high_word((double)value + 1572864.0) - 0x41380000u);
}

#endif

/* To nearest, |value| < 2^31: 1.5 * 2^52 leaves the integer in the low word. */
static inline int32_t round_to_int(double value) { return low_word(value + 6755399441055744.0); }
