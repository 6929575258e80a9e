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
      without_experiment({claim("FG86-A22", "one plane on Pixel-Planes", "us", 6.0),
                          claim("FG86-A23", "all planes of 200 trees on Pixel-Planes", "ms", 14.0),
                          claim("FG86-A24", "Pixel-Planes: time of a tree twice the size", "1", 1.0),
                          claim("FG86-A25", "planes that a trunk adds to a tree on Pixel-Planes", "1", 8.0)},
                         "no figure: needs Pixel-Planes; these programs run on the RDS-3000"),
      without_experiment(
          {claim("FG86-A30", "intersection of N half-spaces in world space", "1")},
          "no figure: a statement on another method; it is of order N log N, not N (FG86-K14)"),
      without_experiment({claim("FG86-A37", "scores of Table 1", "1")}, "no figure: subjective scores"),
  };
}

}  // namespace dendro::study
