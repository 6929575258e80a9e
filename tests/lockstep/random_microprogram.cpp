#include "tests/lockstep/random_microprogram.h"

#include <algorithm>

#include "models/machines/rds3000/rds3000_map.h"
#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/ik11b/ik11b_isa.h"

namespace dendro::test {
namespace {

using namespace bps32;

constexpr unsigned kRoutine = 3800;  // a leaf subroutine at the end of the page
constexpr unsigned kRoutineWords = 6;

class Generator {
 public:
  Generator(std::uint64_t seed, const Flavour& flavour) : random_(seed), flavour_(flavour) {}

  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }
  bool once_in(unsigned n) { return below(n) == 0; }
  std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }

  rds3000::Spec spec() {
    rds3000::Spec spec;
    const std::int64_t ticks[] = {200000, 200000, 150000, 170001};
    spec.processor.tick_ps = ticks[below(4)];
    spec.processor.multiply_ticks = 1 + static_cast<int>(below(4));
    spec.processor.taken_branch_ticks = once_in(2) ? 0 : static_cast<int>(below(3));
    spec.processor.scratch_ticks = 1 + static_cast<int>(once_in(3) ? below(3) : 0);
    spec.processor.accesses_in_flight = once_in(4) ? 0 : 1;
    spec.processor.steal_ticks = static_cast<int>(below(3));
    spec.bus.arbitration_ticks = once_in(2) ? 0 : static_cast<int>(below(3));
    spec.bus.write_ticks = 1 + static_cast<int>(below(2));
    spec.bus.register_read_ticks = 1 + static_cast<int>(below(4));
    const unsigned shapes[][2] = {{3, 1}, {4, 1}, {3, 2}};
    const auto& shape = shapes[below(3)];
    spec.memory.cards_per_bank = shape[0];
    spec.memory.banks = shape[1];
    spec.memory.card_busy_ticks = 1 + static_cast<int>(below(4));
    spec.memory.read_ticks = 1 + static_cast<int>(below(6));
    spec.memory.masked_write_extra_ticks = static_cast<int>(below(4));
    spec.memory.fetch_ticks = static_cast<int>(below(4));
    spec.memory.refresh_interval_ps = once_in(2) ? 0 : 6000000 + below(12000000);
    const video::DisplayMode modes[] = {video::DisplayMode::kBlanked, video::DisplayMode::kLores30,
                                        video::DisplayMode::kLores60, video::DisplayMode::kHires30};
    spec.video.mode = modes[below(4)];
    // Into the active lines, or the fetches would begin long after a short program's end.
    spec.video.phase_ps = once_in(4) ? 0 : std::int64_t{1000} * (3000000 + below(12000000));
    spec.host.word_ps = 500000 + below(3000000);
    spec.host.dma_start_ps = below(100000000);
    spec.host.register_ps = 100000 + below(1000000);
    spec.host.program_load_ps = 0;
    spec.host.interrupt_ps = below(10000000);
    return spec;
  }

  std::uint64_t any_word() {
    std::uint64_t w = random_();
    w = put(w, kSeq, am2910::kCONT);
    w = put(w, kHalt, 0);
    if (once_in(3)) w = put(w, kDest, kRamAlso);
    const bool access = once_in(3);
    w = put(w, kBusOp, access ? kBusRead + below(2) : 0u + kBusIdle);
    const unsigned functions[] = {kFnLores, kFnLores, kFnLores, kFnWord, kFnHires, kFnMaskLores, kFnMaskWord};
    if (!once_in(8)) w = put(w, kBusFn, functions[below(7)]);
    // Most addresses should be memory, so most address writes take halves of it.
    const unsigned ydst = get(w, kYdst);
    if (ydst == kYBusAddress && !once_in(4)) w = put(w, kYdst, kYBusX);
    if (ydst == kYSeq) w = put(w, kYdst, kYBusX);
    if (ydst == kYBusY) w = y_of_a_line(w);
    return w;
  }

  // Puts a line address into the upper half: bits above 13 of a 14-bit half would leave image memory.
  std::uint64_t y_of_a_line(std::uint64_t w) {
    w = put(w, kFunc, kPassR);
    w = put(w, kDest, kYOnly);
    w = put(w, kI0, 0);
    w = put(w, kEa, 1);
    w = put(w, kLane, 0);
    w = put(w, kDsrc, kDImm);
    return put(w, kImm, below(2) * 1024 + below(1024));
  }

  unsigned condition() {
    for (;;) {
      const unsigned cond = below(16);
      const bool time = cond == kBusBusy || cond == kDataReady || cond == kVerticalBlank || cond == kFieldFlag ||
                        cond == kHostFlag;
      if (!time || flavour_.reads_time) return cond;
    }
  }

