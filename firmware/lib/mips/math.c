/* Elementary functions without square root, truncation or 64-bit arithmetic in hardware. Minimax polynomials
   on reduced arguments, after the well-known fdlibm scheme (its coefficients). The results' rounding mode is
   to nearest. */
#include "firmware/lib/mips/dendro.h"

typedef union {
  double value;
  struct {
    uint32_t high, low;
  };
} parts;

static double make(uint32_t high, uint32_t low) {
  parts p;
  p.high = high;
  p.low = low;
  return p.value;
}
static uint32_t high_of(double x) {
  parts p;
  p.value = x;
  return p.high;
}
static double nan_value(void) { return make(0x7FF7FFFF, 0xFFFFFFFF); }
static double infinity(void) { return make(0x7FF00000, 0); }
static int is_nan(double x) { return x != x; }

double sqrt(double x) {
  if (!(x > 0)) return x == 0 ? x : nan_value();
  const uint32_t high = high_of(x);
  if (high >= 0x7FF00000) return x;
  /* Half the exponent: 3.5 % off at most. Each step of Heron's squares the error. */
  double y = make((high >> 1) + 0x1FF7A3BE, 0);
  for (int i = 0; i < 4; ++i) y = 0.5 * (y + x / y);
  return y;
}

float sqrtf(float x) {
  if (!(x > 0)) return x == 0 ? x : (float)nan_value();
  const double wide = x;
  if (high_of(wide) >= 0x7FF00000) return x;
  double y = make((high_of(wide) >> 1) + 0x1FF7A3BE, 0);
  for (int i = 0; i < 3; ++i) y = 0.5 * (y + wide / y);
  return (float)y;
}

