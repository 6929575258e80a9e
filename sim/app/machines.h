#pragma once

#include <vector>

#include "models/machines/machine.h"

namespace dendro::app {

/// The one list of machines.
const std::vector<MachineType>& machines();

}  // namespace dendro::app
