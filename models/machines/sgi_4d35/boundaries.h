#pragma once

#include <vector>

#include "models/machines/machine.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/trace/trace_file.h"

namespace dendro::sgi_4d35 {

constexpr const char* kMemoryBoundary = "sgi_4d35.memory";
constexpr const char* kProcessorBoundary = "sgi_4d35.processor";

/// The longest block of a cache, in words.
constexpr unsigned kMostBlockWords = 32;

/// The operations of each boundary: docs/formats.md says what they mean.
std::vector<trace::Boundary> boundaries();

/// Drives write buffer and memory, or these and the caches, alone. Level is cycle or clocked.
trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace);

trace::ReplayResult replay_memory(const Spec& spec, Level level, trace::Reader& trace);
trace::ReplayResult replay_processor(const Spec& spec, Level level, trace::Reader& trace);

/// Drives caches, write buffer and memory with a memory trace from elsewhere. Level is cycle or clocked.
PlainReplay replay_plain(const Spec& spec, Level level, trace::PlainReader& trace);

/// `w1` for the second word of a block.
std::string word_key(unsigned word);

/// The counters that a record `counters` checks, by their keys; of the memory's boundary those from `reads` on.
std::vector<std::pair<const char*, std::uint64_t>> counter_keys(const Counters& counters, bool with_caches);

}  // namespace dendro::sgi_4d35
