#include "sim/study/scene_objects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sim/base/error.h"

namespace dendro::study {
namespace {

using config::Node;
using config::TableReader;

constexpr double kAny = 1e12;

scene::Where to_scene(const config::Where& where) { return {where.file, where.line}; }

scene::Vector3 vector3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

scene::OptionValue option_value(const Node& node, const std::string& key) {
  scene::OptionValue out;
  out.where = to_scene(node.where);
  switch (node.kind) {
    case Node::Kind::kValue:
      std::visit([&](const auto& v) { out.value = v; }, node.value);
      return out;
    case Node::Kind::kArray: {
      scene::OptionValue::Array items;
      for (const Node& item : node.items) items.push_back(option_value(item, key));
      out.value = std::move(items);
      return out;
    }
    case Node::Kind::kTable:
      throw UserError(node.where.file, node.where.line, key, "must be a value or a list, not a table");
  }
  return out;
}

/// A plane is [nx, ny, nz, offset] or { normal = [..], offset = .. }.
std::vector<scene::PlaneEntry> read_planes(TableReader& object) {
  std::vector<scene::PlaneEntry> planes;
  const Node* list = object.node("planes");
  if (list == nullptr) return planes;
  if (list->kind != Node::Kind::kArray) object.fail("planes", "must be a list of planes");
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const Node& item = list->items[i];
    const std::string key = object.full_key(fmt::format("planes.{}", i));
    scene::PlaneEntry plane;
    if (item.kind == Node::Kind::kArray) {
      Node wrapped;
      wrapped.where = item.where;
      wrapped.members.emplace_back("plane", item);
      const auto v = TableReader(wrapped, key).numbers("plane", {}, 4);
      plane = {{v[0], v[1], v[2]}, v[3]};
    } else {
      TableReader reader(item, key);
      if (!reader.has("normal") || !reader.has("offset"))
        reader.fail("normal", "a plane is [nx, ny, nz, offset] or { normal = [x, y, z], offset = d }");
      plane.normal = vector3(reader.numbers("normal", {0, 0, 1}, 3));
      plane.offset = reader.real("offset", 0, -kAny, kAny);
      reader.finish();
    }
    if (plane.normal == scene::Vector3{0, 0, 0})
      throw UserError(item.where.file, item.where.line, key, "the normal must not be zero");
    planes.push_back(plane);
  }
  if (planes.empty()) object.fail("planes", "the list is empty: 0 planes bound nothing");
  return planes;
}

bool is_trunk_key(const std::string& key) { return key.compare(0, 5, "trunk") == 0; }

void read_shape(TableReader& reader, const Node& table, scene::Object& object) {
  std::vector<std::string> given;
  for (const char* key : {"mesh", "solid", "planes", "tree"})
    if (reader.has(key)) given.push_back(key);
  if (given.size() != 1)
    reader.fail(given.empty() ? "mesh" : given[1], "an object is exactly one of: mesh, solid, planes, tree");
  object.source_where = to_scene(reader.where(given.front()));
  object.mesh = reader.text("mesh", "");
  object.solid = reader.choice("solid", "", scene::solid_names());
  object.planes = read_planes(reader);
  object.tree = reader.text("tree", "");
  for (const auto& [key, node] : table.members)
    if (is_trunk_key(key))
      object.trunk_parameters[key] = option_value(*reader.node(key), reader.full_key(key));
  if (object.tree.empty()) return;
  static const std::vector<std::string> kCommon = {"tree",  "at",      "rotate", "scale",
                                                   "units", "up_axis", "groups"};
  for (const auto& [key, node] : table.members)
    if (!is_trunk_key(key) && std::find(kCommon.begin(), kCommon.end(), key) == kCommon.end())
      object.tree_parameters[key] = option_value(*reader.node(key), reader.full_key(key));
}

std::map<std::string, std::string> read_groups(TableReader& reader) {
  std::map<std::string, std::string> groups;
  const Node* table = reader.table("groups");
  if (table == nullptr) return groups;
  TableReader names(*table, reader.full_key("groups"));
  for (const auto& [key, node] : table->members) groups[key] = names.text(key, "");
  return groups;
}

}  // namespace

std::vector<scene::Object> read_objects(TableReader& root) {
  std::vector<scene::Object> objects;
  const Node* list = root.node("object");
  if (list == nullptr) root.fail("object", "the scene needs an [[object]]");
  if (list->kind != Node::Kind::kArray) root.fail("object", "objects are written as [[object]]");
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const Node& table = list->items[i];
    TableReader reader(table, fmt::format("object.{}", i));
    scene::Object object;
    object.where = to_scene(table.where);
    read_shape(reader, table, object);
    object.at = vector3(reader.numbers("at", {0, 0, 0}, 3));
    object.rotate = vector3(reader.numbers("rotate", {0, 0, 0}, 3));
    object.scale = reader.real("scale", 1.0, 1e-12, kAny);
    object.units = reader.choice("units", "m", {"m", "cm", "mm", "in", "ft"});
    object.up_axis = reader.choice("up_axis", "y", {"x", "y", "z"});
    object.groups = read_groups(reader);
    reader.finish();
    objects.push_back(std::move(object));
  }
  return objects;
}

scene::Options read_options(const std::string& name, const Node* table) {
  if (table == nullptr) return scene::Options(name);
  scene::Options options(name, to_scene(table->where));
  for (const auto& [key, node] : table->members) options.set(key, option_value(node, name + "." + key));
  return options;
}

}  // namespace dendro::study
