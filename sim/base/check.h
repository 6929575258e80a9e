#pragma once

#include <fmt/format.h>

#include <string>

namespace dendro::base {

/// Prints where and what to stderr and aborts. Never returns.
[[noreturn]] void check_failed(const char* file, int line, const char* condition, const std::string& values);

}  // namespace dendro::base

/// A bug in dendro, not in its input: stays on in release. Further arguments are a fmt format string and values.
#define DENDRO_CHECK(condition, ...)                                                                    \
  do {                                                                                                  \
    if (__builtin_expect(!(condition), 0))                                                              \
      ::dendro::base::check_failed(__FILE__, __LINE__, #condition, ::fmt::format("" __VA_ARGS__));      \
  } while (false)
