#pragma once

#include <cstdint>

#include "models/machines/machine.h"
#include "models/parts/r3000/r3000_state.h"

namespace dendro::sgi_4d35 {

struct Spec {
  r3000::Spec processor;
  double clock_hz = 0;
  std::uint32_t main_bytes = 0;
};

/// Checks the parameters. Throws UserError.
Spec resolve(const config::ParameterSet& parameters);

/// The SGI 4D/35 [MO95 8] as an entry of the list of machines. So far at `function`, for programs.
MachineType sgi_4d35_type();

}  // namespace dendro::sgi_4d35
