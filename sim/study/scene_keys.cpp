#include "sim/study/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/base/error.h"
#include "sim/config/nearest.h"

namespace dendro::study {
namespace {

using config::Node;
using Keys = std::vector<std::string>;

[[noreturn]] void fail(const Node& node, const std::string& key, const std::string& message) {
  throw UserError(node.where.file, node.where.line, key, message);
}

void check_names(const Node& table, const std::string& path, const Keys& known) {
  for (const auto& [key, node] : table.members)
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(node, path.empty() ? key : path + "." + key, "unknown key" + config::did_you_mean(key, known));
}

void check_table(const Node& document, const std::string& name, const Keys& known) {
  if (const Node* table = document.member(name)) check_names(*table, name, known);
}

template <class F>
void for_each_item(const Node& document, const std::string& name, F check) {
  const Node* list = document.member(name);
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->items.size(); ++i) check(list->items[i], fmt::format("{}.{}", name, i));
}

bool is_text(const Node* node, const char* text) {
  const auto* value =
      node != nullptr && node->kind == Node::Kind::kValue ? std::get_if<std::string>(&node->value) : nullptr;
  return value != nullptr && *value == text;
}

void check_camera(const Node& document) {
  check_table(document, "camera", {"projection", "height", "fov_y", "position", "target", "up"});
  const Node* camera = document.member("camera");
  if (camera == nullptr) return;
  const Node* projection = camera->member("projection");
  const Node* angle = camera->member("fov_y");
  const Node* height = camera->member("height");
  if (angle != nullptr && (projection == nullptr || is_text(projection, "parallel")))
    fail(*angle, "camera.fov_y",
         "goes with projection = \"perspective\" only; a parallel camera has a height");
  if (height != nullptr && is_text(projection, "perspective"))
    fail(*height, "camera.height",
         "goes with projection = \"parallel\" only; a perspective camera has a fov_y");
}

/// A grown tree has parameters of its own.
void check_object(const Node& object, const std::string& path) {
  if (object.member("tree") != nullptr) return;
  check_names(object, path,
              {"mesh", "solid", "planes", "tree", "at", "rotate", "scale", "units", "up_axis", "groups",
               "trunk", "trunk_width", "trunk_height"});
  if (object.member("mesh") != nullptr) return;
  if (const Node* groups = object.member("groups")) fail(*groups, path + ".groups", "goes with a mesh only");
  if (const Node* units = object.member("units"); units != nullptr && object.member("solid") != nullptr)
    fail(*units, path + ".units", "goes with a mesh or planes; a solid has its corners on a sphere of 1 m");
}

void check_pins(const Node& document, const char* list, const char* name) {
  for_each_item(document, list, [&](const Node& item, const std::string& path) {
    check_names(item, path, {name, "sha256"});
  });
}

}  // namespace

void check_keys(const Node& document, const Catalogue& catalogue) {
  Keys root = {"algorithm", "machine", "image",  "camera",      "light", "object", "parameters", "seed",
               "level",     "name",    "preset", "description", "build", "input",  "firmware"};
  const Algorithm* algorithm = nullptr;
  for (const Algorithm& a : catalogue.algorithms)
    if (is_text(document.member("algorithm"), a.name.c_str())) algorithm = &a;
  // Without a good algorithm the name of its table is not known; then that is what is wrong.
  for (const Algorithm& a : catalogue.algorithms)
    if (algorithm == nullptr || algorithm == &a) root.push_back(a.name);
  check_names(document, "", root);
  check_table(document, "image", {"width", "height"});
  check_camera(document);
  for_each_item(document, "light", [](const Node& light, const std::string& path) {
    check_names(light, path, {"direction", "ambient"});
  });
  for_each_item(document, "object", check_object);
  if (algorithm != nullptr) check_table(document, algorithm->name, algorithm->option_keys);
  check_table(document, "build", {"dendro", "compiler"});
  check_pins(document, "input", "path");
  check_pins(document, "firmware", "name");
}

}  // namespace dendro::study
