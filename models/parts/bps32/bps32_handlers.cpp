#include <array>
#include <utility>

#include "models/parts/bps32/bps32_execute.h"

// One function per shape of a plain ALU word: what execute_data() decides at run time is decided at decode here. The tests
// hold both against each other.
namespace dendro::bps32 {
namespace {

enum RSource { kRRam, kRBus, kRSources };
enum SSource { kSRam, kSBus, kSQ, kSSources };
constexpr unsigned kShapes = 16 * kRSources * kSSources * 2 * 2 * 2;

template <unsigned Shape>
void handle(ProcessorState& p, const Decoded& d) {
  constexpr unsigned func = Shape % 16;
  constexpr unsigned r_source = Shape / 16 % kRSources;
  constexpr unsigned s_source = Shape / 16 / kRSources % kSSources;
  constexpr unsigned rest = Shape / 16 / kRSources / kSSources;
  constexpr bool latch = rest % 2, writes_ram = rest / 2 % 2, writes_y = rest / 4 % 2;
  std::uint32_t bus = 0;
  if constexpr (r_source == kRBus || s_source == kSBus) bus = turned_d_bus(p, d);
  const std::uint32_t r = r_source == kRBus ? bus : p.ram[d.a];
  const std::uint32_t s = s_source == kSQ ? p.q : s_source == kSBus ? bus : p.ram[d.b];
  const AluResult result = plain_alu(func, r, s, carry_in(p, d));
  if constexpr (writes_ram) p.ram[d.b] = result.y;
  if constexpr (latch) latch_flags(p, result);
  if constexpr (writes_y) write_y(p, d, result.y);
}

template <std::size_t... Shape>
constexpr std::array<AluHandler, sizeof...(Shape)> table(std::index_sequence<Shape...>) {
  return {&handle<Shape>...};
}

constexpr std::array<AluHandler, kShapes> kHandlers = table(std::make_index_sequence<kShapes>());

}  // namespace

AluHandler alu_handler(const Decoded& d) {
  const unsigned s_source = d.i0 ? kSQ : d.oeb ? kSBus : kSRam;
  const bool writes_y = d.ydst != kYNone || d.dsrc == kDSpadArInc;
  unsigned shape = (writes_y * 2u + d.writes_ram) * 2u + d.latch;
  shape = (shape * kSSources + s_source) * kRSources + d.ea;
  return kHandlers[shape * 16 + d.func];
}

}  // namespace dendro::bps32
