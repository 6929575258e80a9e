#pragma once

#include <optional>
#include <vector>

#include "models/machines/machine.h"

namespace dendro::sgi_4d35 {

/// Hands all calls on and remembers the last mark among them.
class MarkedServices : public service_block::Services {
 public:
  explicit MarkedServices(service_block::Services& inner) : inner_(inner) {}
  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>& arguments,
                                 base::ZeroedBytes& memory) override;
  /// The mark called since the last time, without its instructions and cycles.
  std::optional<ProgramMark> take();

 private:
  service_block::Services& inner_;
  std::optional<ProgramMark> mark_;
};

}  // namespace dendro::sgi_4d35
