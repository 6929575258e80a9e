#pragma once

#include <fstream>

#include "tests/firmware/mips/shell.h"
#include "firmware/zbuffer_views/stability/program_files.h"

namespace dendro::zbuffer_views {

using mips::Ran;
using mips::read_file;

inline std::string write_file(const std::string& name, const std::string& bytes) {
  const std::string path = mips::scratch() + "/" + name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline std::string program(const std::string& name) {
  return std::string(MIPS_FOLDER) + "/zbuffer_views_" + name + ".elf";
}

/// A program on files of the scratch folder; what it wrote to its last argument.
inline std::string made_by(const std::string& command, const std::string& result) {
  std::remove(result.c_str());
  const Ran ran = mips::run(command);
  EXPECT_EQ(0, ran.status) << command << "\n" << ran.errors;
  EXPECT_EQ("", ran.errors) << command;
  EXPECT_EQ("", ran.output) << command;
  return read_file(result);
}

/// The views' file of a tree, by qemu-mips.
inline std::string precomputed(const TreeFile& tree, const JobFile& job) {
  const std::string tree_path = write_file("tree", tree.bytes()), job_path = write_file("job", job.bytes()),
                    views_path = mips::scratch() + "/views";
  return made_by(mips::qemu(program("precompute"), job_path + " " + tree_path + " " + views_path),
                 views_path);
}

inline Pictures drawn(const std::string& name, const std::string& from, const JobFile& job) {
  const std::string from_path = write_file("from", from), job_path = write_file("job", job.bytes()),
                    pictures_path = mips::scratch() + "/pictures";
  return Pictures::parse(
      made_by(mips::qemu(program(name), job_path + " " + from_path + " " + pictures_path), pictures_path));
}

inline Pictures reconstructed(const std::string& views, const JobFile& job) {
  return drawn("reconstruct", views, job);
}

}  // namespace dendro::zbuffer_views
