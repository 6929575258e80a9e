#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware/lib/rds3000/rds_driver.h"
#include "sim/study/table_rows.h"

namespace dendro::study {

/// A shipped microprogram that a host program drives without a scene; it goes through the same workers, cache
/// and intervals as a scene's job.
struct Probe {
  using Facts = std::vector<std::pair<std::string, double>>;

  std::string name;     ///< another one for whatever else the host program does
  std::string machine;  ///< NAME or NAME:PRESET
  std::string program;  ///< path below the repository's root
  /// The host program; the microprogram is loaded. What it puts into the facts is found in the run's error
  /// report.
  std::function<void(HostPort&, lib::RdsDriver&, const lib::ProgramImage&, Facts&)> run;
  /// Words of the program to count (`function` only); may be empty.
  std::function<std::map<std::uint32_t, std::string>(const lib::ProgramImage&)> counted;
};

/// The probe as a run of the table's level, or of `level`. Throws UserError. The probe must outlive the
/// request.
class ProbeRequest {
 public:
  ProbeRequest(const TableContext& context, const Probe& probe, const std::string& level = "");
  /// Any job without a scene, on a machine NAME or NAME:PRESET.
  ProbeRequest(const TableContext& context, const std::string& name, const std::string& machine,
               std::function<std::unique_ptr<Job>(const config::ParameterSet&)> make, const std::string& level = "");
  ProbeRequest(const ProbeRequest&) = delete;

  const RunRequest& request() const { return request_; }

 private:
  Algorithm algorithm_;
  RunRequest request_;
};

/// At level `function`, from the cache if it is there: counted words and facts. Throws UserError.
stats::RunObject probe_counts(const TableContext& context, const Probe& probe);

/// At the table's level over every assumption. Throws UserError.
Propagated propagate_probe(const TableContext& context, const Probe& probe,
                           const std::vector<Metric>& metrics);

/// Executions counted under a name; 0 without it.
double executions(const stats::RunObject& run, const std::string& name);

}  // namespace dendro::study
