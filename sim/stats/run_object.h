#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What one run produced, as plain data, and its written forms.
namespace dendro::stats {

struct PhaseRow {
  std::string name;
  std::int64_t cycles = 0;
  double seconds = 0;
  bool on_host = false;
};

/// A unit's counters; the first is `cycles`; `busy`, every `stall_*` and `idle` add up to it.
struct UnitRow {
  std::string unit;
  std::vector<std::pair<std::string, std::uint64_t>> values;
};

struct ImageInfo {
  std::string path;
  int width = 0;
  int height = 0;
  std::string sha256;  ///< of the 8-bit RGB pixels, rows top down
};

struct ErrorInfo {
  std::string reference;
  std::optional<double> psnr_db;  ///< none: identical
  double max_depth_error = 0;     ///< register units
  std::int64_t wrong_pixels = 0;
  std::int64_t covered_pixels = 0;
  std::vector<std::pair<std::string, double>> extra;
};

struct HostInfo {
  double seconds = 0;
  double simulated_hz = 0;  ///< ticks with the machine running per host second
  double real_time_factor = 0;
  std::int64_t peak_rss_bytes = 0;
};

/// How far one assumption alone moves the run's time.
struct Contribution {
  std::string key;
  double low = 0;  ///< seconds
  double high = 0;
  std::string source;
};

struct RunObject {
  std::string scene, algorithm, machine, preset, level;
  std::uint64_t seed = 1;
  std::int64_t cycles = 0;  ///< 0 at `function`, where there is no time: null in JSON, as are the seconds
  double clock_hz = 0;
  double seconds = 0;
  std::optional<double> seconds_low, seconds_high;
  std::vector<Contribution> contributions;  ///< widest first
  std::vector<std::string> interval_notes;  ///< what the interval had to leave out
  std::vector<PhaseRow> phases;
  std::vector<UnitRow> units;
  ImageInfo image;
  ErrorInfo error;
  HostInfo host;
  std::vector<std::string> elaborated;
  std::vector<std::string> assumptions;
  std::vector<std::string> notes;  ///< what a reader of the run should know, a line each
  std::int64_t machine_cycles = 0;
  std::uint64_t instructions = 0;
  bool time_dependent = false;
  std::vector<std::pair<std::string, double>> facts;
  std::vector<std::pair<std::string, std::int64_t>> marks;  ///< name, tick
  std::vector<std::pair<std::string, std::uint64_t>> executions;

  bool has_time() const { return level != "function"; }
};

/// What level `estimate` says of its sampling, the counters `low` and `high` of a unit, as the run's 99.7 % interval.
void add_sampling_interval(RunObject& run);

/// Stops dendro when the counters contradict themselves: a unit whose busy, stall and idle ticks do not add
/// up to its cycles, phases that do not add up to the run, or more machine time than time.
void check_sanity(const RunObject& run);

/// The unit that was busy for the largest share of its cycles, and that share: the bottleneck, if there is one. Nothing for a
/// run without time.
std::optional<std::pair<std::string, double>> busiest_unit(const RunObject& run);

/// The run object of the contract (schema 1).
std::string to_json(const RunObject& run);

/// Reads back what to_json wrote. Throws std::exception for anything else.
RunObject from_json(const std::string& text);

/// name,value lines: `phase.NAME.cycles`, `UNIT.COUNTER`, and the figures of the run.
std::string to_csv(const RunObject& run);

/// Every number of a run by its name in to_csv(), phases of one name added up, and `fact.NAME`. An identical picture
/// has no `error.psnr_db`.
std::vector<std::pair<std::string, double>> figures(const RunObject& run);

/// The summary that `dendro run` prints.
std::string to_summary(const RunObject& run);

/// Ticks grouped by thousands: "60,123,456".
std::string grouped(std::int64_t number);

/// Seconds in a unit that reads well: "12.02 s", "3.1 ms".
std::string readable_seconds(double seconds);

}  // namespace dendro::stats
