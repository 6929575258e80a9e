#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace dendro::mips {

struct Ran {
  std::string output, errors;
  int status = -1;
};

inline std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of this test's own.
inline std::string scratch() {
  const std::string folder = testing::TempDir() + "dendro_mips_" + std::to_string(::getpid());
  if (std::system(("mkdir -p " + folder).c_str()) != 0) ADD_FAILURE() << folder;
  return folder;
}

/// Runs a command of the shell; its standard output and error apart.
inline Ran run(const std::string& command) {
  const std::string errors = scratch() + "/errors";
  Ran ran;
  FILE* pipe = ::popen((command + " 2>" + errors).c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t got; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    ran.output.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  ran.errors = read_file(errors);
  return ran;
}

inline std::string program_file(const std::string& name) {
  return std::string(MIPS_FOLDER) + "/" + name + ".elf";
}
inline std::string elf(const std::string& name) { return program_file("mips_" + name); }
inline std::string model(const std::string& file, const std::string& arguments = "",
                         const std::string& options = "") {
  return std::string(DENDRO) + " exec sgi-4d35 " + file + " --quiet " + options +
         (arguments.empty() ? "" : " -- " + arguments);
}
inline std::string qemu(const std::string& file, const std::string& arguments = "") {
  return std::string(QEMU_MIPS) + " " + file + " " + arguments;
}

}  // namespace dendro::mips
