#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/stats/run_object.h"
#include "sim/study/catalogue.h"
#include "sim/study/progress.h"
#include "sim/study/scene_file.h"

namespace dendro::study {

/// What the command line says about a run.
struct RunArguments {
  std::string scene;                  ///< built-in name or path
  std::string machine;                ///< NAME[:PRESET] or FILE.toml; empty: the scene's
  std::string level;                  ///< empty: the scene's, else cycle
  std::vector<std::string> settings;  ///< key=value
  std::optional<std::uint64_t> seed;
  MachineOptions options;
  bool use_cache = true;
};

/// A run with everything resolved; plain data, safe to copy into workers.
struct RunRequest {
  const Catalogue* catalogue = nullptr;
  SceneFile file;
  const Algorithm* algorithm = nullptr;
  const MachineType* type = nullptr;
  config::Preset preset;  ///< with the overrides of scene and command line in its parameters
  Level level = Level::kCycle;
  MachineOptions options;
  bool use_cache = true;  ///< take files that earlier runs prepared, and leave new ones
  bool with_picture =
      true;  ///< read the picture back and compare it; without, only time and counters are told
};

struct RunOutput {
  stats::RunObject object;
  /// With MachineOptions::activity: the phases in their order, each as often as it came, and samples of the counters.
  std::vector<Phase> phases;
  std::vector<ActivitySample> activity;
  std::vector<std::uint8_t> rgb;                              ///< the picture, 8-bit RGB, rows top down
  std::vector<std::pair<std::string, std::string>> inputs;    ///< absolute path, SHA-256
  std::vector<std::pair<std::string, std::string>> firmware;  ///< name, SHA-256
};

/// Ticks the processor may run in one start unless the user says otherwise: 2,000 s of an RDS-3000.
constexpr std::int64_t kDefaultTickLimit = 10'000'000'000;

/// Loads scene and machine. Throws UserError for everything that is wrong before a run starts.
RunRequest prepare_run(const Catalogue& catalogue, const RunArguments& arguments);

/// The level named, if the machine has it. Throws UserError at `where`.
Level level_of(const std::string& name, const MachineType& type, const config::Where& where = {"--level", 0});

/// Prepares the scene for its machine and throws UserError for all that a run would refuse. Throws away what
/// it made; no SystemC.
void check_run(const RunRequest& request);

/// One run in this process; pictures are written into `folder` unless it is empty. At levels with time this
/// elaborates SystemC: once per process. Throws UserError.
RunOutput execute(const RunRequest& request, const std::string& folder, Progress* progress);

/// Tells a visible progress line how many ticks the run will take, if a level that is exact and far faster can say so.
void expect_ticks(const RunRequest& request, Progress& progress);

/// execute() in a process of its own.
RunOutput execute_in_worker(const RunRequest& request, const std::string& folder, Progress* progress);

/// The words that a machine is to log: symbols that begin with mark_ or phase_.
std::map<std::uint32_t, std::string> marked_words(const std::map<std::string, std::uint32_t>& symbols);

/// The counters of a machine after its run; `seconds` is what the host took for it.
stats::RunObject describe_machine(const Machine& machine, double seconds);

/// A RunOutput as bytes, for pipes and caches, and back.
std::string to_bytes(const RunOutput& output);
RunOutput from_bytes(const std::string& bytes);

/// The text of resolved.toml: a complete scene that repeats the run. Paths become relative to `folder`.
std::string resolved_scene(const RunRequest& request, const RunOutput& output, const std::string& folder);

}  // namespace dendro::study
