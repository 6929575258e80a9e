#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/document.h"
#include "sim/scene/scene.h"
#include "sim/study/catalogue.h"

namespace dendro::study {

/// A digest that a repeated run insists on.
struct PinnedDigest {
  std::string name;  ///< absolute path of an input, or name of a firmware
  std::string sha256;
  config::Where where;
};

/// A scene file with all it includes and all settings of the command line, checked for form.
struct SceneFile {
  scene::Scene scene;
  config::Where machine_where;
  std::string preset_label;          ///< the preset's name in reports, when the file says so
  std::optional<std::string> level;  ///< the file's own
  config::Where level_where;
  std::string build;  ///< digest of the dendro that resolved the scene, or empty
  std::vector<std::pair<std::string, config::Node>>
      parameters;  ///< machine parameters: plain values and whole entries
  std::vector<PinnedDigest> inputs;
  std::vector<PinnedDigest> firmware;
  config::Node document;  ///< everything as one table, paths absolute
};

struct BuiltInScene {
  std::string name;
  std::string path;  ///< embedded
  std::string algorithm;
  std::string machine;
  std::string description;
};

/// The scenes that ship with dendro, by name.
std::vector<BuiltInScene> built_in_scenes(const Catalogue& catalogue);

/// Loads a built-in scene by name or a scene file by path and applies `key=value` settings in their order.
/// Throws UserError with file:line and key for unknown keys (with the nearest known one), impossible values,
/// and includes that are missing or go round in a circle.
SceneFile load_scene(const std::string& name, const std::vector<std::string>& settings,
                     const Catalogue& catalogue);

}  // namespace dendro::study
