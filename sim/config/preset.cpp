#include "sim/config/preset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/config/nearest.h"

namespace dendro::config {
namespace {

const std::vector<std::string> kEntryKeys = {"value", "range", "choices", "scale", "follows", "source"};

[[noreturn]] void fail(const Where& where, const std::string& key, const std::string& message) {
  throw UserError(where.file, where.line, key, message);
}

bool is_assumed(const std::string& source) { return source.compare(0, 7, "ASSUMED") == 0; }

bool names_deviation(const std::string& source) {
  const auto at = source.find("DEV-");
  return at != std::string::npos && at + 4 < source.size() &&
         std::isdigit(static_cast<unsigned char>(source[at + 4]));
}

std::optional<double> as_number(const Value& value) {
  if (const auto* i = std::get_if<std::int64_t>(&value)) return static_cast<double>(*i);
  if (const auto* d = std::get_if<double>(&value)) return *d;
  return std::nullopt;
}

std::string text_member(const std::string& key, const Node& entry, const std::string& member) {
  const Node* node = entry.member(member);
  if (node == nullptr) return "";
  if (node->kind != Node::Kind::kValue || !std::holds_alternative<std::string>(node->value) ||
      std::get<std::string>(node->value).empty())
    fail(node->where, key, "`" + member + "` must be a string and not empty");
  return std::get<std::string>(node->value);
}

void read_range(Parameter& p, const Node& range) {
  const bool two = range.kind == Node::Kind::kArray && range.items.size() == 2 &&
                   range.items[0].kind == Node::Kind::kValue && range.items[1].kind == Node::Kind::kValue;
  const auto low = two ? as_number(range.items[0].value) : std::nullopt;
  const auto high = two ? as_number(range.items[1].value) : std::nullopt;
  if (!low || !high || !(*low <= *high))
    fail(range.where, p.key, "`range` must be [low, high] with low <= high");
  const auto value = as_number(p.value);
  if (!value) fail(range.where, p.key, "only a number has a `range`; a list of `choices` is for the rest");
  if (*value < *low || *value > *high)
    fail(range.where, p.key,
         fmt::format("the value {} lies outside its range [{}, {}]", *value, *low, *high));
  const bool real = std::holds_alternative<double>(range.items[0].value) ||
                    std::holds_alternative<double>(range.items[1].value);
  if (real) p.value = *value;
  p.spread = Spread{low, high, {}, false};
}

void read_choices(Parameter& p, const Node& choices) {
  if (choices.kind != Node::Kind::kArray || choices.items.size() < 2)
    fail(choices.where, p.key, "`choices` must be a list of two or more values");
  p.spread = Spread{};
  for (const Node& item : choices.items) {
    if (item.kind != Node::Kind::kValue) fail(item.where, p.key, "a choice must be a plain value");
    p.spread->choices.push_back(item.value);
  }
  const auto& all = p.spread->choices;
  if (std::find(all.begin(), all.end(), p.value) == all.end())
    fail(choices.where, p.key, "the value " + to_text(p.value) + " is none of its choices");
}

void read_spread(Parameter& p, const Node& entry) {
  const Node* range = entry.member("range");
  const Node* choices = entry.member("choices");
  if (range && choices) fail(choices->where, p.key, "`range` or `choices`, not both");
  if (range) read_range(p, *range);
  if (choices) read_choices(p, *choices);
  const Node* scale = entry.member("scale");
  if (scale == nullptr) return;
  const std::string name = text_member(p.key, entry, "scale");
  if (name != "log" && name != "linear") fail(scale->where, p.key, "`scale` must be \"log\" or \"linear\"");
  if (!range) fail(scale->where, p.key, "`scale` needs a `range`");
  if (name == "log" && !(*p.spread->low > 0))
    fail(scale->where, p.key, "a log `scale` needs a range above 0");
  p.spread->logarithmic = name == "log";
}

void check_provenance(const Parameter& p, const Where& where) {
  if (p.source.empty())
    fail(where, p.key, "every entry needs a `source`: a document, or \"ASSUMED DEV-nnn\"");
  if (!is_assumed(p.source)) {
    if (p.spread)
      fail(where, p.key,
           "a documented value has no range or choices: the source must be \"ASSUMED DEV-nnn\"");
    return;
  }
  if (!names_deviation(p.source))
    fail(where, p.key, "an assumption must name its deviation: \"ASSUMED DEV-nnn\"");
  if (!p.spread && p.follows.empty())
    fail(where, p.key, "an assumed value needs a `range` or `choices` (or `follows` another parameter)");
}

/// `valueless` gathers the keys of followers that leave their value to the parameter they follow.
void collect(const std::string& prefix, const Node& table, std::vector<Parameter>& parameters,
             std::set<std::string>& valueless) {
  for (const auto& [name, node] : table.members) {
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    if (node.kind != Node::Kind::kTable)
      fail(node.where, key,
           "a parameter is written as { value, source }, or { value, range | choices, source }");
    if (!is_entry(node)) {
      collect(key, node, parameters, valueless);
      continue;
    }
    Parameter p = read_parameter(key, node);
    valueless.erase(key);
    if (node.member("value") == nullptr) valueless.insert(key);
    const auto same = std::find_if(parameters.begin(), parameters.end(),
                                   [&](const Parameter& other) { return other.key == key; });
    if (same == parameters.end())
      parameters.push_back(std::move(p));
    else
      *same = std::move(p);
  }
}

/// A follower without a value has it from the parameter it follows; one with a value must agree with it.
void resolve_followers(std::vector<Parameter>& parameters, const std::set<std::string>& valueless) {
  std::vector<std::string> keys;
  for (const Parameter& p : parameters) keys.push_back(p.key);
  const auto find = [&](const std::string& key) {
    return std::find_if(parameters.begin(), parameters.end(),
                        [&](const Parameter& p) { return p.key == key; });
  };
  for (Parameter& p : parameters) {
    if (p.follows.empty()) continue;
    std::set<std::string> seen = {p.key};
    const Parameter* leader = &p;
    while (!leader->follows.empty()) {
      const auto next = find(leader->follows);
      if (next == parameters.end())
        fail(p.where, p.key,
             "`follows` names no parameter: " + leader->follows + did_you_mean(leader->follows, keys));
      if (!seen.insert(next->key).second)
        fail(p.where, p.key, "`follows` goes round in a circle by " + next->key);
      leader = &*next;
    }
    if (valueless.count(p.key))
      p.value = leader->value;
    else if (p.value != leader->value && as_number(p.value) != as_number(leader->value))
      fail(p.where, p.key,
           fmt::format("the value {} differs from {} = {}, which it follows", to_text(p.value), leader->key,
                       to_text(leader->value)));
  }
}

std::string take_text(Node& document, const std::string& key) {
  const std::string text = text_member(key, document, key);
  document.erase(key);
  return text;
}

const MachinePresets* machine_named(const std::vector<MachinePresets>& machines, const std::string& name) {
  for (const MachinePresets& m : machines)
    if (m.name == name) return &m;
  return nullptr;
}

/// `NAME` or `NAME:PRESET` of a known machine.
std::optional<DocumentName> built_in(const std::string& text, const std::vector<MachinePresets>& machines) {
  const auto colon = text.find(':');
  const MachinePresets* m = machine_named(machines, text.substr(0, colon));
  if (m == nullptr || m->presets.empty()) return std::nullopt;
  const std::string preset = colon == std::string::npos ? m->presets.front() : text.substr(colon + 1);
  return DocumentName{true, m->folder + "/" + preset + ".toml"};
}

bool is_file(const std::string& text) {
  return text.size() > 5 && text.compare(text.size() - 5, 5, ".toml") == 0;
}

std::vector<std::string> machine_names(const std::vector<MachinePresets>& machines) {
  std::vector<std::string> names;
  for (const MachinePresets& m : machines) names.push_back(m.name);
  return names;
}

void check_name(const std::string& text, const std::vector<MachinePresets>& machines, const Where& where) {
  const auto colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const MachinePresets* m = machine_named(machines, name);
  if (m == nullptr) {
    std::string list;
    for (const auto& n : machine_names(machines)) list += (list.empty() ? "" : ", ") + n;
    fail(where, "machine",
         "there is no machine `" + name + "`: known are " + list +
             ", each with :PRESET, and files ending in .toml");
  }
  if (colon == std::string::npos) return;
  const std::string preset = text.substr(colon + 1);
  if (std::find(m->presets.begin(), m->presets.end(), preset) != m->presets.end()) return;
  std::string list;
  for (const auto& p : m->presets) list += (list.empty() ? "" : ", ") + p;
  fail(where, "machine", name + " has no preset `" + preset + "`: known are " + list);
}

}  // namespace

bool is_entry(const Node& node) {
  if (node.kind != Node::Kind::kTable) return false;
  if (node.inline_table) return true;
  return std::any_of(node.members.begin(), node.members.end(), [](const auto& member) {
    const bool known = std::find(kEntryKeys.begin(), kEntryKeys.end(), member.first) != kEntryKeys.end();
    return known && member.second.kind != Node::Kind::kTable;
  });
}

Parameter read_parameter(const std::string& key, const Node& entry) {
  for (const auto& [name, node] : entry.members)
    if (std::find(kEntryKeys.begin(), kEntryKeys.end(), name) == kEntryKeys.end())
      fail(node.where, key, "an entry has no `" + name + "`" + did_you_mean(name, kEntryKeys));
  Parameter p;
  p.key = key;
  p.where = entry.where;
  p.source = text_member(key, entry, "source");
  p.follows = text_member(key, entry, "follows");
  const Node* value = entry.member("value");
  if (value == nullptr && p.follows.empty()) fail(entry.where, key, "the entry has no `value`");
  if (value != nullptr) {
    if (value->kind != Node::Kind::kValue)
      fail(value->where, key, "`value` must be a number, a string, true or false");
    p.value = value->value;
  } else if (entry.member("range") || entry.member("choices")) {
    fail(entry.where, key, "the entry has no `value`, but says how far it may be off");
  }
  read_spread(p, entry);
  check_provenance(p, entry.where);
  return p;
}

void replace(ParameterSet& parameters, Parameter parameter) {
  if (parameters.find(parameter.key) == nullptr)
    parameters.set(parameter.key, parameter.value, parameter.where);
  ParameterSet copy;
  for (const Parameter& p : parameters.all()) copy.add(p.key == parameter.key ? parameter : p);
  parameters = std::move(copy);
}

std::string to_entry(const Parameter& p) {
  std::string text = "{ value = " + to_text(p.value);
  if (is_assumed(p.source) && p.spread) {
    if (p.spread->low) {
      const auto number = [&](double v) {
        const bool integer = std::holds_alternative<std::int64_t>(p.value);
        return to_text(integer ? Value(static_cast<std::int64_t>(v)) : Value(v));
      };
      text += ", range = [" + number(*p.spread->low) + ", " + number(*p.spread->high) + "]";
    } else {
      std::string list;
      for (const Value& choice : p.spread->choices) list += (list.empty() ? "" : ", ") + to_text(choice);
      text += ", choices = [" + list + "]";
    }
    if (p.spread->logarithmic) text += ", scale = \"log\"";
  }
  if (!p.follows.empty()) text += ", follows = " + to_text(Value(p.follows));
  return text + ", source = " + to_text(Value(p.source)) + " }";
}

Preset load_preset(const std::string& name, const std::vector<MachinePresets>& machines, const Where& where) {
  const bool on_disk = is_file(name);
  if (!on_disk) check_name(name, machines, where);
  Preset preset;
  const auto note_machine = [&](const std::string& text) { preset.machine = text.substr(0, text.find(':')); };
  const IncludeFinder find = [&](const std::string& include) {
    const auto found = built_in(include, machines);
    if (found) note_machine(include);
    return found;
  };
  const DocumentName root = on_disk ? DocumentName{false, name} : *built_in(name, machines);
  if (!on_disk) note_machine(name);
  std::vector<Parameter> parameters;
  std::set<std::string> valueless;
  for (Document& loaded : load_documents(root, find, where)) {
    Node& document = loaded.root;
    const Node* line = document.member("machine");
    const Where at = line ? line->where : Where{};
    if (const std::string machine = take_text(document, "machine"); !machine.empty()) {
      check_name(machine, machines, at);
      note_machine(machine);
    }
    if (document.member("description")) preset.description = take_text(document, "description");
    collect("", document, parameters, valueless);
  }
  if (preset.machine.empty())
    fail({name, 0}, "machine",
         "the file must say which machine it is for, or include a built-in preset of one");
  preset.name = on_disk ? std::filesystem::path(name).stem().string()
                        : std::filesystem::path(root.path).stem().string();
  resolve_followers(parameters, valueless);
  for (Parameter& p : parameters) preset.parameters.add(std::move(p));
  return preset;
}

}  // namespace dendro::config
