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

/// Everything but the pixels, as "name value".
std::vector<std::string> outcome(const Machine& machine, const std::vector<std::int64_t>& seen);

/// Runs `cycle` and `clocked` in a child process and compares all bits of all pixels, clocks, counters, phases, picture.
/// Fails the calling test with the first difference; `repeat` says how to repeat it.
void expect_lockstep(const Scenario& scenario, const std::string& repeat);

/// Any parameters, 64 to 128 pixels a side.
Spec random_spec(std::mt19937_64& random);

/// Micro-programs of random words that set E, C and D before they use them, loaded and run with random commands.
Scenario random_programs(std::uint64_t seed);

}  // namespace dendro::pixel_planes
