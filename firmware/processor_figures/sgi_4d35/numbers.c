#include "firmware/lib/mips/dendro.h"
#include "firmware/processor_figures/sgi_4d35/figures.h"

/* Gaussian elimination with partial pivoting by columns, and the loops below it, as the LINPACK Users' Guide (1979) describes
 * them; sums of vectors in fours unless the program is asked for plain loops.  ASSUMED DEV-171 */

static double matrix[kFigOrder * kFigRowLength], right[kFigOrder];
static int pivots[kFigOrder];
static int plain;

static void phase(enum fig_phase which) { dendro_mark(kMarkLabel, which); }

__attribute__((noinline)) static void add_scaled(int n, double a, const double* x, double* y) {
  int i = 0;
  if (a == 0) return;
  if (!plain)
    for (; i + 4 <= n; i += 4) {
      y[i] += a * x[i];
      y[i + 1] += a * x[i + 1];
      y[i + 2] += a * x[i + 2];
      y[i + 3] += a * x[i + 3];
    }
  for (; i < n; ++i) y[i] += a * x[i];
}

__attribute__((noinline)) static void scale(int n, double a, double* x) {
  for (int i = 0; i < n; ++i) x[i] *= a;
}

__attribute__((noinline)) static int largest(int n, const double* x) {
  int at = 0;
  double most = __builtin_fabs(x[0]);
  for (int i = 1; i < n; ++i)
    if (__builtin_fabs(x[i]) > most) most = __builtin_fabs(x[at = i]);
  return at;
}

static double* column(int j) { return matrix + j * kFigRowLength; }

/* The benchmark's own numbers; every element of the solution is 1. */
static void fill(void) {
  int32_t state = 1325;
  for (int i = 0; i < kFigOrder; ++i) right[i] = 0;
  for (int j = 0; j < kFigOrder; ++j)
    for (int i = 0; i < kFigOrder; ++i) {
      state = 3125 * state % 65536;
      column(j)[i] = (state - 32768.0) / 16384.0;
      right[i] += column(j)[i];
    }
}

static void factor(void) {
  for (int k = 0; k + 1 < kFigOrder; ++k) {
    double* from = column(k);
    const int p = k + largest(kFigOrder - k, from + k), rest = kFigOrder - k - 1;
    pivots[k] = p;
    const double pivot = from[p];
    from[p] = from[k];
    from[k] = pivot;
    scale(rest, -1 / pivot, from + k + 1);
    for (int j = k + 1; j < kFigOrder; ++j) {
      double* to = column(j);
      const double t = to[p];
      to[p] = to[k];
      to[k] = t;
      add_scaled(rest, t, from + k + 1, to + k + 1);
    }
  }
}

static void solve(void) {
  for (int k = 0; k + 1 < kFigOrder; ++k) {
    const double t = right[pivots[k]];
    right[pivots[k]] = right[k];
    right[k] = t;
    add_scaled(kFigOrder - k - 1, t, column(k) + k + 1, right + k + 1);
  }
  for (int k = kFigOrder; k-- > 0;) {
    right[k] /= column(k)[k];
    add_scaled(k, -right[k], column(k), right);
  }
}

static int check_solution(void) {
  double worst = 0;
  for (int i = 0; i < kFigOrder; ++i) {
    const double error = __builtin_fabs(right[i] - 1);
    if (error > worst) worst = error;
  }
  printf("a system of %d: largest error %.3e\n", kFigOrder, worst);
  return worst < 1e-11;
}

static double near_x[kFigNear], near_y[kFigNear], far_x[kFigFar], far_y[kFigFar];
static uint32_t words[kFigWords];

static int vectors(double* x, double* y, int n, int passes, enum fig_phase which) {
  phase(kFigPrepare);
  for (int i = 0; i < n; ++i) x[i] = i, y[i] = 1;
  phase(which);
  for (int pass = 0; pass < passes; ++pass) add_scaled(n, 0.5, x, y);
  phase(kFigCheck);
  int good = 1;
  for (int i = 0; i < n; ++i) good &= y[i] == 1 + 0.5 * passes * i;
  printf("%d sums of %d elements: %s\n", passes, n, good ? "right" : "wrong");
  return good;
}

/* Loads alone: nothing is done with the words. */
static void read_words(void) {
  phase(kFigReadLoop);
  const volatile uint32_t* at = words;
  for (const volatile uint32_t* end = at + kFigWords; at < end; at += 16) {
    (void)at[0], (void)at[1], (void)at[2], (void)at[3], (void)at[4], (void)at[5], (void)at[6], (void)at[7];
    (void)at[8], (void)at[9], (void)at[10], (void)at[11], (void)at[12], (void)at[13], (void)at[14], (void)at[15];
  }
  phase(kFigCheck);
}

/* Argument "plain": sums of vectors an element at a time. */
int main(int argc, char** argv) {
  plain = argc > 1 && strcmp(argv[1], "plain") == 0;
  phase(kFigPrepare);
  fill();
  phase(kFigFactor);
  factor();
  phase(kFigSolve);
  solve();
  phase(kFigCheck);
  int good = check_solution();
  good &= vectors(near_x, near_y, kFigNear, kFigNearPasses, kFigNearLoop);
  good &= vectors(far_x, far_y, kFigFar, kFigFarPasses, kFigFarLoop);
  read_words();
  return good ? 0 : 1;
}
