#pragma once

#include <map>
#include <optional>

#include "models/parts/service_block/service_block.h"

namespace dendro::study {

/// The calls of a program carried out by this process: its own standard input and output, files by their host
/// paths.
class HostServices : public service_block::Services {
 public:
  struct Fault {
    std::uint32_t cause = 0, epc = 0, address = 0, fpu = 0;
  };

  HostServices() = default;
  ~HostServices() override;
  HostServices(const HostServices&) = delete;
  HostServices& operator=(const HostServices&) = delete;

  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>& arguments,
                                 std::vector<std::uint8_t>& memory) override;

  std::optional<int> exit_code;
  std::optional<Fault> fault;  ///< the monitor gave the program up

 private:
  service_block::CallResult open_file(const std::array<std::uint32_t, 4>& a,
                                      const std::vector<std::uint8_t>& memory);
  service_block::CallResult transfer(bool in, const std::array<std::uint32_t, 4>& a,
                                     std::vector<std::uint8_t>& memory);
  int host_file(std::uint32_t file) const;

  std::map<std::uint32_t, int> files_;  ///< the program's numbers from 3 on
};

}  // namespace dendro::study
