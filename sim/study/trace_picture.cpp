#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "sim/scene/chart.h"
#include "sim/study/trace.h"

namespace dendro::study {
namespace {

/// What comes after these is left out: bars of many records could not be told apart.
constexpr std::size_t kMostRecords = 100;

/// One operation, from the tick of its record to the tick at which the trace says it is done.
struct Bar {
  std::string op;
  std::int64_t from = 0, to = 0;
};

std::vector<Bar> bars_of(trace::Reader& trace, const trace::Boundary& boundary, bool& complete) {
  std::vector<Bar> bars;
  std::int64_t done = 0;
  trace::Record record;
  complete = true;
  while (trace.next(record)) {
    Bar bar{record.op, record.at.from(done), 0};
    bar.to = record.answer_at.given() ? record.answer_at.from(bar.from) : bar.from;
    done = bar.to;
    if (!boundary.find(record.op)->checks_time) continue;
    complete = bars.size() < kMostRecords;
    if (!complete) break;
    bars.push_back(std::move(bar));
  }
  return bars;
}

}  // namespace

scene::RgbImage trace_picture(trace::Reader& trace, const trace::Boundary& boundary) {
  bool complete = true;
  const std::vector<Bar> bars = bars_of(trace, boundary, complete);
  const std::int64_t origin = bars.empty() ? 0 : bars.front().from;
  scene::LineChart chart;
  chart.title = boundary.name + (complete ? ": all operations" : fmt::format(": the first {} operations", kMostRecords));
  chart.x.label = origin == 0 ? "tick" : fmt::format("ticks after {}", origin);
  scene::ChartSeries series;
  for (const Bar& bar : bars) {
    auto row = std::find(chart.y.categories.begin(), chart.y.categories.end(), bar.op);
    if (row == chart.y.categories.end()) row = chart.y.categories.insert(row, bar.op);
    const auto y = static_cast<double>(row - chart.y.categories.begin());
    const double gap = std::numeric_limits<double>::quiet_NaN();
    for (const double x : {static_cast<double>(bar.from - origin), static_cast<double>(bar.to - origin), gap}) {
      series.x.push_back(x);
      series.y.push_back(y);
    }
  }
  chart.series = {std::move(series)};
  return scene::draw(chart);
}

}  // namespace dendro::study
