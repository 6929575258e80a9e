#include "models/machines/sgi_4d35/clocked_pipeline.h"

namespace dendro::sgi_4d35 {

using r3000::Op;

namespace {

bool is_load(Op op) { return (op >= Op::kLb && op <= Op::kLwr) || op == Op::kLwc1; }
bool is_store(Op op) { return (op >= Op::kSb && op <= Op::kSwr) || op == Op::kSwc1; }
/// lwl, lwr, swl, swr: any address of a word.
bool is_unaligned(Op op) { return op == Op::kLwl || op == Op::kLwr || op == Op::kSwl || op == Op::kSwr; }
bool is_partial(Op op) { return op != Op::kSw && op != Op::kSwc1; }

/// Bytes that the access names, as its alignment and a device see it.
unsigned size_of(Op op) {
  switch (op) {
    case Op::kLb:
    case Op::kLbu:
    case Op::kSb:
    case Op::kSwl:
    case Op::kSwr:
      return 1;
    case Op::kLh:
    case Op::kLhu:
    case Op::kSh:
      return 2;
    default:
      return 4;
  }
}

}  // namespace

ClockedCause ClockedPipeline::look_at_mem() {
  ClockedSlot& m = *mem_;
  if (!m.live) return kHolds;
  if (!m.faulting && (is_load(m.d.op) || is_store(m.d.op))) {
    if (!m.in_mem) begin_access(m);
    if (!m.faulting && is_load(m.d.op) && !m.isolated) {
      if (!caches_.loaded()) return m.cached ? ClockedCause::kDataMiss : ClockedCause::kUncached;
      if (m.memory) {
        take_word(m, board_.word(m.data_physical));
      } else {
        std::uint32_t value = 0;
        m.faulting = !board_.read(m.data_physical, size_of(m.d.op), value);
        m.fault.code = r3000::kDbe;
        take_word(m, value);
      }
    } else if (!m.faulting && !m.isolated && !m.stored) {
      if (m.partial_left != 0) {
        --m.partial_left;
        return ClockedCause::kPartialStore;
      }
      if (!caches_.entry_free()) return ClockedCause::kWriteBuffer;
      store(m);
    }
  }
  if (m.faulting && !m.entered) take_exception(m);
  return kHolds;
}

/// What the address is, and what it asks for.
void ClockedPipeline::begin_access(ClockedSlot& m) {
  m.in_mem = true;
  m.address = m.a + m.d.imm;
  const auto access = is_store(m.d.op) ? r3000::Access::kStore : r3000::Access::kLoad;
  if (!is_unaligned(m.d.op) && (m.address & (size_of(m.d.op) - 1)) != 0) {
    m.faulting = true;
    m.fault = {};
    m.fault.code = access == r3000::Access::kStore ? r3000::kAdes : r3000::kAdel;
    m.fault.address = m.address;
    m.fault.has_address = true;
    return;
  }
  m.faulting = !translate(state_, m.address, access, m.data_physical, m.fault);
  if (m.faulting) return;
  if (m.d.op == Op::kLwl || m.d.op == Op::kLwr) m.data_physical &= ~3u;
  m.isolated = state_.status & r3000::kStatusIsc;
  m.memory = board_.in_memory(m.data_physical);
  m.cached = m.memory && !uncached(state_, m.address);
  if (m.cached) caches_.count_data();
  if (m.isolated)
    take_word(m, 0);
  else if (access == r3000::Access::kLoad)
    caches_.load(m.data_physical, m.cached, m.memory);
  else
    begin_store(m);
}

void ClockedPipeline::begin_store(ClockedSlot& m) {
  if (!m.memory && !board_.answers_write(m.data_physical, size_of(m.d.op))) {
    m.faulting = true;
    m.fault = {};
    m.fault.code = r3000::kDbe;
    return;
  }
  if (!m.cached) return;
  caches_.look_up_store(m.data_physical);
  if (is_partial(m.d.op) && spec_.data_cache.store_partial)
    m.partial_left = spec_.data_cache.partial_store_cycles;
}

/// A load's result from the word at its address.
void ClockedPipeline::take_word(ClockedSlot& m, std::uint32_t word) const {
  const unsigned byte = m.address & 3;
  const std::uint32_t half = byte & 2 ? word & 0xFFFF : word >> 16, one = word >> 8 * (3 - byte) & 0xFF;
  const std::uint32_t old = wb_->live && wb_->destination == m.d.rt ? wb_->result : m.b;
  const unsigned from_top = 8 * byte, from_bottom = 8 * (3 - byte);
  switch (m.d.op) {
    case Op::kLb:
      m.result = static_cast<std::uint32_t>(static_cast<std::int8_t>(one));
      return;
    case Op::kLbu:
      m.result = one;
      return;
    case Op::kLh:
      m.result = static_cast<std::uint32_t>(static_cast<std::int16_t>(half));
      return;
    case Op::kLhu:
      m.result = half;
      return;
    case Op::kLwl:
      m.result = word << from_top | (old & ~(0xFFFFFFFFu << from_top));
      return;
    case Op::kLwr:
      m.result = word >> from_bottom | (old & ~(0xFFFFFFFFu >> from_bottom));
      return;
    default:
      m.result = word;
      return;
  }
}

/// The bytes of a store, as soon as nothing in MEM holds it up: what is behind it sees them.
void ClockedPipeline::store(ClockedSlot& m) {
  m.stored = true;
  const unsigned byte = m.address & 3;
  if (!m.memory) {
    board_.write(m.data_physical, 4, m.b);
    return;
  }
  std::uint32_t mask = 0xFFFFFFFF, bits = m.b;
  switch (m.d.op) {
    case Op::kSb:
      mask = 0xFF000000 >> 8 * byte;
      bits = (m.b & 0xFF) * 0x01010101u;
      break;
    case Op::kSh:
      mask = 0xFFFF0000 >> 8 * byte;
      bits = (m.b & 0xFFFF) * 0x00010001u;
      break;
    case Op::kSwl:
      mask = 0xFFFFFFFF >> 8 * byte;
      bits = m.b >> 8 * byte;
      break;
    case Op::kSwr:
      mask = 0xFFFFFFFF << 8 * (3 - byte);
      bits = m.b << 8 * (3 - byte);
      break;
    default:
      break;
  }
  const std::uint32_t word = (board_.word(m.data_physical) & ~mask) | (bits & mask);
  board_.put(m.data_physical, word);
  see_store(*alu_, m.data_physical, true);
  see_store(*rd_, m.data_physical, false);
}

/// A word that was fetched before an older one stored into it.
void ClockedPipeline::see_store(ClockedSlot& slot, std::uint32_t physical, bool has_operands) {
  if (!slot.live || slot.faulting || ((slot.physical ^ physical) & ~3u) != 0) return;
  slot.word = board_.word(physical);
  slot.d = r3000::decode(slot.word);
  slot.destination = static_cast<std::uint8_t>(destination_of(slot.d));
  slot.late = is_delayed_load(slot.d.op);
  if (!has_operands) return;
  const auto read = [this](unsigned reg) -> std::uint32_t {
    if (reg == 0 || reg == r3000::kNowhere) return 0;
    return wb_->live && wb_->destination == reg ? wb_->result : state_.r[reg];
  };
  slot.a = read(slot.d.rs);
  slot.b = read(slot.d.rt);
}

/// A load or store leaves MEM: tags and write buffer.
void ClockedPipeline::leave_store(const ClockedSlot& m) {
  if (!is_store(m.d.op)) return;
  const bool partial = is_partial(m.d.op);
  if (!m.isolated)
    caches_.store(m.data_physical, partial, m.cached, m.memory);
  else if (m.cached)
    caches_.isolated_store(m.data_physical, partial, state_.status & r3000::kStatusSwc);
}

}  // namespace dendro::sgi_4d35
