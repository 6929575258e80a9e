#include "models/machines/pixel_planes/cycle_board.h"

#include <fmt/format.h>

#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {

CycleBoard::Offered CycleBoard::offer(std::int64_t host_ps, std::uint32_t word) {
  Offered offered;
  offered.host_ps = timing_.offer_word(host_ps);
  ++command_words_;
  offered.done = device_.write(kFifo, word);
  if (!offered.done) return offered;
  const igc::Header& header = offered.done->command.header;
  offered.times = timing_.command(command_words_, header.expression && !header.register_write, offered.done->words);
  command_words_ = 0;
  if (offered.done->program_words > 0) in_use_.push_back({header.entry, offered.done->program_words, offered.times.free});
  return offered;
}

void CycleBoard::write(std::int64_t host_ps, std::uint32_t address, std::uint32_t value) {
  if (address < kControlStoreEnd) check_not_in_use(host_ps, address);
  device_.write(address, value);
}

// A command is carried out when its last word is offered, with the program as it is then.
void CycleBoard::check_not_in_use(std::int64_t host_ps, std::uint32_t address) {
  const std::int64_t now = host_ps / spec_.tick_ps;
  const unsigned word = address / 2;
  // What is written in a clock is seen from the next.
  while (!in_use_.empty() && in_use_.front().free <= now + 1) in_use_.pop_front();
  for (const InUse& use : in_use_)
    if ((word - use.entry) % igc::kStoreWords < use.words)
      throw UserError(fmt::format("word {} of the control store is written while a command that runs it is not done: what comes "
                                  "out shows at level clocked only",
                                  word));
}

bool CycleBoard::busy(std::int64_t host_ps) const {
  return command_words_ > 0 || host_ps / spec_.tick_ps < timing_.idle_from();
}

}  // namespace dendro::pixel_planes
