#include "sim/base/check.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

RowGroup without_experiment(std::vector<TableRow> rows, const std::string& why) {
  for (TableRow& row : rows) row.note = why;
  return {"", std::move(rows), [](const TableContext&, std::vector<TableRow>&) {}};
}

}  // namespace

std::vector<RowGroup> fg86_open_groups() {
  return {
      without_experiment(
          {claim("FG86-A30", "intersection of N half-spaces in world space", "1")},
          "no figure: a statement on another method; it is of order N log N, not N (FG86-K14)"),
      without_experiment({claim("FG86-A37", "scores of Table 1", "1")}, "no figure: subjective scores"),
  };
}

}  // namespace dendro::study
