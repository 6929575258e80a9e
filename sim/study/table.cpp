#include "sim/study/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/base/error.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

std::vector<const PaperTable*> tables_for(const std::string& key) {
  std::vector<const PaperTable*> found;
  std::string known = "all";
  for (const PaperTable& table : paper_tables()) {
    if (key == "all" || key == table.key) found.push_back(&table);
    known += ", " + table.key;
  }
  if (found.empty()) throw UserError("", 0, key, "there is no such table: known are " + known);
  return found;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Counts in full, everything else with four digits.
std::string number(const std::optional<double>& value) {
  if (!value) return "-";
  const bool count = *value == std::floor(*value) && std::abs(*value) < 1e8;
  return count ? fmt::format("{:.0f}", *value) : fmt::format("{:.4g}", *value);
}

std::string verdict(const TableRow& row) {
  if (!row.simulated || !row.published) return "-";
  return row.inside() ? "inside" : "outside";
}

std::string widest(const TableRow& row) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, row.widened_by.size()); ++i) {
    const stats::Contribution& c = row.widened_by[i];
    text += fmt::format("{}{} {:.4g}..{:.4g}", i == 0 ? "" : ", ", c.key, c.low, c.high);
  }
  return text;
}

Json row_json(const TableRow& row) {
  Json widened = Json::array();
  for (const stats::Contribution& c : row.widened_by)
    widened.push_back({{"key", c.key}, {"low", c.low}, {"high", c.high}, {"source", c.source}});
  return {{"id", row.id},
          {"paper", row.paper},
          {"what", row.what},
          {"unit", row.unit},
          {"published", or_null(row.published)},
          {"simulated", or_null(row.simulated)},
          {"low", or_null(row.low)},
          {"high", or_null(row.high)},
          {"ratio", or_null(row.ratio())},
          {"inside", row.simulated && row.published ? Json(row.inside()) : Json(nullptr)},
          {"assumptions", row.assumptions},
          {"widened_by", widened},
          {"reading", row.reading},
          {"note", row.note}};
}

}  // namespace

bool TableOptions::wants(const std::string& id) const {
  return rows.empty() || std::any_of(rows.begin(), rows.end(), [&](const std::string& wanted) {
           const bool begins = id.compare(0, wanted.size(), wanted) == 0;
           return begins && (id.size() == wanted.size() || std::isalpha(static_cast<unsigned char>(id[wanted.size()])));
         });
}

std::optional<double> TableRow::ratio() const {
  if (!published || !simulated || *published == 0) return std::nullopt;
  return *simulated / *published;
}

bool TableRow::inside() const {
  return published && low && high && *published >= *low && *published <= *high;
}

std::vector<std::string> settings_for(const TableContext& context, const std::string& machine) {
  const auto has = [&](const std::string& name, const std::string& key) {
    return config::load_preset(name, context.catalogue.presets(), {}).parameters.find(key) != nullptr;
  };
  std::vector<std::string> settings;
  for (const std::string& setting : context.options.settings) {
    const std::string key = config::split_setting(setting).first, start = "parameters.";
    bool foreign = key.compare(0, start.size(), start) == 0 && !has(machine, key.substr(start.size()));
    foreign = foreign && std::any_of(context.catalogue.machines.begin(), context.catalogue.machines.end(),
                                     [&](const MachineType& type) { return has(type.name, key.substr(start.size())); });
    if (!foreign) settings.push_back(setting);
  }
  return settings;
}

const std::vector<PaperTable>& paper_tables() {
  static const std::vector<PaperTable> tables = {fg86_table(), fghs85_table(), mo95_table()};
  return tables;
}

std::vector<TableRow> make_table(const std::string& key, const TableContext& context) {
  const std::vector<std::string>& wanted = context.options.rows;
  std::vector<TableRow> rows;
  for (const PaperTable* table : tables_for(key)) {
    const auto of_table = [&](const std::string& id) { return id.compare(0, table->key.size() + 1, table->key + "-") == 0; };
    if (!wanted.empty() && std::none_of(wanted.begin(), wanted.end(), of_table)) continue;
    for (TableRow& row : table->make(context))
      if (context.options.wants(row.id)) rows.push_back(std::move(row));
  }
  for (const std::string& id : wanted) {
    TableOptions one;
    one.rows = {id};
    if (std::none_of(rows.begin(), rows.end(), [&](const TableRow& row) { return one.wants(row.id); }))
      throw UserError("--row", 0, id, "the table has no such row; an id is like FG86-A7a, or FG86-A7 for all its letters");
  }
  return rows;
}

void check_table(const std::string& key, const TableContext& context) {
  for (const PaperTable* table : tables_for(key)) table->check(context);
}

std::vector<std::string> table_plan(const std::string& key) {
  std::vector<std::string> plan;
  for (const PaperTable* table : tables_for(key))
    plan.insert(plan.end(), table->plan.begin(), table->plan.end());
  return plan;
}

void set_interval(TableRow& row, const Interval& interval, const config::ParameterSet& parameters) {
  row.low = interval.low;
  row.high = interval.high;
  const double noise = 1e-9 * std::max(std::abs(interval.low), std::abs(interval.high));
  for (const stats::Contribution& c : interval.contributions) {
    if (c.high - c.low <= noise) continue;
    row.widened_by.push_back(c);
    const config::Parameter* p = parameters.find(c.key);
    config::ParameterSet one;
    one.add(*p);
    for (const std::string& id : one.assumptions())
      if (std::find(row.assumptions.begin(), row.assumptions.end(), id) == row.assumptions.end())
        row.assumptions.push_back(id);
  }
}

std::string table_json(const std::vector<TableRow>& rows) {
  Json list = Json::array();
  for (const TableRow& row : rows) list.push_back(row_json(row));
  return Json({{"schema", 1}, {"command", "table"}, {"rows", list}}).dump(1) + "\n";
}

std::string table_text(const std::vector<TableRow>& rows) {
  std::string text = fmt::format("{:<10} {:<52} {:>9} {:>9} {:>19} {:<5} {:<7}\n", "id", "what", "published",
                                 "simulated", "interval", "unit", "verdict");
  for (const TableRow& row : rows) {
    const std::string interval = row.low ? number(row.low) + " .. " + number(row.high) : "-";
    text += fmt::format("{:<10} {:<52} {:>9} {:>9} {:>19} {:<5} {:<7}\n", row.id, row.what,
                        number(row.published), number(row.simulated), interval, row.unit, verdict(row));
    if (!row.reading.empty()) text += "           read as: " + row.reading + "\n";
    if (!row.widened_by.empty()) text += "           widened most by: " + widest(row) + "\n";
    if (!row.assumptions.empty())
      text += fmt::format("           rests on: {}\n", fmt::join(row.assumptions, ", "));
    if (!row.note.empty()) text += "           " + row.note + "\n";
  }
  return text;
}

}  // namespace dendro::study
