#include "sim/study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/config/nearest.h"
#include "sim/config/table_reader.h"
#include "sim/stats/run_object.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;
using config::Node;
using config::TableReader;
using config::Value;

constexpr const char* kFolder = "sim/study/studies";
constexpr const char* kPer = " per ";
constexpr double kMostPoints = 1e7;  // of one axis, whatever the user says: they are held in memory

std::string built_in_path(const std::string& name) {
  for (const std::string& path : base::embedded_files(kFolder, ".toml"))
    if (fs::path(path).stem() == name) return path;
  return "";
}

config::DocumentName find_study(const std::string& name) {
  const std::string path = built_in_path(name);
  if (!path.empty()) return {true, path};
  std::error_code error;
  if (name.find('/') != std::string::npos || fs::path(name).extension() == ".toml" || fs::exists(name, error))
    return {false, name};
  std::vector<std::string> names;
  for (const BuiltInStudy& s : built_in_studies()) names.push_back(s.name);
  throw UserError("", 0, name,
                  "there is no such study" + config::did_you_mean(name, names) +
                      " (`dendro sweep --list` lists them; a file ends in .toml)");
}

bool is_integer(const Node* node) {
  return node != nullptr && node->kind == Node::Kind::kValue && std::holds_alternative<std::int64_t>(node->value);
}

[[noreturn]] void too_many(const config::Where& where, const std::string& key, double count) {
  throw UserError(where.file, where.line, key,
                  fmt::format("these are {} runs, more than {}; say --yes to make them",
                              count < 9e15 ? stats::grouped(static_cast<std::int64_t>(count))
                                           : fmt::format("{:.2g}", count),
                              stats::grouped(static_cast<std::int64_t>(kManyRuns))));
}

void check_count(const TableReader& reader, const std::string& key, double count, bool many) {
  if (count > kMostPoints)
    reader.fail(key, fmt::format("{:.3g} points on one axis are too many, at most {:.0g} are possible", count,
                                 kMostPoints));
  if (!many && count > static_cast<double>(kManyRuns)) too_many(reader.where(key), reader.full_key(key), count);
}

std::vector<Value> listed(TableReader& reader, bool many) {
  const Node* list = reader.node("values");
  if (list->kind != Node::Kind::kArray) reader.fail("values", "must be a list");
  check_count(reader, "values", static_cast<double>(list->items.size()), many);
  std::vector<Value> values;
  for (const Node& item : list->items) {
    if (item.kind != Node::Kind::kValue) reader.fail("values", "every item must be a number, a word, true or false");
    const auto* real = std::get_if<double>(&item.value);
    if (real != nullptr && !std::isfinite(*real)) reader.fail("values", "every number must be finite");
    values.push_back(item.value);
  }
  return values;
}

/// from..to in steps, or `count` points of equal distance or of equal ratio.
std::vector<Value> ranged(TableReader& reader, bool logarithmic, bool many) {
  for (const char* key : {"from", "to"})
    if (!reader.has(key)) reader.fail(key, "an axis needs `values`, or `from` and `to`");
  bool integers = is_integer(reader.node("from")) && is_integer(reader.node("to"));
  const double from = reader.real("from", 0, -1e15, 1e15), to = reader.real("to", 0, -1e15, 1e15);
  if (reader.has("step") == reader.has("count")) reader.fail("step", "a range needs either `step` or `count`");
  if (from > to) reader.fail("to", "the range is empty: `to` is smaller than `from`");
  double count = 0, step = 0;
  if (reader.has("step")) {
    if (logarithmic) reader.fail("step", "a logarithmic range needs `count`");
    integers = integers && is_integer(reader.node("step"));
    step = reader.real("step", 1, 0, 1e15);
    if (step == 0) reader.fail("step", "must be larger than zero");
    count = std::floor((to - from) / step + 1e-9) + 1;
  } else {
    count = static_cast<double>(reader.integer("count", 1, 0, INT64_MAX));
    if (count == 0) reader.fail("count", "the axis is empty");
    if (count == 1 && from != to) reader.fail("count", "one point cannot reach from `from` to `to`");
    step = count > 1 ? (to - from) / (count - 1) : 0;
  }
  if (logarithmic && from <= 0) reader.fail("from", "a logarithmic range begins above zero");
  check_count(reader, reader.has("step") ? "step" : "count", count, many);
  std::vector<Value> values;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) {
    const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    double v = logarithmic ? from * std::pow(to / from, share) : from + static_cast<double>(i) * step;
    if (!integers) {
      values.emplace_back(std::stod(fmt::format("{:.12g}", v)));  // 3.8, not 3.8000000000000003
      continue;
    }
    const Value rounded = static_cast<std::int64_t>(std::llround(v));
    if (values.empty() || values.back() != rounded) values.push_back(rounded);
  }
  return values;
}

