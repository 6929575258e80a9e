#include <algorithm>

#include "models/machines/sgi_4d35/boundaries.h"
#include "models/machines/sgi_4d35/recorder.h"
#include "models/parts/r3000/r3000.h"

namespace dendro::sgi_4d35 {

ProgramResult run_recorded(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, trace::Writer& out) {
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board, RecordedPipeline> core(spec.processor, board, spec, board, out);
  start(core.state(), image);
  RecordedPipeline& time = core.time();
  const std::uint64_t block = spec.bus.first_word_cycles + std::uint64_t{kMostBlockWords} * spec.bus.word_cycles;
  const std::uint64_t longest =
      256 + 3 * block + (spec.bus.entries + 1) * std::uint64_t{std::max(spec.bus.write_cycles, spec.bus.page_write_cycles)};
  const auto from = static_cast<std::uint64_t>(out.from());
  std::uint64_t left = limit;
  while (left != 0 && !board.stopped()) {
    std::uint64_t words = left;
    if (!time.watching() && !time.ended()) {
      const std::uint64_t most = from > time.bias ? (from - time.bias) / longest : 0;
      if (most == 0) {
        time.watch();
        core.go_carefully();
      } else {
        words = std::min(left, most);
      }
    }
    left -= words - core.run(words);
  }
  ProgramResult result = result_of(core.state(), board, spec);
  Counters counters;
  if (limit != 0) {
    core.settle();
    counters = time.counters(core.state().instructions, time.bias);
  }
  result.cycles = static_cast<std::int64_t>(counters.cycles);
  result.units = units_of(counters, r3000::counters_of(core.state()));
  return result;
}

}  // namespace dendro::sgi_4d35
