#include "sim/study/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/config/nearest.h"
#include "sim/config/table_reader.h"
#include "sim/study/scene_keys.h"
#include "sim/study/scene_objects.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;
using config::Document;
using config::DocumentName;
using config::Node;
using config::TableReader;

constexpr double kAny = 1e12;

std::optional<DocumentName> built_in(const std::string& name) {
  for (const std::string& path : base::embedded_files("firmware", ".toml"))
    if (path.find("/scenes/") != std::string::npos && fs::path(path).stem() == name)
      return DocumentName{true, path};
  return std::nullopt;
}

DocumentName find_scene(const std::string& name, const Catalogue& catalogue) {
  if (const auto found = built_in(name)) return *found;
  std::error_code error;
  const bool like_path = name.find('/') != std::string::npos || fs::path(name).extension() == ".toml";
  if (like_path || fs::exists(name, error)) return {false, name};
  std::vector<std::string> names;
  for (const BuiltInScene& s : built_in_scenes(catalogue)) names.push_back(s.name);
  throw UserError("", 0, name,
                  "there is no such scene" + config::did_you_mean(name, names) +
                      " (`dendro scenes` lists them; a file ends in .toml)");
}

/// Paths become absolute before documents are merged, because each is relative to the file it stands in.
void make_absolute(Node* node, const DocumentName& document, const std::string& share) {
  if (node == nullptr || node->kind != Node::Kind::kValue) return;
  auto* text = std::get_if<std::string>(&node->value);
  if (text == nullptr || text->empty() || fs::path(*text).is_absolute()) return;
  fs::path folder = fs::path(document.path).parent_path();
  if (document.embedded) {
    folder = fs::path(share) / folder.lexically_relative("firmware");
  } else {
    folder = fs::absolute(folder.empty() ? fs::path(".") : folder);
  }
  *text = (folder / *text).lexically_normal().string();
}

void make_paths_absolute(Document& document, const Catalogue& catalogue) {
  const std::string& share = catalogue.share;
  for (const Algorithm& algorithm : catalogue.algorithms)
    if (Node* table = document.root.member(algorithm.name))
      for (const std::string& key : algorithm.path_keys) make_absolute(table->member(key), document.name, share);
  for (const auto& [list, key] : {std::pair("object", "mesh"), std::pair("input", "path")})
    if (Node* items = document.root.member(list))
      for (Node& item : items->items) make_absolute(item.member(key), document.name, share);
  if (Node* machine = document.root.member("machine")) {
    const auto* text = std::get_if<std::string>(&machine->value);
    if (text != nullptr && fs::path(*text).extension() == ".toml")
      make_absolute(machine, document.name, share);
  }
}

bool names_a_file(const std::string& key, const Catalogue& catalogue) {
  for (const Algorithm& algorithm : catalogue.algorithms)
    for (const std::string& path : algorithm.path_keys)
      if (key == algorithm.name + "." + path) return true;
  return key.size() > 5 && key.compare(key.size() - 5, 5, ".mesh") == 0 && key.compare(0, 7, "object.") == 0;
}

/// A file named on the command line is relative to the folder the command runs in.
void apply_setting(Node& document, const std::string& setting, const Catalogue& catalogue) {
  const auto [key, text] = config::split_setting(setting);
  Node value = config::parse_setting(text);
  if (names_a_file(key, catalogue)) make_absolute(&value, DocumentName{false, "./setting"}, "");
  config::set_path(document, key, value);
}

scene::Where to_scene(const config::Where& where) { return {where.file, where.line}; }

scene::Vector3 vector3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

scene::Image read_image(TableReader& root) {
  scene::Image image;
  const Node* table = root.table("image");
  if (table == nullptr) return image;
  TableReader reader(*table, "image");
  image.where = to_scene(table->where);
  image.width = static_cast<int>(reader.integer("width", image.width, 1, 16384));
  image.height = static_cast<int>(reader.integer("height", image.height, 1, 16384));
  reader.finish();
  return image;
}

scene::Camera read_camera(TableReader& root) {
  const Node* table = root.table("camera");
  if (table == nullptr) root.fail("camera", "the scene needs a [camera]");
  TableReader reader(*table, "camera");
  scene::Camera camera;
  camera.where = to_scene(table->where);
  const bool perspective =
      reader.choice("projection", "parallel", {"parallel", "perspective"}) == "perspective";
  camera.projection =
      perspective ? scene::Camera::Projection::kPerspective : scene::Camera::Projection::kParallel;
  camera.height = reader.real("height", 0, 1e-9, kAny);
  camera.fov_y = reader.real("fov_y", 0, 1e-3, 179.999);
  if (perspective && !reader.has("fov_y"))
    reader.fail("fov_y", "a perspective camera needs its vertical angle");
  if (!perspective && !reader.has("height"))
    reader.fail("height", "a parallel camera needs the world height of the picture");
  camera.position = vector3(reader.numbers("position", {0, 0, 1}, 3));
  camera.target = vector3(reader.numbers("target", {0, 0, 0}, 3));
  camera.up = vector3(reader.numbers("up", {0, 1, 0}, 3));
  reader.finish();
  const scene::Vector3 d = {camera.target[0] - camera.position[0], camera.target[1] - camera.position[1],
                            camera.target[2] - camera.position[2]};
  const scene::Vector3& u = camera.up;
  const scene::Vector3 cross = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2],
                                d[0] * u[1] - d[1] * u[0]};
  if (d == scene::Vector3{0, 0, 0}) reader.fail("target", "must differ from the position");
  if (cross == scene::Vector3{0, 0, 0}) reader.fail("up", "must not point along the view");
  return camera;
}

