#pragma once

#include "models/machines/machine.h"

namespace dendro::rds3000 {

/// The Adage RDS-3000 of FG86: presets fg86, 32-bit, 48-bit, big-store; levels function, cycle, clocked.
MachineType rds3000_type();

}  // namespace dendro::rds3000
