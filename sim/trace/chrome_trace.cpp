#include "sim/trace/chrome_trace.h"

#include <fmt/format.h>

#include <algorithm>

namespace dendro::trace {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string arguments_of(const std::vector<std::pair<std::string, double>>& values) {
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", quoted(name), value);
  return "{" + text + "}";
}

}  // namespace

int ChromeTrace::track(const std::string& name) {
  const auto found = std::find(tracks_.begin(), tracks_.end(), name);
  if (found != tracks_.end()) return static_cast<int>(found - tracks_.begin()) + 1;
  tracks_.push_back(name);
  return static_cast<int>(tracks_.size());
}

void ChromeTrace::span(const std::string& track_name, const std::string& name, double from_us, double length_us,
                       const std::vector<std::pair<std::string, double>>& arguments) {
  events_.push_back(fmt::format(R"({{"ph":"X","pid":1,"tid":{},"name":{},"ts":{},"dur":{},"args":{}}})",
                                track(track_name), quoted(name), from_us, length_us, arguments_of(arguments)));
}

void ChromeTrace::instant(const std::string& track_name, const std::string& name, double at_us) {
  events_.push_back(fmt::format(R"({{"ph":"i","s":"t","pid":1,"tid":{},"name":{},"ts":{}}})", track(track_name),
                                quoted(name), at_us));
}

void ChromeTrace::counter(const std::string& name, double at_us,
                          const std::vector<std::pair<std::string, double>>& values) {
  events_.push_back(fmt::format(R"({{"ph":"C","pid":1,"name":{},"ts":{},"args":{}}})", quoted(name), at_us,
                                arguments_of(values)));
}

std::string ChromeTrace::json() const {
  std::string text = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
  text += fmt::format(R"({{"ph":"M","pid":1,"name":"process_name","args":{{"name":{}}}}})", quoted(process_));
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    text += fmt::format(",\n" R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":{}}}}})", i + 1,
                        quoted(tracks_[i]));
  for (const std::string& event : events_) text += ",\n" + event;
  return text + "\n]}\n";
}

}  // namespace dendro::trace
