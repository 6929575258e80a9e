#pragma once

#include "models/machines/sgi_4d35/run_options.h"

namespace dendro::sgi_4d35 {

/// Level `clocked`: every clock edge is a SystemC event in which the pipeline, the caches, the write buffer
/// and memory move on by one clock. Written from the data sheets alone, as the referee of `cycle`. Ends when
/// a service stops the machine or after `limit` words. Throws UserError for a file that cannot be written.
ProgramResult run_clocked(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                          std::uint64_t limit, const RunOptions& options);

}  // namespace dendro::sgi_4d35
