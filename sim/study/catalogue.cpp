#include "sim/study/catalogue.h"

#include <filesystem>

#include "sim/base/sha256.h"

namespace dendro::study {
namespace {

std::filesystem::path executable() {
  std::error_code error;
  const auto path = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : path;
}

}  // namespace

const MachineType* Catalogue::machine(const std::string& name) const {
  for (const MachineType& m : machines)
    if (m.name == name) return &m;
  return nullptr;
}

const Algorithm* Catalogue::algorithm(const std::string& name) const {
  for (const Algorithm& a : algorithms)
    if (a.name == name) return &a;
  return nullptr;
}

std::vector<config::MachinePresets> Catalogue::presets() const {
  std::vector<config::MachinePresets> all;
  for (const MachineType& m : machines) all.push_back({m.name, m.folder, m.presets});
  return all;
}

std::string share_folder() {
  const auto folder = executable().parent_path();
  for (const auto& share : {folder / "share/dendro", folder.parent_path() / "share/dendro"}) {
    std::error_code error;
    if (std::filesystem::is_directory(share, error)) return share.string();
  }
  return (folder / "share/dendro").string();
}

std::string executable_digest() {
  static const std::string digest = base::sha256_file("/proc/self/exe");
  return digest;
}

std::string compiler_name() {
#ifdef __clang__
  const std::string name = "clang ";
#else
  const std::string name = "gcc ";
#endif
#ifdef NDEBUG
  const std::string build = ", release, ";
#else
  const std::string build = ", debug, ";
#endif
#ifdef __x86_64__
  const std::string target = "x86_64";
#else
  const std::string target = sizeof(void*) == 8 ? "64 bits" : "32 bits";
#endif
  return name + __VERSION__ + build + target;
}

}  // namespace dendro::study
