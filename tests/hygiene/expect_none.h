#pragma once

#include <gtest/gtest.h>

#include "tests/hygiene/repository.h"

namespace dendro::hygiene {

/// Fails once for each problem.
inline void expect_none(const Problems& problems) {
  for (const std::string& problem : problems) ADD_FAILURE() << problem;
}

}  // namespace dendro::hygiene
