#include "sim/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace dendro::base {

void check_failed(const char* file, int line, const char* condition, const std::string& values) {
  std::fprintf(stderr, "dendro: bug: %s:%d: %s: %s\n", file, line, condition, values.c_str());
  std::_Exit(70);
}

}  // namespace dendro::base
