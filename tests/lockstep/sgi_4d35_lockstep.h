#pragma once

#include <string>
#include <vector>

#include "models/machines/sgi_4d35/run_options.h"

namespace dendro::sgi_4d35 {

/// What a level leaves of a run.
struct Outcome {
  ProgramResult result;
  std::vector<Retired> retired;
  r3000::State state;
};

/// With `log` the words that left MEM too.
Outcome run(Level level, const Spec& spec, const ProgramImage& image, service_block::Services& services,
            std::uint64_t limit, bool log);

/// The first word, counter or register in which two levels differ; empty if none. Logs count where both have one.
std::string difference(const Outcome& a, const Outcome& b);

}  // namespace dendro::sgi_4d35
