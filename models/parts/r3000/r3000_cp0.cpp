#include "models/parts/r3000/r3000_state.h"

namespace dendro::r3000 {
namespace {

Fault address_error(std::uint32_t address, Access access) {
  Fault fault;
  fault.code = access == Access::kStore ? kAdes : kAdel;
  fault.address = address;
  fault.has_address = true;
  return fault;
}

Fault tlb_fault(std::uint32_t address, unsigned code, bool refill) {
  Fault fault;
  fault.code = code;
  fault.address = address;
  fault.has_address = fault.translation = true;
  fault.refill = refill;
  return fault;
}

const TlbEntry* find(const State& s, std::uint32_t address) {
  for (const TlbEntry& entry : s.tlb)
    if (((entry.hi ^ address) & kPageMask) == 0 &&
        ((entry.lo & kLoGlobal) || ((entry.hi ^ s.entry_hi) & kHiAsid) == 0))
      return &entry;
  return nullptr;
}

}  // namespace

const char* exception_name(unsigned code) {
  static const char* const kNames[] = {"Int", "Mod", "TLBL", "TLBS", "AdEL", "AdES", "IBE",
                                       "DBE", "Sys", "Bp",   "RI",   "CpU",  "Ov"};
  return code < sizeof kNames / sizeof *kNames ? kNames[code] : "?";
}

bool translate(State& s, std::uint32_t address, Access access, std::uint32_t& physical, Fault& fault) {
  if (address >= kKseg0 && s.user()) {
    fault = address_error(address, access);
    return false;
  }
  if (address >= kKseg0 && address < kKseg2) {
    physical = address & 0x1FFFFFFF;
    return true;
  }
  const unsigned miss = access == Access::kStore ? kTlbs : kTlbl;
  const TlbEntry* entry = find(s, address);
  if (entry == nullptr || !(entry->lo & kLoValid)) {
    fault = tlb_fault(address, miss, entry == nullptr && address < kKseg0);
    return false;
  }
  if (access == Access::kStore && !(entry->lo & kLoDirty)) {
    fault = tlb_fault(address, kMod, false);
    return false;
  }
  physical = (entry->lo & kPageMask) | (address & ~kPageMask);
  return true;
}

bool uncached(const State& s, std::uint32_t address) {
  if (address >= kKseg0 && address < kKseg2) return address >= kKseg1;
  const TlbEntry* entry = find(s, address);
  return entry != nullptr && (entry->lo & kLoUncached);
}

void finish_load(State& s) {
  if (s.pending_reg == 0) return;
  s.r[s.pending_reg] = s.pending_value;
  s.pending_reg = 0;
}

void enter_exception(State& s, const Fault& fault) {
  finish_load(s);
  s.epc = s.in_slot ? s.pc - 4 : s.pc;
  s.cause =
      (s.cause & kCauseSoftware) | fault.code << 2 | (s.in_slot ? kCauseBd : 0) | fault.coprocessor << 28;
  if (fault.has_address) s.bad_vaddr = fault.address;
  if (fault.translation) {
    s.context = (s.context & 0xFFE00000) | (fault.address >> 12 & 0x7FFFF) << 2;
    s.entry_hi = (fault.address & kPageMask) | (s.entry_hi & kHiAsid);
  }
  s.status = (s.status & ~kStatusStack) | (s.status << 2 & kStatusStack);
  const bool boot = s.status & kStatusBev;
  s.pc = fault.refill ? (boot ? kBootUtlbVector : kUtlbVector) : (boot ? kBootGeneralVector : kGeneralVector);
  s.next_pc = s.pc + 4;
  s.in_slot = false;
  ++s.exceptions;
  if (fault.refill) ++s.tlb_refills;
}

std::uint32_t cause_of(const State& s) {
  return s.cause | static_cast<std::uint32_t>(s.lines) << (kCauseIpShift + 2);
}

bool interrupt_due(const State& s) { return (s.status & kStatusIec) && (cause_of(s) & s.status & kStatusIm); }

std::uint32_t read_cp0(const State& s, const Spec& spec, unsigned reg, unsigned random) {
  switch (reg) {
    case kIndex:
      return s.index;
    case kRandom:
      return random << 8;
    case kEntryLo:
      return s.entry_lo;
    case kContext:
      return s.context;
    case kBadVAddr:
      return s.bad_vaddr;
    case kEntryHi:
      return s.entry_hi;
    case kStatus:
      return s.status;
    case kCause:
      return cause_of(s);
    case kEpc:
      return s.epc;
    case kPrId:
      return spec.processor_id;
    default:
      return 0;
  }
}

void write_cp0(State& s, unsigned reg, std::uint32_t value) {
  switch (reg) {
    case kIndex:
      s.index = (s.index & 0x80000000) | (value & 0x3F00);
      break;
    case kEntryLo:
      s.entry_lo = value & 0xFFFFFF00;
      break;
    case kContext:
      s.context = (s.context & 0x1FFFFC) | (value & 0xFFE00000);
      break;
    case kEntryHi:
      s.entry_hi = value & (kPageMask | kHiAsid);
      break;
    case kStatus:
      s.status = (s.status & ~kStatusWritable) | (value & kStatusWritable);
      break;
    case kCause:
      s.cause = (s.cause & ~kCauseSoftware) | (value & kCauseSoftware);
      break;
    default:
      break;
  }
}

void tlb_read(State& s) {
  const TlbEntry& entry = s.tlb[s.index >> 8 & 63];
  s.entry_hi = entry.hi;
  s.entry_lo = entry.lo;
}

void tlb_write(State& s, unsigned index) {
  TlbEntry& entry = s.tlb[index & 63];
  entry = {s.entry_hi, s.entry_lo};
  for (const TlbEntry& other : s.tlb) {
    const bool same_space = (other.lo & entry.lo & kLoGlobal) || ((other.hi ^ entry.hi) & kHiAsid) == 0;
    if (&other != &entry && (other.lo & entry.lo & kLoValid) && same_space &&
        ((other.hi ^ entry.hi) & kPageMask) == 0)
      s.status |= kStatusTs;
  }
}

void tlb_probe(State& s) {
  const TlbEntry* entry = find(s, s.entry_hi);
  s.index = entry ? static_cast<std::uint32_t>(entry - s.tlb.data()) << 8 : 0x80000000;
}

void return_from_exception(State& s) { s.status = (s.status & ~0xFu) | (s.status >> 2 & 0xF); }

}  // namespace dendro::r3000
