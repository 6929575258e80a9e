#include "sim/study/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "sim/base/check.h"
#include "sim/scene/chart.h"

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// The value itself, for machines to read.
std::string plain(const StudyAxis& axis, std::size_t value) {
  const auto* word = std::get_if<std::string>(&axis.values[value]);
  return word ? *word : config::to_text(axis.values[value]);
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

Json json_of(const config::Value& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

/// Parameters in the order of the rows' presets; a study of several machines has those of all.
std::vector<std::string> parameter_names(const std::vector<SweepRow>& rows) {
  std::vector<std::string> names;
  std::set<std::string> known, machines;
  for (const SweepRow& row : rows) {
    if (row.parameters.empty() || !machines.insert(row.machine).second) continue;
    for (const auto& [name, value] : row.parameters)
      if (known.insert(name).second) names.push_back(name);
  }
  return names;
}

/// Axes that vary at all.
std::vector<std::size_t> varied(const Study& study) {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < study.axes.size(); ++i)
    if (study.axes[i].values.size() > 1) axes.push_back(i);
  return axes;
}

scene::ChartAxis chart_axis(const StudyAxis& axis, bool categories) {
  scene::ChartAxis chart{axis.label, axis.logarithmic, {}};
  if (categories || !axis.numeric())
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      const auto* real = axis.names.empty() ? std::get_if<double>(&axis.values[i]) : nullptr;
      chart.categories.push_back(real ? scene::short_number(*real) : axis.text_of(i));
    }
  return chart;
}

double position(const StudyAxis& axis, std::size_t index) {
  if (!axis.numeric()) return static_cast<double>(index);
  const config::Value& v = axis.values[index];
  const auto* integer = std::get_if<std::int64_t>(&v);
  return integer ? static_cast<double>(*integer) : std::get<double>(v);
}

const std::string& label_of(const Study& study, const std::string& output) {
  const auto at = std::find(study.outputs.begin(), study.outputs.end(), output) - study.outputs.begin();
  return study.output_labels[static_cast<std::size_t>(at)];
}

/// A study's own labels stand at the axis, so its title goes without the figure's name.
std::string title(const Study& study, const std::string& output) {
  const std::string& name = study.description.empty() ? study.name : study.description;
  return label_of(study, output) == output ? name + ": " + output : name;
}

scene::ChartAxis output_axis(const Study& study, const std::string& output) {
  return {label_of(study, output), study.logarithmic, {}};
}

scene::RgbImage line_picture(const Study& study, const std::vector<SweepRow>& rows, const std::string& output,
                             std::size_t axis_index) {
  const StudyAxis& axis = study.axes[axis_index];
  scene::LineChart chart{title(study, output), chart_axis(axis, false), output_axis(study, output), {}};
  const std::size_t per_level = study.runs() / study.levels.size();
  for (std::size_t level = 0; level < study.levels.size(); ++level) {
    scene::ChartSeries series{study.levels[level], {}, {}};
    for (std::size_t run = level * per_level; run < (level + 1) * per_level; ++run) {
      series.x.push_back(position(axis, study.place(run)[axis_index]));
      series.y.push_back(output_of(rows[run], output));
    }
    chart.series.push_back(std::move(series));
  }
  return scene::draw(chart);
}

/// Two axes, of which one has a few values without an order: a curve for each of them.
constexpr std::size_t kMostCurves = 6;

bool is_curves(const Study& study, std::size_t across, std::size_t along) {
  return study.levels.size() == 1 && !study.axes[across].numeric() && study.axes[across].values.size() <= kMostCurves &&
         study.axes[along].numeric();
}

scene::RgbImage curves_picture(const Study& study, const std::vector<SweepRow>& rows, const std::string& output,
                               std::size_t across, std::size_t along) {
  scene::LineChart chart{title(study, output), chart_axis(study.axes[along], false), output_axis(study, output), {}};
  for (std::size_t value = 0; value < study.axes[across].values.size(); ++value)
    chart.series.push_back({study.axes[across].label + ": " + study.axes[across].text_of(value), {}, {}});
  for (std::size_t run = 0; run < study.runs(); ++run) {
    const auto place = study.place(run);
    scene::ChartSeries& series = chart.series[place[across]];
    series.x.push_back(position(study.axes[along], place[along]));
    series.y.push_back(output_of(rows[run], output));
  }
  return scene::draw(chart);
}

scene::RgbImage heat_picture(const Study& study, const std::vector<SweepRow>& rows, const std::string& output,
                             std::size_t x, std::size_t y) {
  scene::HeatMap map{title(study, output), chart_axis(study.axes[x], true), chart_axis(study.axes[y], true),
                     label_of(study, output), {}};
  const std::size_t columns = study.axes[x].values.size();
  map.values.resize(columns * study.axes[y].values.size());
  for (std::size_t run = 0; run < map.values.size(); ++run) {
    const auto place = study.place(run);
    map.values[place[y] * columns + place[x]] = output_of(rows[run], output);
  }
  return scene::draw(map);
}

}  // namespace