  std::vector<std::uint64_t> program() {
    std::vector<std::uint64_t> words(kPageWords, nop());
    const unsigned length = 40 + below(200);
    unsigned at = 0;
    while (at < length) {
      const unsigned kind = below(12);
      if (kind == 0) {
        at = loop(words, at);
      } else if (kind <= 2) {
        words[at] = branch(at, length);
        ++at;
      } else if (kind == 3) {
        words[at] = call();
        ++at;
      } else {
        words[at++] = any_word();
      }
    }
    // Branches may fly over the end of a loop, so there are halts behind everything they can reach.
    for (unsigned i = at; i < at + 40; ++i) words[i] = put(nop(), kHalt, 1);
    for (unsigned i = 0; i < kRoutineWords; ++i) words[kRoutine + i] = any_word();
    words[kRoutine + kRoutineWords] = put(any_word(), kSeq, am2910::kCRTN);
    words[kRoutine + kRoutineWords] = put(put(words[kRoutine + kRoutineWords], kCond, kAlways), kPol, 0);
    return words;
  }

 private:
  std::uint64_t branch(unsigned at, unsigned length) {
    const unsigned ops[] = {am2910::kCJP, am2910::kCJV, am2910::kCJPP, am2910::kCRTN + 0u};
    std::uint64_t w = put(any_word(), kSeq, ops[below(3)]);
    w = put(put(w, kCond, condition()), kPol, below(2));
    return put(w, kImm, at + 1 + below(std::min(12u, length - at + 4)));
  }

  std::uint64_t call() {
    std::uint64_t w = put(any_word(), kSeq, am2910::kCJS);
    w = put(put(w, kCond, condition()), kPol, below(2));
    return put(w, kImm, kRoutine);
  }

  // LDCT, body, RPCT; or PUSH, body, RFCT. The counter is set just before, so the loop ends.
  unsigned loop(std::vector<std::uint64_t>& words, unsigned at) {
    const bool push = once_in(2);
    std::uint64_t head = put(any_word(), kSeq, push ? am2910::kPUSH : am2910::kLDCT);
    head = put(put(head, kCond, kAlways), kPol, 0);
    words[at++] = put(head, kImm, below(20));
    const unsigned body = at;
    const unsigned count = 1 + below(5);
    for (unsigned i = 0; i < count; ++i) words[at++] = any_word();
    std::uint64_t tail = put(any_word(), kSeq, push ? am2910::kRFCT : am2910::kRPCT);
    words[at++] = put(tail, kImm, body);
    return at;
  }

  std::mt19937_64 random_;
  Flavour flavour_;
};

// Sends program and data, runs, meddles if asked, and waits.
HostProgram host_program(const std::vector<std::uint64_t>& words, const std::vector<std::uint32_t>& scratch,
                         std::uint64_t seed, bool meddles) {
  return [=](HostPort& host) {
    Generator g(seed ^ 0x5EED, {});
    std::vector<std::uint32_t> halves;
    for (std::size_t i = 0; i < 400; ++i) {
      halves.push_back(static_cast<std::uint32_t>(words[i]));
      halves.push_back(static_cast<std::uint32_t>(words[i] >> 32));
    }
    host.dma_to(rds3000::kControlStore, halves.data(), halves.size(), 0, 1);
    halves.clear();
    for (std::size_t i = kRoutine; i < kRoutine + 8; ++i) {
      halves.push_back(static_cast<std::uint32_t>(words[i]));
      halves.push_back(static_cast<std::uint32_t>(words[i] >> 32));
    }
    host.dma_to(rds3000::kControlStore + 2 * kRoutine, halves.data(), halves.size(), 0, 1);
    host.dma_to(rds3000::kScratchpad, scratch.data(), scratch.size(), 0, 1);
    std::vector<std::uint32_t> pixels(64);
    for (std::uint32_t& pixel : pixels) pixel = g.bits();
    host.dma_to(0, pixels.data(), pixels.size(), kFnLores, 2);
    host.write(rds3000::kProcessor, 0, 0);
    host.command(ik11b::kRun | ik11b::kReset);
    host.command(ik11b::kRun);
    if (meddles) {
      for (int i = 0; i < 12; ++i) {
        Work work;
        work.flops = g.below(3);
        host.compute(work);
        switch (g.below(6)) {
          case 0: host.read(g.bits() & 0x7FFFFF, kFnLores); break;
          case 1: host.write(g.bits() & 0xFFFFF, g.bits(), kFnLores); break;
          case 2: host.write(rds3000::kScratchpad + g.below(64), g.bits(), 0); break;
          case 3: host.read(rds3000::kScratchpad + g.below(64), 0); break;
          case 4: host.write(rds3000::kLookUpTable + g.below(1024), g.bits(), 0); break;
          default: host.dma_to(g.bits() & 0xFFFFF, pixels.data(), 5, kFnWord, 1); break;
        }
      }
    }
    host.wait_interrupt();
    std::vector<std::uint32_t> back(16);
    host.dma_from(0, back.data(), back.size(), kFnLores, 2);
  };
}

}  // namespace

RandomRun random_run(std::uint64_t seed, const Flavour& flavour) {
  Generator g(seed, flavour);
  RandomRun run;
  run.spec = g.spec();
  if (flavour.host_meddles) run.spec.host.flop_ps = 1 + g.below(20000000);
  run.words = g.program();
  for (int i = 0; i < 64; ++i) run.scratch.push_back(g.bits());
  run.host = host_program(run.words, run.scratch, seed, flavour.host_meddles);
  return run;
}

}  // namespace dendro::test
