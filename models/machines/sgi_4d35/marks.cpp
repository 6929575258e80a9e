#include "models/machines/sgi_4d35/marks.h"

namespace dendro::sgi_4d35 {

service_block::CallResult MarkedServices::call(std::uint32_t number,
                                               const std::array<std::uint32_t, 4>& arguments,
                                               base::ZeroedBytes& memory) {
  if (number >= DENDRO_MARK_START && number <= DENDRO_MARK_LABEL) mark_ = ProgramMark{number, arguments[0]};
  return inner_.call(number, arguments, memory);
}

std::optional<ProgramMark> MarkedServices::take() {
  std::optional<ProgramMark> mark;
  mark.swap(mark_);
  return mark;
}

}  // namespace dendro::sgi_4d35
