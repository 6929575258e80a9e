#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace dendro::stability {

/// Files by name, as programs of a workstation read and write them.
using Files = std::map<std::string, std::vector<std::uint8_t>>;

/// What a rig also is when its machine is a workstation.
class WorkstationRig {
 public:
  virtual ~WorkstationRig() = default;

  /// The bytes of a program that ships with dendro.
  virtual std::string program_bytes(const std::string& program) const = 0;

  /// Runs a program on a fresh machine at level `function` and returns its standard output. Throws UserError when it does not
  /// end with 0.
  virtual std::string exec(const std::string& program, const std::vector<std::string>& arguments, Files& files) const {
    return exec_bytes(program, program_bytes(program), arguments, files);
  }
  /// The same of other bytes; `program` is their name in messages.
  virtual std::string exec_bytes(const std::string& program, const std::string& bytes, const std::vector<std::string>& arguments,
                                 Files& files) const = 0;
};

}  // namespace dendro::stability
