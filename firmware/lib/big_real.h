#pragma once

#include <mpfr.h>

namespace dendro::stability {

/// A real number of 128 bits, every operation rounded to nearest.
class BigReal {
 public:
  BigReal(double value = 0) {  // NOLINT: doubles are exact here
    mpfr_init2(value_, kBits);
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  BigReal(const BigReal& other) {
    mpfr_init2(value_, kBits);
    mpfr_set(value_, other.value_, MPFR_RNDN);
  }
  BigReal& operator=(const BigReal& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~BigReal() { mpfr_clear(value_); }

  double to_double() const { return mpfr_get_d(value_, MPFR_RNDN); }

  friend BigReal operator+(const BigReal& a, const BigReal& b) { return of(mpfr_add, a, b); }
  friend BigReal operator-(const BigReal& a, const BigReal& b) { return of(mpfr_sub, a, b); }
  friend BigReal operator*(const BigReal& a, const BigReal& b) { return of(mpfr_mul, a, b); }
  friend BigReal operator/(const BigReal& a, const BigReal& b) { return of(mpfr_div, a, b); }
  friend bool operator<(const BigReal& a, const BigReal& b) { return mpfr_less_p(a.value_, b.value_) != 0; }
  friend BigReal sqrt(const BigReal& a) { return of(mpfr_sqrt, a); }
  friend BigReal log(const BigReal& a) { return of(mpfr_log, a); }
  friend BigReal cos(const BigReal& a) { return of(mpfr_cos, a); }
  friend BigReal sin(const BigReal& a) { return of(mpfr_sin, a); }
  friend BigReal asin(const BigReal& a) { return of(mpfr_asin, a); }
  friend BigReal acos(const BigReal& a) { return of(mpfr_acos, a); }
  friend BigReal atan2(const BigReal& y, const BigReal& x) { return of(mpfr_atan2, y, x); }
  friend BigReal floor(const BigReal& a) {
    BigReal result;
    mpfr_floor(result.value_, a.value_);
    return result;
  }
  friend BigReal abs(const BigReal& a) { return of(mpfr_abs, a); }
  static BigReal pi() {
    BigReal result;
    mpfr_const_pi(result.value_, MPFR_RNDN);
    return result;
  }

 private:
  static constexpr mpfr_prec_t kBits = 128;

  template <typename F>
  static BigReal of(F function, const BigReal& a, const BigReal& b) {
    BigReal result;
    function(result.value_, a.value_, b.value_, MPFR_RNDN);
    return result;
  }
  template <typename F>
  static BigReal of(F function, const BigReal& a) {
    BigReal result;
    function(result.value_, a.value_, MPFR_RNDN);
    return result;
  }

  mpfr_t value_;
};

}  // namespace dendro::stability
