#pragma once

#include <string>
#include <utility>
#include <vector>

#include "firmware/half_space/host/prepare_hulls.h"

namespace dendro::half_space {

/// Job::facts() of hulls and trunks.
std::vector<std::pair<std::string, double>> hulls_facts(const PreparedHulls& prepared);

}  // namespace dendro::half_space
