#include "models/machines/rds3000/clocked_processor.h"

#include "models/machines/rds3000/rds3000_map.h"
#include "sim/base/bits.h"
#include "sim/base/check.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;

bool waits_for_time(unsigned cond) {
  return cond == kBusBusy || cond == kDataReady || cond == kVerticalBlank || cond == kFieldFlag ||
         cond == kHostFlag;
}

bool op_uses_pass(unsigned op) {
  switch (op) {
    case am2910::kCJS:
    case am2910::kCJP:
    case am2910::kPUSH:
    case am2910::kJSRP:
    case am2910::kCJV:
    case am2910::kJRP:
    case am2910::kCRTN:
    case am2910::kCJPP:
    case am2910::kLOOP:
    case am2910::kTWB:
      return true;
    default:
      return false;
  }
}

bool is_scratch_source(unsigned dsrc) { return dsrc == kDSpad || dsrc == kDSpadAr || dsrc == kDSpadArInc; }
bool is_scratch_destination(unsigned ydst) {
  return ydst == kYSpad || ydst == kYSpadAr || ydst == kYSpadArInc;
}

}  // namespace

ClockedProcessor::ClockedProcessor(const ProcessorSpec& spec,
                                   const std::map<std::uint32_t, std::string>& marks)
    : spec_(spec),
      marks_(marks),
      control_words_(spec.control_store_words),
      scratch_words_(spec.scratch_words) {
  DENDRO_CHECK(control_words_ % kPageWords == 0 && control_words_ > 0 && scratch_words_ > 0,
               "{} control, {} scratch words", control_words_, scratch_words_);
  state_.scratch.assign(scratch_words_, 0);
  state_.control.assign(control_words_, 0);
  words_.resize(control_words_);
}

void ClockedProcessor::decode(std::uint32_t index, Word& w) const {
  const std::uint64_t word = state_.control[index];
  const auto take = [word](const Field& f) { return static_cast<std::uint8_t>(get(word, f)); };
  w.seq = take(kSeq);
  w.cond = take(kCond);
  w.pol = take(kPol) != 0;
  w.imm = static_cast<std::uint16_t>(get(word, kImm));
  w.dest = take(kDest);
  w.func = take(kFunc);
  w.i0 = take(kI0) != 0;
  w.a = take(kA);
  w.b = take(kB);
  w.ea = take(kEa) != 0;
  w.oeb = take(kOeb) != 0;
  w.shift = static_cast<std::uint8_t>(8 * take(kLane));
  w.carry = take(kCarry);
  w.fill = take(kFill);
  w.dsrc = take(kDsrc);
  w.ydst = take(kYdst);
  w.busfn = take(kBusFn);
  w.mul = take(kMul);
  w.latch = take(kLatch) != 0;
  w.halt = take(kHalt) != 0;
  const unsigned busop = take(kBusOp);
  w.starts_access = busop == kBusRead || busop == kBusWrite;
  w.writes = busop == kBusWrite;
  w.reads_bus = w.dsrc == kDBus;
  w.uses_scratch = is_scratch_source(w.dsrc) || is_scratch_destination(w.ydst);
  w.reads_time = op_uses_pass(w.seq) && waits_for_time(w.cond);
  w.marked = marks_.count(index) != 0;
  w.decoded = true;
}

ClockedCause ClockedProcessor::tick(std::int64_t n, const ClockedSignals& in) {
  if (!state_.running) return ClockedCause::kIdle;
  const std::uint32_t index = word_index();
  Word& w = words_[index];
  if (!w.decoded) decode(index, w);

  const bool data = w.reads_bus && in.read_under_way;
  const bool bus = in.access_in_flight && (w.starts_access || spec_.accesses_in_flight == 0);
  if (n <= stolen_through_) return ClockedCause::kHost;
  if (n <= branch_through_) return ClockedCause::kBranch;
  if (data) return ClockedCause::kData;
  if (bus) return ClockedCause::kBus;
  if (w.uses_scratch) {
    if (!scratch_started_) {
      scratch_started_ = true;
      scratch_through_ = n + spec_.scratch_ticks - 2;
    }
    if (n <= scratch_through_) return ClockedCause::kScratch;
  }
  effects_.word = index;
  effects_.marked = w.marked;
  effects_.reads_time = w.reads_time;
  execute(w, n, in);
  return ClockedCause::kBusy;
}

void ClockedProcessor::steal(std::int64_t n) { stolen_through_ = n + spec_.steal_ticks; }

void ClockedProcessor::run() {
  state_.running = true;
  scratch_started_ = false;
}

void ClockedProcessor::reset() {
  ProcessorState& p = state_;
  p.pc = p.restart_pc;
  p.page = p.restart_page;
  p.depth = 0;
  if (p.product_in != 0) p.product = p.pending_product;
  p.product_in = 0;
  p.running = false;
}

std::uint32_t ClockedProcessor::host_read(std::uint32_t address) const {
  switch (device_at(address)) {
    case Device::ControlStore: {
      const std::uint32_t word = (address - kControlStore) / 2;
      if (word >= control_words_) return 0;
      return static_cast<std::uint32_t>(state_.control[word] >> ((address & 1) != 0 ? 32 : 0));
    }
    case Device::Scratchpad: {
      const std::uint32_t word = address - kScratchpad;
      return word < scratch_words_ ? state_.scratch[word] : 0;
    }
    default:
      return state_.pc | (std::uint32_t{state_.page} << 12);
  }
}

void ClockedProcessor::host_write(std::uint32_t address, std::uint32_t data) {
  ProcessorState& p = state_;
  switch (device_at(address)) {
    case Device::ControlStore: {
      const std::uint32_t word = (address - kControlStore) / 2;
      if (word >= control_words_) return;
      p.control[word] = base::with_field(p.control[word], (address & 1) != 0 ? 32 : 0, 32, data);
      words_[word].decoded = false;
      return;
    }
    case Device::Scratchpad: {
      const std::uint32_t word = address - kScratchpad;
      if (word < scratch_words_) p.scratch[word] = data;
      return;
    }
    default:
      p.z = (data & kStatusZ) != 0;
      p.n = (data & kStatusN) != 0;
      p.c = (data & kStatusC) != 0;
      p.v = (data & kStatusV) != 0;
      p.host_flag = (data & kStatusHost) != 0;
      p.restart_pc = static_cast<std::uint16_t>((data >> 16) & 0xFFF);
      p.restart_page = static_cast<std::uint8_t>((data >> 28) & 7);
  }
}

}  // namespace dendro::rds3000