std::vector<std::string> read_words(TableReader& root, const std::string& key, std::vector<std::string> otherwise) {
  const Node* node = root.node(key);
  if (node == nullptr) return otherwise;
  std::vector<std::string> words;
  if (node->kind != Node::Kind::kArray) root.fail(key, "must be a list of words");
  for (const Node& item : node->items) {
    const auto* word = item.kind == Node::Kind::kValue ? std::get_if<std::string>(&item.value) : nullptr;
    if (word == nullptr) root.fail(key, "must be a list of words");
    if (std::find(words.begin(), words.end(), *word) != words.end()) root.fail(key, "`" + *word + "` is there twice");
    words.push_back(*word);
  }
  if (words.empty()) root.fail(key, "the list is empty");
  return words;
}

StudyAxis read_axis(const Node& table, const std::string& path, bool many) {
  TableReader reader(table, path);
  // First, so that a misspelt key is not reported as a missing one.
  for (const char* key : {"key", "label", "scale", "values", "names", "from", "to", "step", "count"}) reader.node(key);
  reader.finish();
  StudyAxis axis;
  axis.where = table.where;
  axis.key = reader.text("key", "");
  if (axis.key.empty()) reader.fail("key", "an axis needs the key that it varies");
  axis.label = reader.text("label", axis.key);
  axis.logarithmic = reader.choice("scale", "linear", {"linear", "log"}) == "log";
  axis.values = reader.has("values") ? listed(reader, many) : ranged(reader, axis.logarithmic, many);
  if (axis.values.empty()) reader.fail("values", "the axis is empty");
  axis.names = read_words(reader, "names", {});
  if (!axis.names.empty() && axis.names.size() != axis.values.size())
    reader.fail("names", fmt::format("{} names for {} values", axis.names.size(), axis.values.size()));
  std::set<Value> seen;
  for (const Value& v : axis.values)
    if (!seen.insert(v).second) reader.fail("values", config::to_text(v) + " is there twice");
  return axis;
}

void flatten(const Node& node, const std::string& prefix, std::vector<std::string>& settings) {
  for (const auto& [name, member] : node.members) {
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    if (member.kind == Node::Kind::kTable)
      flatten(member, key, settings);
    else
      settings.push_back(key + "=" + config::to_toml(member));
  }
}

/// A path in a study is relative to its file; a name stays a name.
std::string resolve_path(const std::string& text, const config::DocumentName& study) {
  const bool path = text.find('/') != std::string::npos || fs::path(text).extension() == ".toml";
  if (!path || study.embedded || fs::path(text).is_absolute()) return text;
  return (fs::absolute(study.path).parent_path() / text).lexically_normal().string();
}

/// The axis that varies the machine names machines as the study's own key does.
void read_machines(TableReader& root, const config::DocumentName& document, Study& study) {
  for (StudyAxis& axis : study.axes) {
    if (axis.key != kMachineKey) continue;
    if (root.has("machine")) root.fail("machine", "an axis varies the machine");
    for (Value& value : axis.values) {
      auto* name = std::get_if<std::string>(&value);
      if (name == nullptr) throw UserError(axis.where.file, axis.where.line, axis.key, "every value must be a machine's name");
      *name = resolve_path(*name, document);
    }
  }
}

