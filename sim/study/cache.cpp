#include "sim/study/cache.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "sim/base/sha256.h"
#include "sim/study/file_cache.h"
#include "sim/study/worker.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;

/// Digest of a file, or of its absence: the run itself says what is wrong with it.
std::string digest_or_nothing(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) ? base::sha256_file(path) : "nothing";
}

/// A mesh brings files beside it that it names itself, so its whole folder counts.
std::string mesh_digests(const std::string& mesh) {
  std::string text = digest_or_nothing(mesh);
  std::error_code error;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(mesh).parent_path(), error))
    if (entry.path().stem() == fs::path(mesh).stem()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) text += file + digest_or_nothing(file);
  return text;
}

}  // namespace

RunCache::RunCache() : folder_(cache_root()) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || ::access(folder_.c_str(), W_OK) != 0) folder_.clear();
}

std::string RunCache::key(const RunRequest& request) {
  const SceneFile& file = request.file;
  std::string text = executable_digest() + "\n" + level_name(request.level) + "\n" + request.type->name +
                     ":" + request.preset.name + "\n" + std::to_string(file.scene.seed) + "\n" +
                     file.scene.name + "\n";
  text += std::to_string(request.options.tick_limit) + (request.options.all_units ? " all" : "") + "\n";
  text += request.with_picture ? "picture\n" : "\n";
  for (const auto& [at, name] : request.options.counted) text += std::to_string(at) + " " + name + "\n";
  text += config::to_toml(file.document) + "\n";
  for (const config::Parameter& p : request.preset.parameters.all())
    text += p.key + " = " + config::to_text(p.value) + " " + p.source + "\n";
  for (const scene::Object& object : file.scene.objects)
    if (!object.mesh.empty()) text += mesh_digests(object.mesh) + "\n";
  return base::sha256(text);
}

std::optional<std::string> RunCache::find(const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  std::ifstream in(folder_ + "/" + key, std::ios::binary);
  if (!in) return std::nullopt;
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  // A line with the digest of the rest tells a whole entry from a damaged one.
  const auto end = bytes.find('\n');
  if (end == std::string::npos || base::sha256(bytes.substr(end + 1)) != bytes.substr(0, end))
    return std::nullopt;
  return bytes.substr(end + 1);
}

void RunCache::store(const std::string& key, const std::string& bytes) const {
  if (folder_.empty()) return;
  const std::string path = folder_ + "/" + key;
  const std::string work = path + ".partial-" + std::to_string(::getpid());
  std::error_code ignored;
  {
    std::ofstream out(work, std::ios::binary);
    out << base::sha256(bytes) << '\n' << bytes;
    out.close();
    if (!out) {
      fs::remove(work, ignored);
      return;
    }
  }
  fs::rename(work, path, ignored);
}

RunMaker worker_runs(int jobs, Progress* progress, const std::string& name, const RunCache* cache,
                     Pictures pictures) {
  return [=](std::vector<RunRequest> requests) {
    std::vector<Outcome> outcomes(requests.size());
    std::vector<std::string> keys(requests.size());
    std::vector<std::size_t> missing;
    std::vector<std::function<std::string()>> tasks;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      RunRequest& request = requests[i];
      request.with_picture = pictures == Pictures::kCompared;
      if (cache) keys[i] = RunCache::key(request);
      auto found = cache ? cache->find(keys[i]) : std::nullopt;
      if (found) {
        outcomes[i].bytes = std::move(*found);
        continue;
      }
      missing.push_back(i);
      tasks.push_back([&request] {
        RunOutput output = execute(request, "", nullptr);
        output.rgb.clear();
        return to_bytes(output);
      });
    }
    std::size_t done = 0;
    if (progress) progress->runs(name, done, tasks.size());
    std::vector<Outcome> made = run_in_workers(tasks, jobs, [&](std::size_t n, const Outcome& outcome) {
      if (cache && !outcome.error) cache->store(keys[missing[n]], outcome.bytes);
      if (progress) progress->runs(name, ++done, tasks.size());
    });
    for (std::size_t n = 0; n < made.size(); ++n) outcomes[missing[n]] = std::move(made[n]);
    if (progress) progress->clear();
    return outcomes;
  };
}

}  // namespace dendro::study