static double sin_kernel(double x, double tail) {
  const double z = x * x, v = z * x;
  const double r = 8.33333333332248946124e-03 +
                   z * (-1.98412698298579493134e-04 +
                        z * (2.75573137070700676789e-06 +
                             z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return x - ((z * (0.5 * tail - v * r) - tail) - v * -1.66666666666666324348e-01);
}

static double cos_kernel(double x, double tail) {
  const double z = x * x;
  const double r = z * (4.16666666666666019037e-02 +
                        z * (-1.38888888888741095749e-03 +
                             z * (2.48015872894767294178e-05 +
                                  z * (-2.75573143513906633035e-07 +
                                       z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const double half = 0.5 * z, w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * r - x * tail));
}

/* x less the nearest multiple of pi/2, in two parts; pi/2 in pieces whose products with n < 2^20 are exact.
 * Returns n mod 4. */
static int reduce(double x, double* rest, double* tail) {
  static const double kPieces[] = {1.57079632673412561417e+00, 6.07710050630396597660e-11,
                                   2.02226624871116645580e-21};
  const double n = floor(x * 6.36619772367581382433e-01 + 0.5);
  double r = x - n * kPieces[0];
  double w = n * kPieces[1], before = r;
  r = before - w;
  w = n * kPieces[2] - ((before - r) - w);
  before = r;
  r = before - w;
  w = n * 8.47842766036889956997e-32 - ((before - r) - w);
  *rest = r - w;
  *tail = (r - *rest) - w;
  return (int)n & 3;
}

static double sine(double x, int quarter) {
  const double size = x < 0 ? -x : x;
  double rest = x, tail = 0;
  if (!(size < 1048576.0)) return nan_value();
  if (size < 1e-9 && !quarter) return x;
  if (size < 1e-9) return 1;
  if (!(size < 0.7853)) quarter += reduce(x, &rest, &tail);
  const double value = quarter & 1 ? cos_kernel(rest, tail) : sin_kernel(rest, tail);
  return quarter & 2 ? -value : value;
}

double sin(double x) { return sine(x, 0); }
double cos(double x) { return sine(x, 1); }

static double arctangent(double x) { /* x >= 0 */
  static const double kHigh[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01,
                                 9.82793723247329054082e-01, 1.57079632679489655800e+00};
  static const double kLow[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17,
                                1.39033110312309984516e-17, 6.12323399573676603587e-17};
  int id = -1;
  if (x > 1e18) return kHigh[3];
  if (x < 1e-9) return x;
  if (x < 0.4375) {
  } else if (x < 0.6875) {
    id = 0;
    x = (2.0 * x - 1.0) / (2.0 + x);
  } else if (x < 1.1875) {
    id = 1;
    x = (x - 1.0) / (x + 1.0);
  } else if (x < 2.4375) {
    id = 2;
    x = (x - 1.5) / (1.0 + 1.5 * x);
  } else {
    id = 3;
    x = -1.0 / x;
  }
  const double z = x * x, w = z * z;
  const double odd =
      z * (3.33333333333329318027e-01 +
           w * (1.42857142725034663711e-01 +
                w * (9.09088713343650656196e-02 +
                     w * (6.66107313738753120669e-02 +
                          w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
  const double even = w * (-1.99999999998764832476e-01 +
                           w * (-1.11111104054623557880e-01 +
                                w * (-7.69187620504482999495e-02 +
                                     w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
  if (id < 0) return x - x * (odd + even);
  return kHigh[id] - ((x * (odd + even) - kLow[id]) - x);
}

double atan2(double y, double x) {
  const double kPi = 3.1415926535897931160, kPiLow = 1.2246467991473531772e-16;
  if (is_nan(x) || is_nan(y)) return nan_value();
  const int down = high_of(y) >> 31, left = high_of(x) >> 31;
  const double ax = left ? -x : x, ay = down ? -y : y;
  double angle;
  if (ay == 0) {
    angle = 0;
  } else if (ax == 0) {
    angle = 0.5 * kPi;
  } else if (ax == infinity()) {
    angle = ay == infinity() ? 0.25 * kPi : 0;
  } else if (ay == infinity()) {
    angle = 0.5 * kPi;
  } else {
    const int above =
        (int)(high_of(ay) >> 20) - (int)(high_of(ax) >> 20); /* the quotient would leave the normal range */
    angle = above > 60 ? 0.5 * kPi : above < -900 ? 0 : arctangent(ay / ax);
  }
  if (left) angle = kPi - (angle - kPiLow);
  return down ? -angle : angle;
}

/* x * 2^n within the normal range; above is infinity, below 0. */
static double scale(double x, int n) {
  const uint32_t high = high_of(x);
  const int exponent = (int)(high >> 20 & 0x7FF) + n;
  parts p;
  if (exponent >= 0x7FF) return infinity();
  if (exponent <= 0) return 0;
  p.value = x;
  p.high = (high & 0x800FFFFF) | (uint32_t)exponent << 20;
  return p.value;
}

double exp(double x) {
  if (is_nan(x)) return nan_value();
  if (x > 709.782712893383973096) return infinity();
  if (x < -708.396418532264106224) return 0;
  if (x < 1e-17 && x > -1e-17) return 1;
  const double n = floor(x * 1.44269504088896338700e+00 + 0.5);
  const double high = x - n * 6.93147180369123816490e-01, low = n * 1.90821492927058770002e-10,
               r = high - low, t = r * r;
  const double c = r - t * (1.66666666666666019037e-01 +
                            t * (-2.77777777770155933842e-03 +
                                 t * (6.61375632143793436117e-05 +
                                      t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  return scale(1.0 - ((low - (r * c) / (2.0 - c)) - high), (int)n);
}

double log(double x) {
  if (is_nan(x) || x < 0) return nan_value();
  if (x == 0) return -infinity();
  parts p;
  p.value = x;
  if (p.high >= 0x7FF00000) return x;
  int k = (int)(p.high >> 20) - 1023;
  p.high = (p.high & 0xFFFFF) | 0x3FF00000;
  if (p.value > 1.4142135623730951) {
    p.high -= 1u << 20;
    ++k;
  }
  const double f = p.value - 1.0, s = f / (2.0 + f), z = s * s, w = z * z, half = 0.5 * f * f;
  const double r =
      w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01)) +
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  if (f == 0) return k * 6.93147180369123816490e-01 + k * 1.90821492927058770002e-10;
  return k * 6.93147180369123816490e-01 - ((half - (s * (half + r) + k * 1.90821492927058770002e-10)) - f);
}

double floor(double x) {
  parts p;
  p.value = x;
  const int exponent = (int)(p.high >> 20 & 0x7FF) - 1023;
  if (exponent >= 52) return x;
  if (exponent < 0) return x == 0 ? x : p.high >> 31 ? -1.0 : 0.0;
  if (exponent < 20) {
    p.high &= ~(0xFFFFFu >> exponent);
    p.low = 0;
  } else if (exponent > 20) {
    p.low &= ~(0xFFFFFFFFu >> (exponent - 20));
  } else {
    p.low = 0;
  }
  return p.value > x ? p.value - 1.0 : p.value;
}

float sinf(float x) { return (float)sin(x); }
float cosf(float x) { return (float)cos(x); }
float atan2f(float y, float x) {
  const double angle = atan2(y, x);
  return angle < 1.18e-38 && angle > -1.18e-38 ? 0 : (float)angle;
}
float expf(float x) {
  const double y = exp(x);
  return y < 1.1754945e-38 ? 0 : (float)y;
}
float logf(float x) { return (float)log(x); }
float floorf(float x) { return (float)floor(x); }
