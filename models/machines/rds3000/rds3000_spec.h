#pragma once

#include "models/parts/bps32/bps32_spec.h"
#include "models/parts/dr64/dr64_spec.h"
#include "models/parts/ik11b/ik11b_spec.h"
#include "models/parts/video/video.h"
#include "sim/config/parameters.h"

namespace dendro::rds3000 {

using bps32::BusSpec;
using bps32::ProcessorSpec;
using ik11b::HostSpec;

/// Everything fixed for a run of an RDS-3000.
struct Spec {
  ProcessorSpec processor;
  BusSpec bus;
  dr64::Spec memory;
  video::Spec video;
  HostSpec host;
};

/// Reads all parameters. Throws UserError for missing, unknown or impossible ones.
Spec resolve(const config::ParameterSet& parameters);

}  // namespace dendro::rds3000
