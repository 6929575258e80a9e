#include "models/machines/sgi_4d35/function.h"

#include <algorithm>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/debug.h"
#include "models/parts/r3000/r3000.h"

namespace dendro::sgi_4d35 {

ProgramResult run_function(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, const MachineOptions& options) {
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board> core(spec.processor, board);
  start(core.state(), image);
  const auto run = [&core](std::uint64_t words) { return core.run(words); };
  std::uint64_t left = debugged(options.debugger, core, run, board, limit);
  while (left != 0 && !board.stopped()) {
    const std::uint64_t words = std::min(left, kProgressWords);
    left -= words - core.run(words);
    if (options.progress) options.progress(0);
  }
  const r3000::State& state = core.state();
  ProgramResult result = result_of(state, board, spec);
  result.units.push_back({"sgi_4d35.processor",
                          {{"instructions", state.instructions},
                           {"exceptions", state.exceptions},
                           {"tlb_refills", state.tlb_refills}}});
  return result;
}

}  // namespace dendro::sgi_4d35
