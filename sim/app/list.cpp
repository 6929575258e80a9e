#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/study/scene_file.h"

namespace dendro::app {
namespace {

/// The unit that a parameter's name ends in.
std::string unit_of(const std::string& key) {
  static const std::pair<const char*, const char*> kUnits[] = {{"_ticks", "ticks"},
                                                               {"_cycles", "clocks"},
                                                               {"_ns", "ns"},
                                                               {"_us", "us"},
                                                               {"_ms", "ms"},
                                                               {"_mb_s", "MB/s"},
                                                               {"_m_s", "million/s"},
                                                               {"_hz", "Hz"},
                                                               {"_bytes", "bytes"},
                                                               {"_bits", "bits"},
                                                               {"_words", "words"},
                                                               {"_entries", "entries"},
                                                               {"bits_per_pixel", "bits"},
                                                               {"_s", "s"}};
  for (const auto& [suffix, unit] : kUnits) {
    const std::string end = suffix;
    if (key.size() >= end.size() && key.compare(key.size() - end.size(), end.size(), end) == 0) return unit;
  }
  return "";
}

std::string range_of(const config::Parameter& p) {
  if (!p.spread) return p.follows.empty() ? "" : "as " + p.follows;
  std::string text;
  if (p.spread->low) {
    text = fmt::format("{:.10g} to {:.10g}{}", *p.spread->low, *p.spread->high,
                       p.spread->logarithmic ? " (log)" : "");
  } else {
    for (const config::Value& choice : p.spread->choices)
      text += (text.empty() ? "" : " | ") + config::to_text(choice);
  }
  return p.follows.empty() ? text : text + ", as " + p.follows;
}

int list_scenes(const study::Catalogue& catalogue) {
  for (const study::BuiltInScene& scene : study::built_in_scenes(catalogue))
    fmt::print("{:<16} {:<14} {:<16} {}\n", scene.name, scene.algorithm, scene.machine, scene.description);
  return kGood;
}

int list_machines(const study::Catalogue& catalogue) {
  for (const MachineType& machine : catalogue.machines) {
    std::string levels;
    for (const Level level : machine.levels)
      levels += (levels.empty() ? "" : ", ") + std::string(level_name(level));
    fmt::print("{}  {}\n  levels: {}\n", machine.name, machine.summary, levels);
    for (const std::string& preset : machine.presets) {
      const auto loaded = config::load_preset(machine.name + ":" + preset, catalogue.presets(), {});
      fmt::print("  {}:{}  {}\n", machine.name, preset, loaded.description);
    }
  }
  return kGood;
}

int print_machine(const study::Catalogue& catalogue, const std::string& name) {
  const config::Preset preset = config::load_preset(name, catalogue.presets(), {});
  fmt::print("{}:{}  {}\n", preset.machine, preset.name, preset.description);
  fmt::print("{:<38} {:>12}  {:<34} {:<10} {}\n", "parameter", "value", "range", "unit", "source");
  for (const config::Parameter& p : preset.parameters.all())
    fmt::print("{:<38} {:>12}  {:<34} {:<10} {}\n", p.key, config::to_text(p.value), range_of(p),
               unit_of(p.key), p.source);
  return kGood;
}

int list_firmware() {
  for (const study::Firmware& firmware : study::firmware_list())
    fmt::print("{:<14} {:<10} pack {:<5} {:>5} words  {}  {}\n", firmware.name, firmware.machine,
               firmware.pack, firmware.words, firmware.sha256.substr(0, 16), firmware.path);
  return kGood;
}

}  // namespace

void add_lists(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  app.add_subcommand("scenes", "list the built-in scenes")->callback([&] {
    action = [&] { return list_scenes(catalogue); };
  });
  app.add_subcommand("firmware", "list the microprograms that ship with dendro")->callback([&] {
    action = list_firmware;
  });
  const auto name = std::make_shared<std::string>();
  CLI::App* machines =
      app.add_subcommand("machines", "list the machines, or one preset's parameters with their sources");
  machines->add_option("name", *name, "NAME[:PRESET] or FILE.toml");
  machines->callback([&, name] {
    action = [&catalogue, name] {
      return name->empty() ? list_machines(catalogue) : print_machine(catalogue, *name);
    };
  });
}

}  // namespace dendro::app
