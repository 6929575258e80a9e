#pragma once

/* What a bare-metal MIPS I program has instead of a libc: start-up, calls to the monitor, memory, text,
 * mathematics. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

/* Calls of the monitor, with Linux o32 numbers, so that the same file runs under qemu-mips. Negative: -errno.
 */
enum {
  kSysExit = 4001,
  kSysRead = 4003,
  kSysWrite = 4004,
  kSysOpen = 4005,
  kSysClose = 4006,
  kSysLseek = 4019,
  kSysBrk = 4045
};
/* Marks for the simulator; elsewhere they fail and nothing else happens. `label` is a number of the program's
 * choice. */
enum { kMarkStart = 0x7000, kMarkStop = 0x7001, kMarkLabel = 0x7002 };

long dendro_call(long number, long a0, long a1, long a2);
void exit(int code) __attribute__((noreturn));
static inline void dendro_mark(long kind, long label) { dendro_call(kind, label, 0, 0); }

void* memcpy(void* to, const void* from, size_t bytes);
void* memmove(void* to, const void* from, size_t bytes);
void* memset(void* to, int byte, size_t bytes);
int memcmp(const void* a, const void* b, size_t bytes);
size_t strlen(const char* text);
int strcmp(const char* a, const char* b);

/* First fit over what brk gives, neighbours joined when freed; 8-byte aligned. NULL when memory is used up.
 */
void* malloc(size_t bytes);
void* calloc(size_t count, size_t bytes);
void free(void* block);

/* %d %i %u %x %X %c %s %p %% with l and ll, %f %e with up to 9 decimals; flags - and 0, width, precision
   (also *). %f of 2^63 and more becomes %e. printf writes at the end of every call. */
int vsnprintf(char* to, size_t room, const char* format, va_list list);
int snprintf(char* to, size_t room, const char* format, ...) __attribute__((format(printf, 3, 4)));
int printf(const char* format, ...) __attribute__((format(printf, 1, 2)));

/* Errors in units in the last place, as tests/firmware/mips measures them: sqrt 1, sin and cos 1 for |x| <
   2^20 (NaN beyond), atan2 2, exp 1, log 1, floor exact. Those of float: 1 each. Results below the normal
   range are 0. */
double sqrt(double x);
double sin(double x);
double cos(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double floor(double x);
float sqrtf(float x);
float sinf(float x);
float cosf(float x);
float atan2f(float y, float x);
float expf(float x);
float logf(float x);
float floorf(float x);
