#pragma once

#include <vector>

#include "models/machines/machine.h"
#include "models/machines/rds3000/rds3000_spec.h"
#include "sim/trace/trace_file.h"

namespace dendro::rds3000 {

constexpr const char* kFrameMemoryBoundary = "rds3000.frame_memory";
constexpr const char* kProcessorBoundary = "rds3000.processor";
constexpr const char* kHostBoundary = "rds3000.host";

/// The operations of each boundary: docs/formats.md says what they mean.
std::vector<trace::Boundary> boundaries();

/// Drives the unit of the trace's boundary alone. Level is cycle or clocked; the host, which is one model at both,
/// elaborates SystemC.
trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace);

trace::ReplayResult replay_memory(const Spec& spec, Level level, trace::Reader& trace);
trace::ReplayResult replay_processor(const Spec& spec, Level level, trace::Reader& trace);
trace::ReplayResult replay_host(const Spec& spec, trace::Reader& trace);

}  // namespace dendro::rds3000
