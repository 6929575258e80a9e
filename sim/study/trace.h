#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/scene/image_io.h"
#include "sim/study/exec.h"
#include "sim/study/run.h"
#include "sim/trace/trace_file.h"

namespace dendro::study {

/// What to record: a scene, or a program on a machine; always at level cycle.
struct RecordArguments {
  RunArguments run;        ///< for a scene; `run.scene` is empty for a program
  ExecArguments exec;      ///< for a program
  std::string boundary;    ///< "rds3000.frame_memory"
  std::int64_t from = 0, to = INT64_MAX;  ///< ticks
  bool as_text = false;
};

struct Recorded {
  std::string bytes;  ///< of the trace file
  std::int64_t records = 0;
};

/// Records in a worker process. Throws UserError.
Recorded record_trace(const Catalogue& catalogue, const RecordArguments& arguments, Progress* progress);

struct ReplayArguments {
  std::string trace;  ///< path
  std::string level = "cycle";
  std::vector<std::string> settings;  ///< key=value on top of the trace's parameters
  std::string boundary = {};  ///< of a memory trace from elsewhere; empty: a trace of dendro's, which says its own
};

struct ReplayOutput {
  std::string unit, machine, level;
  trace::ReplayResult result;
  std::vector<UnitStats> units;      ///< of a memory trace from elsewhere
  std::vector<std::string> summary;  ///< the same for people
};

/// Opens a trace and checks all of its records against its boundary. Throws UserError.
std::unique_ptr<trace::Reader> open_trace(const Catalogue& catalogue, const std::string& path);

/// Drives the unit alone, in a worker process. Throws UserError.
ReplayOutput replay_trace(const Catalogue& catalogue, const ReplayArguments& arguments);

/// A bar for every operation of a trace that takes time, from the tick of its record to its completion, as the trace says;
/// a row for each kind. Long traces: the beginning.
scene::RgbImage trace_picture(trace::Reader& trace, const trace::Boundary& boundary);
/// The same of a file. Throws UserError.
scene::RgbImage trace_picture(const Catalogue& catalogue, const std::string& path);

std::string replay_json(const ReplayOutput& output);

}  // namespace dendro::study
