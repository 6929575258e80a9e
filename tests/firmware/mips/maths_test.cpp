#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

double real(std::uint64_t bits, bool single) {
  if (single) {
    const auto narrow = static_cast<std::uint32_t>(bits);
    float value;
    std::memcpy(&value, &narrow, 4);
    return value;
  }
  double value;
  std::memcpy(&value, &bits, 8);
  return value;
}

/// |result - exact| in units of the last place of the exact value's binade.
double ulps(const std::string& name, double x, double y, double result, bool single) {
  mpfr_t a, b, exact;
  mpfr_inits2(300, a, b, exact, nullptr);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_set_d(b, y, MPFR_RNDN);
  if (name == "sqrt")
    mpfr_sqrt(exact, a, MPFR_RNDN);
  else if (name == "sin")
    mpfr_sin(exact, a, MPFR_RNDN);
  else if (name == "cos")
    mpfr_cos(exact, a, MPFR_RNDN);
  else if (name == "atan2")
    mpfr_atan2(exact, a, b, MPFR_RNDN);
  else if (name == "exp")
    mpfr_exp(exact, a, MPFR_RNDN);
  else if (name == "log")
    mpfr_log(exact, a, MPFR_RNDN);
  else if (name == "floor")
    mpfr_floor(exact, a);
  else
    ADD_FAILURE() << name;
  double error = 0;
  if (mpfr_zero_p(exact)) {
    error = result == 0 ? 0 : 1e9;
  } else {
    const long unit = mpfr_get_exp(exact) - (single ? 24 : 53);
    mpfr_sub_d(exact, exact, result, MPFR_RNDN);
    mpfr_mul_2si(exact, exact, -unit, MPFR_RNDN);
    error = std::fabs(mpfr_get_d(exact, MPFR_RNDN));
  }
  mpfr_clears(a, b, exact, nullptr);
  return error;
}

TEST(MipsMaths, ErrorsStayBelowWhatTheHeaderSays) {
  const std::map<std::string, double> bounds = {
      {"sqrt", 1},  {"sin", 1},  {"cos", 1},  {"atan2", 2},  {"exp", 1},  {"log", 1},  {"floor", 0},
      {"fsqrt", 1}, {"fsin", 1}, {"fcos", 1}, {"fatan2", 1}, {"fexp", 1}, {"flog", 1}, {"ffloor", 0}};
  const Ran ran = run(qemu(elf("maths"), "3000"));
  ASSERT_EQ(0, ran.status);
  std::istringstream lines(ran.output);
  std::map<std::string, double> worst;
  std::map<std::string, int> count;
  std::string name;
  std::uint64_t x, y, result;
  while (lines >> name >> std::hex >> x >> y >> result) {
    ASSERT_TRUE(bounds.count(name)) << name;
    const bool single = name[0] == 'f' && name != "floor";
    const double error =
        ulps(single ? name.substr(1) : name, real(x, single), real(y, single), real(result, single), single);
    ASSERT_LE(error, bounds.at(name))
        << name << " " << real(x, single) << " " << real(y, single) << " gives " << real(result, single);
    worst[name] = std::max(worst[name], error);
    ++count[name];
  }
  EXPECT_EQ(bounds.size(), count.size());
  for (const auto& [function, error] : worst)
    std::printf("%-7s %6d values, worst %.3f ulp\n", function.c_str(), count[function], error);
}

}  // namespace
}  // namespace dendro::mips
