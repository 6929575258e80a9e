#include <algorithm>
#include <set>
#include <sstream>

#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
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

TEST_F(OptionKeys, OfEveryAlgorithmAreThoseThatItsJobReads) {
  const std::string mesh = write("m.obj", kTetrahedron);
  const std::vector<MachineType> types = {rds3000::rds3000_type(), pixel_planes::pixel_planes_type()};
  const Catalogue all{types, algorithms(), "/nowhere"};
  for (const Algorithm& algorithm : algorithms()) {
    // Machines, and one object and two, may be drawn by different programs with keys of their own.
    std::set<std::string> read;
    for (const MachineType& type : types) {
      if (std::find(algorithm.machines.begin(), algorithm.machines.end(), type.name) == algorithm.machines.end()) continue;
      const config::Preset preset = config::load_preset(type.name, all.presets(), {});
      for (const int objects : {1, 2}) {
        std::string text = "algorithm = \"" + algorithm.name +
                           "\"\n[image]\nwidth = 8\nheight = 8\n[camera]\nheight = 4\nposition = [0, 0, 4]\n";
        for (int i = 0; i < objects; ++i) text += "[[object]]\nmesh = \"" + mesh + "\"\n";
        SceneFile file = load_scene(write("s.toml", text), {}, all);
        file.scene.options.set(std::string(60, 'z'), {std::int64_t{1}, {}});
        std::string message = "no error";
        try {
          algorithm.make(file.scene, type, preset.parameters);
        } catch (const UserError& error) {
          message = error.message();
        }
        for (const std::string& key : keys_in(message)) read.insert(key);
      }
    }
    std::vector<std::string> declared = algorithm.option_keys;
    std::sort(declared.begin(), declared.end());
    EXPECT_EQ(std::vector<std::string>(read.begin(), read.end()), declared) << algorithm.name;
  }
}

}  // namespace
}  // namespace dendro::study
