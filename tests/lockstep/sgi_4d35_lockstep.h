#pragma once

#include <string>

#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {

/// Level `cycle` in this process, without the log of words: as fast as it can.
Ran run_unlogged(const Spec& spec, const ProgramImage& image, std::uint64_t limit);

/// The first word, counter, register or the memory in which two runs differ; empty if none. Logs count where both have
/// one.
std::string difference(const Ran& a, const Ran& b);

}  // namespace dendro::sgi_4d35
