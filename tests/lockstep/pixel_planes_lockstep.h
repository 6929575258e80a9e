#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"

/// Random command streams for both timed levels of Pixel-Planes, and what must be equal afterwards.
namespace dendro::pixel_planes {

using HostProgram = std::function<void(HostPort&, std::vector<std::int64_t>& seen)>;

struct Scenario {
  Spec spec;
  MachineOptions options;
  HostProgram program;  ///< writes into `seen` what it reads
};

/// Fails the calling test where the bits of any pixel differ; names stand for the two machines in messages.
void expect_same_pixels(const Machine& a, const Machine& b, const Spec& spec, const std::string& names);

/// Fails the calling test where clocks, counters, phases, pixels or pictures differ.
void expect_same(const Machine& cycle, const Machine& clocked, const Spec& spec);

/// Runs `cycle` and `clocked` in a child process and compares all that can be seen, and what the programs
/// read. `repeat` says how to repeat it.
void expect_lockstep(const Scenario& scenario, const std::string& repeat);

/// Each level ends in its line, or without an error.
void expect_errors(const Scenario& scenario, const std::string& cycle_says, const std::string& clocked_says);

/// Any parameters, 64 to 128 pixels a side.
Spec random_spec(std::mt19937_64& random);

/// Micro-programs of random words that set E, C and D before they use them, loaded and run with random
/// commands; with `renderers` on one to four of them, with a frame into which tiles are copied.
Scenario random_programs(std::uint64_t seed, bool renderers = false);

}  // namespace dendro::pixel_planes
