#pragma once

#include <assimp/IOSystem.hpp>
#include <set>
#include <string>

namespace dendro::scene {

/// The bytes of a file, inflated if its name ends in .gz. Throws UserError naming the file when it cannot be
/// read, is not a regular file, or is a damaged or truncated .gz.
std::string read_bytes(const std::string& path);

/// The files of one mesh as the reader sees them: the main file under its name without .gz, everything that
/// it refers to under its own name. Remembers what was opened.
class MeshFiles : public Assimp::IOSystem {
 public:
  MeshFiles(std::string main_name, std::string main_bytes);

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  /// Paths opened beside the main file, as the reader spelled them.
  const std::set<std::string>& others() const { return others_; }

 private:
  std::string main_name_;
  std::string main_bytes_;
  std::set<std::string> others_;
};

}  // namespace dendro::scene
