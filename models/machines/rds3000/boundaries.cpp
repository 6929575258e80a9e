#include "models/machines/rds3000/boundaries.h"

#include "models/machines/rds3000/recorder.h"
#include "sim/base/check.h"

namespace dendro::rds3000 {
namespace {

using trace::Op;

std::vector<std::string> register_names(bool with_digest) {
  ProcessorState state;
  std::vector<std::string> names;
  for_each_register(state, [&](const char* name, const auto&) { names.emplace_back(name); });
  if (with_digest) names.emplace_back("scratch");
  return names;
}

trace::Boundary frame_memory() {
  return {kFrameMemoryBoundary,
          {{"read", 1, 1, {"fn"}, true, true, {"wait"}},
           {"write", 2, 2, {"fn"}, true, false, {"wait"}},
           {"display", 2, 2, {}, false, false, {}},
           {"contents", 0, 0, {}, false, false, {"digest"}},
           {"pixel", 1, 1, {}, false, true, {}},
           {"set_pixel", 2, 2, {"count"}, false, false, {}},
           {"set_mask", 2, 2, {}, false, false, {}},
           {"set_display", 2, 2, {}, false, false, {}},
           {"set_card", 1, 1, {"free"}, false, false, {}},
           {"set_events", 0, 0, {"refresh_ps", "fetch_ps", "origin_ps"}, false, false, {}}}};
}

trace::Boundary processor() {
  return {kProcessorBoundary,
          {{"read", 1, 2, {"fn", "takes"}, true, false, {}},
           {"write", 1, 1, {"fn", "takes"}, true, true, {}},
           {"host_read", 1, 1, {}, false, true, {}},
           {"host_write", 2, 2, {}, false, false, {}},
           {"run", 0, 0, {}, false, false, {}},
           {"reset", 0, 0, {}, false, false, {}},
           {"stop", 0, 0, {}, false, false, {}},
           {"halted", 0, 0, {}, true, false, {}},
           {"registers", 0, 0, {}, false, false, register_names(true)},
           {"scratch", 1, 1, {}, false, true, {}},
           {"display", 0, 0, {"origin_ps", "line_ps", "field_lines", "blank_lines"}, false, false, {}},
           {"set", 0, 0, register_names(false), false, false, {}},
           {"set_control", 2, 2, {"count"}, false, false, {}},
           {"set_scratch", 2, 2, {"count"}, false, false, {}}}};
}

trace::Boundary host() {
  return {kHostBoundary,
          {{"start", 0, 0, {"ps"}, false, false, {}},
           {"compute", 0, 0, {"flops", "instructions", "program_loads"}, false, false, {}},
           {"read", 1, 1, {"fn"}, false, true, {}},
           {"write", 2, 2, {"fn"}, false, false, {}},
           {"dma_to", 1, 1, {"count", "fn", "step"}, false, false, {}},
           {"dma_from", 1, 1, {"count", "fn", "step"}, false, false, {}},
           {"bus_read", 2, 2, {"fn", "takes"}, true, false, {}},
           {"bus_write", 2, 2, {"fn", "takes"}, true, false, {}},
           {"command", 1, 1, {}, true, false, {}},
           {"wait_interrupt", 0, 0, {"at", "takes"}, false, false, {}},
           {"end", 0, 0, {}, true, false, {"ps"}}}};
}

}  // namespace

std::vector<trace::Boundary> boundaries() { return {frame_memory(), processor(), host()}; }

trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace) {
  const std::string& name = trace.header().boundary;
  if (name == kFrameMemoryBoundary) return replay_memory(spec, level, trace);
  if (name == kProcessorBoundary) return replay_processor(spec, level, trace);
  DENDRO_CHECK(name == kHostBoundary, "{}", name);
  return replay_host(spec, trace);
}

}  // namespace dendro::rds3000