std::string sweep_csv(const Study& study, const std::vector<SweepRow>& rows) {
  const auto parameters = parameter_names(rows);
  std::string text = "point,level";
  for (const StudyAxis& axis : study.axes) text += "," + csv_cell(axis.key);
  for (const std::string& output : study.outputs) text += "," + csv_cell(output);
  text += ",refused,scene,machine,preset,seed,git,image_sha256";
  // An axis column has the scene key's name, so these stand apart even for the parameter that is varied.
  for (const std::string& name : parameters) text += "," + csv_cell("resolved." + name);
  text += "\n";
  for (std::size_t run = 0; run < rows.size(); ++run) {
    const SweepRow& row = rows[run];
    const auto place = study.place(run);
    text += fmt::format("{},{}", run, study.level_of(run));
    for (std::size_t i = 0; i < place.size(); ++i) text += "," + csv_cell(plain(study.axes[i], place[i]));
    for (const std::string& output : study.outputs) text += "," + number(output_of(row, output));
    text += fmt::format(",{},{},{},{},{},{},{}", csv_cell(row.refused), csv_cell(row.scene), row.machine, row.preset,
                        row.seed, row.git, row.image_sha256);
    std::map<std::string, std::string> values(row.parameters.begin(), row.parameters.end());
    for (const std::string& name : parameters) text += "," + csv_cell(values[name]);
    text += "\n";
  }
  return text;
}

std::string sweep_json(const Study& study, const SweepOutcome& outcome) {
  Json axes = Json::array(), list = Json::array();
  for (const StudyAxis& axis : study.axes) {
    Json values = Json::array();
    for (const config::Value& v : axis.values) values.push_back(json_of(v));
    axes.push_back({{"key", axis.key}, {"values", values}});
    if (!axis.names.empty()) axes.back()["names"] = axis.names;
  }
  for (std::size_t run = 0; run < outcome.rows.size(); ++run) {
    const SweepRow& row = outcome.rows[run];
    const auto place = study.place(run);
    Json at = Json::object(), outputs = Json::object();
    for (std::size_t i = 0; i < place.size(); ++i) at[study.axes[i].key] = json_of(study.axes[i].values[place[i]]);
    for (const std::string& output : study.outputs) {
      const double value = output_of(row, output);
      outputs[output] = std::isfinite(value) ? Json(value) : Json(nullptr);
    }
    list.push_back({{"point", run},
                    {"level", study.level_of(run)},
                    {"settings", at},
                    {"outputs", outputs},
                    {"refused", row.refused.empty() ? Json(nullptr) : Json(row.refused)},
                    {"seed", row.seed},
                    {"git", row.git}});
  }
  return Json({{"schema", 1},
               {"command", "sweep"},
               {"study", study.name},
               {"runs", outcome.rows.size()},
               {"made", outcome.made},
               {"found", outcome.found},
               {"refused", outcome.refused},
               {"axes", axes},
               {"rows", list}})
             .dump(1) +
         "\n";
}

std::string sweep_text(const Study& study, const std::vector<SweepRow>& rows, std::size_t most) {
  std::string text = fmt::format("{:<10}", "level");
  const auto width = [](const std::string& name) { return std::max<std::size_t>(name.size(), 12); };
  for (const StudyAxis& axis : study.axes) text += fmt::format("  {:>{}}", axis.key, width(axis.key));
  for (const std::string& output : study.outputs) text += fmt::format("  {:>{}}", output, width(output));
  text += "\n";
  for (std::size_t run = 0; run < std::min(rows.size(), most); ++run) {
    const auto place = study.place(run);
    text += fmt::format("{:<10}", study.level_of(run));
    for (std::size_t i = 0; i < place.size(); ++i)
      text += fmt::format("  {:>{}}", study.axes[i].text_of(place[i]), width(study.axes[i].key));
    if (!rows[run].refused.empty()) {
      text += "  refused: " + rows[run].refused + "\n";
      continue;
    }
    for (const std::string& output : study.outputs) {
      const double value = output_of(rows[run], output);
      text += fmt::format("  {:>{}}", std::isfinite(value) ? fmt::format("{:.9g}", value) : "-", width(output));
    }
    text += "\n";
  }
  if (rows.size() > most) text += fmt::format("  ... and {} more\n", rows.size() - most);
  return text;
}

bool has_picture(const Study& study) {
  const auto axes = varied(study);
  return axes.size() == 1 || axes.size() == 2;
}

scene::RgbImage sweep_picture(const Study& study, const std::vector<SweepRow>& rows, const std::string& output) {
  const auto axes = varied(study);
  DENDRO_CHECK(has_picture(study), "{} axes", axes.size());
  if (axes.size() == 1) return line_picture(study, rows, output, axes[0]);
  if (is_curves(study, axes[0], axes[1])) return curves_picture(study, rows, output, axes[0], axes[1]);
  if (is_curves(study, axes[1], axes[0])) return curves_picture(study, rows, output, axes[1], axes[0]);
  return heat_picture(study, rows, output, axes[0], axes[1]);
}

}  // namespace dendro::study
