#pragma once

#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"
#include "models/parts/igc/igc_isa.h"
#include "sim/trace/trace_file.h"

namespace dendro::pixel_planes {

constexpr const char* kCommandsBoundary = "pixel_planes.commands";
constexpr const char* kArrayBoundary = "pixel_planes.array";

/// The operations of each boundary: docs/formats.md says what they mean.
std::vector<trace::Boundary> boundaries();

/// Drives the unit of the trace's boundary alone. Level is cycle or clocked.
trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace);

trace::ReplayResult replay_commands(const Spec& spec, Level level, trace::Reader& trace);
trace::ReplayResult replay_array(const Spec& spec, Level level, trace::Reader& trace);

/// The array word of a record `word`, and back.
igc::ArrayWord word_of(const trace::Record& record);
trace::Keys keys_of(const igc::ArrayWord& word);

/// The words of the FIFO of a record `command` or `register`, and the record of a whole command without its times: one
/// that no such record can say, because it has bits that nothing reads, becomes `word`s instead and gives false.
std::vector<std::uint32_t> fifo_words_of(const trace::Record& record);
bool record_of(const std::vector<std::uint32_t>& fifo_words, trace::Record& record);

/// All bits of all pixels, plane by plane from bit 0.
std::uint64_t digest_of(const std::vector<Plane>& planes);
std::int64_t ones_of(const Plane& plane);

}  // namespace dendro::pixel_planes