void read_axes(TableReader& root, bool many, Study& study) {
  const Node* axes = root.node("axis");
  if (axes == nullptr || axes->kind != Node::Kind::kArray || axes->items.empty())
    root.fail("axis", "a study needs at least one [[axis]]");
  std::set<std::string> keys;
  double runs = static_cast<double>(study.levels.size());
  for (std::size_t i = 0; i < axes->items.size(); ++i) {
    study.axes.push_back(read_axis(axes->items[i], fmt::format("axis.{}", i), many));
    const StudyAxis& axis = study.axes.back();
    if (!keys.insert(axis.key).second)
      throw UserError(axis.where.file, axis.where.line, axis.key, "two axes vary this key");
    runs *= static_cast<double>(axis.values.size());
  }
  if (runs > kMostPoints)
    throw UserError(axes->where.file, axes->where.line, "axis",
                    fmt::format("these are {:.3g} runs, at most {:.0g} are possible", runs, kMostPoints));
  if (!many && runs > static_cast<double>(kManyRuns)) too_many(axes->where, "axis", runs);
}

}  // namespace

std::string StudyAxis::text_of(std::size_t value) const {
  if (!names.empty()) return names[value];
  const auto* word = std::get_if<std::string>(&values[value]);
  return word ? *word : config::to_text(values[value]);
}

bool StudyAxis::numeric() const {
  return names.empty() && std::all_of(values.begin(), values.end(), [](const Value& v) {
    return std::holds_alternative<std::int64_t>(v) || std::holds_alternative<double>(v);
  });
}

std::size_t Study::runs() const {
  std::size_t n = levels.size();
  for (const StudyAxis& axis : axes) n *= axis.values.size();
  return n;
}

std::vector<std::size_t> Study::place(std::size_t run) const {
  std::vector<std::size_t> place(axes.size());
  for (std::size_t i = axes.size(); i-- > 0;) {
    place[i] = run % axes[i].values.size();
    run /= axes[i].values.size();
  }
  return place;
}

const std::string& Study::level_of(std::size_t run) const { return levels[run / (runs() / levels.size())]; }

std::vector<std::string> Study::settings_of(std::size_t run) const {
  std::vector<std::string> all = settings;
  const auto at = place(run);
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].key != kMachineKey) all.push_back(axes[i].key + "=" + config::to_text(axes[i].values[at[i]]));
  return all;
}

std::string Study::machine_of(std::size_t run) const {
  const auto at = place(run);
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].key == kMachineKey) return std::get<std::string>(axes[i].values[at[i]]);
  return machine;
}

std::vector<std::string> figures_of(const std::string& output) {
  const std::size_t per = output.find(kPer);
  if (per == std::string::npos) return {output};
  return {output.substr(0, per), output.substr(per + std::string(kPer).size())};
}

std::vector<BuiltInStudy> built_in_studies() {
  std::vector<BuiltInStudy> studies;
  for (const std::string& path : base::embedded_files(kFolder, ".toml")) {
    const Node root = config::parse_toml(*base::embedded_file(path), path);
    const Node* node = root.member("description");
    const auto* text = node ? std::get_if<std::string>(&node->value) : nullptr;
    studies.push_back({fs::path(path).stem().string(), path, text ? *text : ""});
  }
  return studies;
}

Study load_study(const std::string& name, bool many) {
  const config::DocumentName document = find_study(name);
  const Node node = config::parse_toml(config::read_text(document, {}), document.path);
  TableReader root(node, "");
  Study study;
  study.file = document.path;
  study.name = fs::path(document.path).stem().string();
  study.description = root.text("description", "");
  study.scene_where = root.where("scene");
  study.machine_where = root.where("machine");
  study.scene = resolve_path(root.text("scene", ""), document);
  if (study.scene.empty()) root.fail("scene", "a study needs its scene");
  study.machine = resolve_path(root.text("machine", ""), document);
  study.levels_where = root.where("levels");
  study.levels = read_words(root, "levels", {"cycle"});
  if (root.has("seed")) study.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0, INT64_MAX));
  study.outputs_where = root.where("outputs");
  study.outputs = read_words(root, "outputs", {"seconds"});
  study.settings_where = root.where("set");
  if (const Node* set = root.table("set")) flatten(*set, "", study.settings);
  study.output_labels = read_words(root, "output_labels", study.outputs);
  if (study.output_labels.size() != study.outputs.size())
    root.fail("output_labels", fmt::format("{} labels for {} outputs", study.output_labels.size(), study.outputs.size()));
  study.logarithmic = root.choice("output_scale", "linear", {"linear", "log"}) == "log";
  read_axes(root, many, study);
  read_machines(root, document, study);
  root.finish();
  return study;
}

}  // namespace dendro::study
