#include "sim/study/sweep_results.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace dendro::study {
namespace {

using Json = nlohmann::ordered_json;
using stats::Statement;

constexpr std::int32_t kApplication = 0x64647377;  // "ddsw"
constexpr int kVersion = 1;

constexpr const char* kSchema =
    "CREATE TABLE runs(key TEXT PRIMARY KEY, scene TEXT, machine TEXT, preset TEXT, level TEXT, seed INTEGER,"
    " git TEXT, program TEXT, image_sha256 TEXT, refused TEXT, settings TEXT, parameters TEXT);"
    "CREATE TABLE figures(run TEXT REFERENCES runs(key), name TEXT, value REAL, PRIMARY KEY(run, name))"
    " WITHOUT ROWID;";

}  // namespace

SweepResults::SweepResults(const std::string& path) : database_(path, kApplication, kVersion, kSchema) {}

bool SweepResults::has(const std::string& key) {
  return Statement(database_, "SELECT 1 FROM runs WHERE key = ?").bind(key).step();
}

std::optional<SweepRow> SweepResults::find(const std::string& key) {
  Statement run(database_,
                "SELECT scene, machine, preset, level, seed, git, image_sha256, refused, parameters FROM runs WHERE"
                " key = ?");
  if (!run.bind(key).step()) return std::nullopt;
  SweepRow row;
  row.scene = run.text(0);
  row.machine = run.text(1);
  row.preset = run.text(2);
  row.level = run.text(3);
  row.seed = static_cast<std::uint64_t>(run.integer(4));
  row.git = run.text(5);
  row.image_sha256 = run.text(6);
  row.refused = run.text(7);
  const Json parameters = Json::parse(run.text(8));
  for (const auto& [name, value] : parameters.items())
    row.parameters.emplace_back(name, value.get<std::string>());
  Statement figures(database_, "SELECT name, value FROM figures WHERE run = ?");
  figures.bind(key);
  while (figures.step())
    if (const auto value = figures.real(1)) row.figures[figures.text(0)] = *value;
  return row;
}

void SweepResults::store(const std::string& key, const SweepRow& row, const std::vector<std::string>& settings) {
  Json parameters = Json::object();
  for (const auto& [name, value] : row.parameters) parameters[name] = value;
  stats::Transaction transaction(database_);
  Statement(database_, "INSERT INTO runs VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(key)
      .bind(row.scene)
      .bind(row.machine)
      .bind(row.preset)
      .bind(row.level)
      .bind(static_cast<std::int64_t>(row.seed))
      .bind(row.git)
      .bind(executable_digest())
      .bind(row.image_sha256)
      .bind(row.refused)
      .bind(Json(settings).dump())
      .bind(parameters.dump())
      .run();
  Statement figure(database_, "INSERT INTO figures VALUES(?, ?, ?)");
  for (const auto& [name, value] : row.figures) figure.bind(key).bind(name).bind(value).run();
  transaction.commit();
}

SweepRow refused_row(const RunRequest& request, const std::string& why, const std::string& git) {
  SweepRow row;
  row.refused = why;
  row.scene = request.file.scene.name;
  row.machine = request.type->name;
  row.preset = request.preset.name;
  row.level = level_name(request.level);
  row.seed = request.file.scene.seed;
  row.git = git;
  for (const config::Parameter& p : request.preset.parameters.all())
    row.parameters.emplace_back(p.key, config::to_text(p.value));
  return row;
}

SweepRow row_of(const RunRequest& request, const RunOutput& output, const std::string& git) {
  SweepRow row = refused_row(request, "", git);
  row.image_sha256 = output.object.image.sha256;
  for (const auto& [name, value] : stats::figures(output.object)) row.figures[name] = value;
  return row;
}

std::string git_state() {
  std::FILE* pipe = ::popen("git describe --always --abbrev=40 --exclude '*' --dirty 2>/dev/null", "r");
  if (pipe == nullptr) return "none";
  std::string text;
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  const int status = ::pclose(pipe);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return status == 0 && !text.empty() ? text : "none";
}

}  // namespace dendro::study