std::vector<scene::Light> read_lights(TableReader& root) {
  std::vector<scene::Light> lights;
  const Node* list = root.node("light");
  if (list == nullptr) return lights;
  if (list->kind != Node::Kind::kArray) root.fail("light", "lights are written as [[light]]");
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    TableReader reader(list->items[i], fmt::format("light.{}", i));
    scene::Light light;
    light.where = to_scene(list->items[i].where);
    light.direction = vector3(reader.numbers("direction", {0, -1, 0}, 3));
    if (light.direction == scene::Vector3{0, 0, 0}) reader.fail("direction", "must not be zero");
    light.ambient = reader.real("ambient", light.ambient, 0, 1);
    reader.finish();
    lights.push_back(light);
  }
  return lights;
}

std::vector<PinnedDigest> read_pins(TableReader& root, const std::string& list_name,
                                    const std::string& name_key) {
  std::vector<PinnedDigest> pins;
  const Node* list = root.node(list_name);
  if (list == nullptr) return pins;
  if (list->kind != Node::Kind::kArray) root.fail(list_name, "these are written as [[" + list_name + "]]");
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    TableReader reader(list->items[i], fmt::format("{}.{}", list_name, i));
    PinnedDigest pin{reader.text(name_key, ""), reader.text("sha256", ""), list->items[i].where};
    if (pin.name.empty() || pin.sha256.empty())
      reader.fail(name_key, "needs `" + name_key + "` and `sha256`");
    reader.finish();
    pins.push_back(std::move(pin));
  }
  return pins;
}

/// In a scene an entry has at least a value and a source, so a table of parameters is told from it by that.
void read_parameters(const std::string& prefix, const Node& table,
                     std::vector<std::pair<std::string, Node>>& parameters) {
  if (table.kind != Node::Kind::kTable)
    throw UserError(table.where.file, table.where.line, "parameters",
                    "must be a table of the machine's parameters");
  for (const auto& [name, node] : table.members) {
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    const bool section = node.kind == Node::Kind::kTable && !node.member("value") && !node.member("source");
    if (section)
      read_parameters(key, node, parameters);
    else if (node.kind == Node::Kind::kArray)
      throw UserError(node.where.file, node.where.line, "parameters." + key, "a parameter is one value");
    else
      parameters.emplace_back(key, node);
  }
}

std::string read_algorithm(TableReader& root, const Catalogue& catalogue) {
  std::vector<std::string> names;
  for (const Algorithm& a : catalogue.algorithms) names.push_back(a.name);
  const std::string name = root.choice("algorithm", "", names);
  if (name.empty()) root.fail("algorithm", "the scene must name its algorithm");
  return name;
}

std::string read_build(TableReader& root) {
  const Node* table = root.table("build");
  if (table == nullptr) return "";
  TableReader reader(*table, "build");
  reader.text("compiler", "");
  return reader.text("dendro", "");
}

void interpret(SceneFile& file, const Catalogue& catalogue) {
  check_keys(file.document, catalogue);
  TableReader root(file.document, "");
  scene::Scene& s = file.scene;
  root.node("description");
  file.build = read_build(root);
  s.name = root.text("name", s.name);
  s.algorithm = read_algorithm(root, catalogue);
  s.machine = root.text("machine", catalogue.algorithm(s.algorithm)->machines.front());
  file.machine_where = root.where("machine");
  file.preset_label = root.text("preset", "");
  if (root.has("level")) file.level = root.text("level", "");
  file.level_where = root.where("level");
  s.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0, INT64_MAX));
  s.image = read_image(root);
  s.camera = read_camera(root);
  s.lights = read_lights(root);
  s.objects = read_objects(root);
  const Node* options = root.table(s.algorithm);
  s.options = read_options(s.algorithm, options);
  if (const Node* table = root.table("parameters")) read_parameters("", *table, file.parameters);
  file.inputs = read_pins(root, "input", "path");
  file.firmware = read_pins(root, "firmware", "name");
  root.finish();
}

}  // namespace

std::vector<BuiltInScene> built_in_scenes(const Catalogue& catalogue) {
  std::vector<BuiltInScene> scenes;
  for (const Algorithm& algorithm : catalogue.algorithms) {
    for (const std::string& path : base::embedded_files(algorithm.folder + "/scenes", ".toml")) {
      const Node root = config::parse_toml(*base::embedded_file(path), path);
      const auto text = [&](const char* key) {
        const Node* node = root.member(key);
        const auto* value = node ? std::get_if<std::string>(&node->value) : nullptr;
        return value ? *value : std::string();
      };
      const std::string machine = text("machine");
      scenes.push_back({fs::path(path).stem().string(), path, algorithm.name,
                        machine.empty() ? algorithm.machines.front() : machine, text("description")});
    }
  }
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

SceneFile load_scene(const std::string& name, const std::vector<std::string>& settings,
                     const Catalogue& catalogue) {
  const DocumentName root = find_scene(name, catalogue);
  SceneFile file;
  for (Document& document : config::load_documents(root, built_in, {})) {
    make_paths_absolute(document, catalogue);
    config::merge(file.document, document.root);
    file.document.where = {document.name.path, 0};
  }
  for (const std::string& setting : settings) apply_setting(file.document, setting, catalogue);
  file.scene.name = fs::path(root.path).stem().string();
  file.scene.file = root.path;
  interpret(file, catalogue);
  return file;
}

}  // namespace dendro::study
