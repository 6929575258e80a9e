#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dendro::trace {

/// A timeline in the Chrome trace format, which Perfetto (ui.perfetto.dev) and chrome://tracing open. Times are
/// microseconds of the simulated machine.
class ChromeTrace {
 public:
  /// `process` heads the tracks.
  explicit ChromeTrace(std::string process) : process_(std::move(process)) {}

  /// Something that lasts, on the track of this name; tracks stand in the order of their first use.
  void span(const std::string& track, const std::string& name, double from_us, double length_us,
            const std::vector<std::pair<std::string, double>>& arguments = {});
  /// Something that happens at once.
  void instant(const std::string& track, const std::string& name, double at_us);
  /// From here on the counter has these values, drawn one above the other.
  void counter(const std::string& name, double at_us, const std::vector<std::pair<std::string, double>>& values);

  std::string json() const;

 private:
  int track(const std::string& name);

  std::string process_;
  std::vector<std::string> tracks_;
  std::vector<std::string> events_;
};

}  // namespace dendro::trace
