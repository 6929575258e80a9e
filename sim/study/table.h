#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/study/cache.h"

namespace dendro::study {

/// One published figure beside the simulated one.
struct TableRow {
  std::string id;  ///< of the claim: "FG86-A7a"
  std::string paper;
  std::string what;
  std::string unit;
  std::optional<double> published, simulated, low, high;
  std::vector<std::string> assumptions;         ///< DEV ids that move the figure, widest first
  std::vector<stats::Contribution> widened_by;  ///< in the row's unit, widest first, none without width
  std::string reading;                          ///< how a claim that is not a plain number was read, or empty
  std::string note;  ///< the reason for the verdict, and what the figure does not say

  std::optional<double> ratio() const;  ///< simulated / published
  /// The published value lies inside [low, high].
  bool inside() const;
};

struct TableOptions {
  std::string level = "cycle";
  std::vector<std::string> settings;  ///< key=value, applied to every run
  std::vector<std::string> rows;      ///< ids of the rows to make, with or without their letter; empty: all
  bool full = false;                  ///< sample the assumptions' ranges widely, too
  int jobs = 1;

  bool wants(const std::string& id) const;  ///< the row
};

/// What a table is made with.
struct TableContext {
  const Catalogue& catalogue;
  const TableOptions& options;
  const RunCache& cache;
  Progress* progress;
};

/// The settings without those of parameters that this machine lacks and another of the catalogue has.
std::vector<std::string> settings_for(const TableContext& context, const std::string& machine);

/// The table of one paper.
struct PaperTable {
  std::string key;                ///< "FG86"
  std::string title;              ///< one line for a list
  std::vector<std::string> plan;  ///< what will be run, one line each
  std::function<std::vector<TableRow>(const TableContext&)> make;
  std::function<void(const TableContext&)> check;  ///< throws UserError for options that make() would refuse
};

const std::vector<PaperTable>& paper_tables();

/// Rows of the paper with this key, or of all. Throws UserError for an unknown key and for a wanted row that there is not.
std::vector<TableRow> make_table(const std::string& key, const TableContext& context);

/// Throws UserError for all that make_table() would refuse, without running anything.
void check_table(const std::string& key, const TableContext& context);

/// The plan for a key. Throws UserError for an unknown key.
std::vector<std::string> table_plan(const std::string& key);

/// Puts an interval into a row that has its simulated value.
void set_interval(TableRow& row, const Interval& interval, const config::ParameterSet& parameters);

std::string table_json(const std::vector<TableRow>& rows);
std::string table_text(const std::vector<TableRow>& rows);

/// The paper's tables; each in a file of its own.
PaperTable fg86_table();
PaperTable fghs85_table();
PaperTable mo95_table();

}  // namespace dendro::study
