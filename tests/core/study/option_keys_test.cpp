#include <algorithm>
#include <functional>
#include <set>
#include <sstream>

#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/study/algorithms.h"
#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

using OptionKeys = fake::TestFolder;

const char* const kTetrahedron =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 2 4\nf 1 3 2\nf 1 4 3\nf 2 3 4\n";

/// The keys that a job has asked for, as its error about a key that is like none of them lists them.
std::vector<std::string> keys_in(std::string message) {
  const std::string before = "allowed: ";
  const auto at = message.find(before);
  if (at == std::string::npos) return {message};
  message.erase(0, at + before.size());
  message.erase(std::remove(message.begin(), message.end(), ','), message.end());
  std::istringstream words(message);
  return {std::istream_iterator<std::string>(words), {}};
}

/// What the jobs of one machine read.
std::set<std::string> keys_read(const Algorithm& algorithm, const MachineType& type, const Catalogue& all,
                                const std::string& mesh, const std::function<std::string(const std::string&)>& write) {
  std::set<std::string> read;
  if (std::find(algorithm.machines.begin(), algorithm.machines.end(), type.name) == algorithm.machines.end()) return read;
  const config::Preset preset = config::load_preset(type.name, all.presets(), {});
  // One object, two, and one with a trunk may be drawn by different programs with keys of their own.
  for (const auto& [objects, trunk] : {std::pair(1, false), {2, false}, {1, true}}) {
    std::string text = "algorithm = \"" + algorithm.name +
                       "\"\n[image]\nwidth = 64\nheight = 64\n[camera]\nheight = 4\nposition = [0, 0, 4]\n";
    for (int i = 0; i < objects; ++i) text += "[[object]]\nmesh = \"" + mesh + "\"\n";
    if (trunk) text += "trunk = \"cone\"\n";
    SceneFile file = load_scene(write(text), {}, all);
    file.scene.options.set(std::string(60, 'z'), {std::int64_t{1}, {}});
    std::string message = "no error";
    try {
      algorithm.make(file.scene, type, preset.parameters);
    } catch (const UserError& error) {
      message = error.message();
    }
    // An algorithm may refuse a trunk; its other two scenes say what it reads.
    if (trunk && message.find("is not for this algorithm") != std::string::npos) continue;
    for (const std::string& key : keys_in(message)) read.insert(key);
  }
  return read;
}

TEST_F(OptionKeys, OfEveryAlgorithmAreThoseThatItsJobsRead) {
  const std::string mesh = write("m.obj", kTetrahedron);
  const Catalogue all{{rds3000::rds3000_type(), pixel_planes::pixel_planes_type(), sgi_4d35::sgi_4d35_type()}, algorithms(), "/nowhere"};
  for (const Algorithm& algorithm : algorithms()) {
    std::set<std::string> read;
    for (const MachineType& type : all.machines)
      read.merge(keys_read(algorithm, type, all, mesh, [&](const std::string& text) { return write("s.toml", text); }));
    std::vector<std::string> declared = algorithm.option_keys;
    std::sort(declared.begin(), declared.end());
    EXPECT_EQ(std::vector<std::string>(read.begin(), read.end()), declared) << algorithm.name;
  }
}

}  // namespace
}  // namespace dendro::study
