#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>

#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

const std::string kConfigValues = "sim/config/parameters.h";  // values only: nothing in it reads a file

/// What the files of one folder may include: prefixes of paths.
using Allowed = std::vector<std::string>;

std::string first_folders(const std::string& path, int count) {
  std::size_t at = 0;
  for (int i = 0; i < count; ++i) {
    at = path.find('/', at);
    if (at == std::string::npos) return path;
    ++at;
  }
  return path.substr(0, at);
}

bool is_shell(const std::string& path) { return path.find("_shell.") != std::string::npos; }

Allowed allowed_in_parts(const std::string& path) {
  Allowed allowed = {"models/parts/", "sim/base/", "sim/stats/", "sim/trace/"};
  if (is_shell(path)) allowed.push_back("sim/tlm/");
  return allowed;
}

Allowed allowed_in_machines(const std::string& path) {
  const std::string machine = first_folders(path, 3);  // the file itself when it lies beside the machines
  return {machine, "models/machines/machine.h", "models/machines/debuggee.h", "models/parts/", "sim/base/", "sim/stats/", "sim/trace/", "sim/tlm/",
          kConfigValues};
}

/// Empty: everything is allowed.
Allowed allowed_in(const std::string& path) {
  if (starts_with(path, "sim/base/")) return {"sim/base/"};
  for (const char* folder : {"sim/config/", "sim/stats/", "sim/trace/", "sim/scene/", "sim/tlm/"})
    if (starts_with(path, folder)) return {folder, "sim/base/"};
  if (starts_with(path, "models/parts/")) return allowed_in_parts(path);
  if (starts_with(path, "models/machines/")) return allowed_in_machines(path);
  if (starts_with(path, "firmware/tools/")) return {"firmware/tools/", "models/parts/", "sim/base/"};
  if (starts_with(path, "firmware/"))
    return {first_folders(path, 2), "firmware/lib/", "firmware/job.h", "sim/base/", "sim/scene/", "models/parts/host/host_port.h"};
  if (starts_with(path, "sim/study/")) return {"sim/", "firmware/", "models/parts/", "models/machines/machine.h",
            "models/machines/debuggee.h"};
  return {};
}

/// Encodings and their text form are what a part shares with the assemblers.
bool is_isa(const std::string& include) { return ends_with(include, "_isa.h") || ends_with(include, "_disasm.h"); }

bool may_include(const std::string& path, const std::string& include) {
  if (starts_with(include, "tests/")) return starts_with(path, "tests/");
  if (starts_with(include, "sim/app/")) return starts_with(path, "sim/app/") || starts_with(path, "tests/");
  if (starts_with(path, "firmware/tools/") && starts_with(include, "models/")) return is_isa(include);
  const bool core_includes_shell = is_shell(include) && starts_with(path, "models/parts/") && !is_shell(path);
  if (core_includes_shell) return false;
  const Allowed allowed = allowed_in(path);
  return allowed.empty() ||
         std::any_of(allowed.begin(), allowed.end(), [&](const std::string& start) { return starts_with(include, start); });
}

template <typename Report>
void search(const std::string& text, const std::regex& pattern, const Report& report) {
  int number = 0;
  for (const std::string& line : lines_of(text)) {
    ++number;
    std::smatch match;
    if (std::regex_search(line, match, pattern)) report(number, match);
  }
}

}  // namespace

Problems systemc_outside_its_places(const Repository& repository) {
  static const std::regex kSystemC(R"(\bsc_core\b|\bSC_(MODULE|METHOD|THREAD)\b|#include\s*[<"](systemc|tlm)\b)");
  static const char* const kPlaces[] = {"sim/tlm/",    "models/machines/", "sim/study/",     "sim/app/",
                                        "tests/shell/", "tests/support/",  "tests/lockstep/", "tests/hygiene/", "tests/bench.cpp"};
  Problems problems;
  for (const auto& [path, text] : repository.files) {
    const std::string& file = path;
    if (!is_code(file) || is_shell(file)) continue;
    if (std::any_of(std::begin(kPlaces), std::end(kPlaces), [&](const char* p) { return starts_with(file, p); })) continue;
    search(text, kSystemC, [&](int line, const std::smatch& match) {
      problems.push_back(fmt::format("{}:{}: SystemC (`{}`) has no place here", file, line, match.str()));
    });
  }
  return problems;
}

Problems forbidden_includes(const Repository& repository) {
  static const std::regex kInclude(R"re(^#include "([^"]+)")re");
  Problems problems;
  for (const auto& [path, text] : repository.files) {
    const std::string& file = path;
    if (!is_code(file)) continue;
    search(text, kInclude, [&](int line, const std::smatch& match) {
      const std::string include = match[1];
      if (include.find('/') == std::string::npos)
        problems.push_back(fmt::format("{}:{}: \"{}\" does not start at the root, so it hides its arrow", file, line, include));
      else if (!may_include(file, include))
        problems.push_back(fmt::format("{}:{}: this folder may not know {}", file, line, include));
    });
  }
  return problems;
}

Problems firmware_known_by_name(const Repository& repository) {
  std::set<std::string> names;
  for (const auto& [path, text] : repository.files)
    if (starts_with(path, "firmware/") && ends_with(path, "/README.md") && first_folders(path, 2) + "README.md" == path)
      names.insert(first_folders(path, 2).substr(9, first_folders(path, 2).size() - 10));
  names.erase("tools");
  names.erase("lib");
  Problems problems;
  for (const auto& [path, text] : repository.files) {
    if (!is_code(path) || starts_with(path, "sim/study/")) continue;
    if (!starts_with(path, "models/") && !starts_with(path, "sim/")) continue;
    int number = 0;
    for (const std::string& line : lines_of(text)) {
      ++number;
      const std::string code = line.substr(0, line.find("//"));
      for (const std::string& name : names)
        if (code.find(name) != std::string::npos)
          problems.push_back(fmt::format("{}:{}: knows the firmware {}", path, number, name));
    }
  }
  return problems;
}

Problems world_read_by_models(const Repository& repository) {
  static const std::regex kWorld(
      R"(\b(getenv|secure_getenv|system_clock|steady_clock|high_resolution_clock|random_device|gettimeofday|clock_gettime|ifstream|fopen)\b|#include\s*<(toml\+\+|nlohmann|filesystem|chrono))");
  Problems problems;
  for (const auto& [path, text] : repository.files) {
    const std::string& file = path;
    if (!is_code(file) || !starts_with(file, "models/")) continue;
    search(text, kWorld, [&](int line, const std::smatch& match) {
      problems.push_back(fmt::format("{}:{}: a model does not look at the world (`{}`)", file, line, match.str()));
    });
  }
  return problems;
}

}  // namespace dendro::hygiene
