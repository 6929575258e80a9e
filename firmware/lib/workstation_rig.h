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

  /// Runs a program that ships with dendro on a fresh machine at level `function` and returns its standard output. Throws
  /// UserError when it does not end with 0.
  virtual std::string exec(const std::string& program, const std::vector<std::string>& arguments, Files& files) const = 0;
};

}  // namespace dendro::stability
