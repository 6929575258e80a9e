#include "models/machines/sgi_4d35/function.h"

#include "models/machines/sgi_4d35/board.h"
#include "models/parts/r3000/r3000.h"

namespace dendro::sgi_4d35 {

ProgramResult run_function(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit) {
  Board board(spec.main_bytes, image, services);
  r3000::Core<Board> core(spec.processor, board);
  core.state().pc = image.start;
  core.state().next_pc = image.start + 4;
  core.state().status = 0;
  core.run(limit);
  const r3000::State& state = core.state();
  ProgramResult result;
  result.stopped = board.stopped();
  result.pc = state.pc;
  result.return_address = state.r[31];
  result.instructions = state.instructions;
  result.clock_hz = spec.clock_hz;
  result.units.push_back({"sgi_4d35.processor",
                          {{"instructions", state.instructions},
                           {"exceptions", state.exceptions},
                           {"tlb_refills", state.tlb_refills}}});
  return result;
}

}  // namespace dendro::sgi_4d35
