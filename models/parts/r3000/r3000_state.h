#pragma once

#include <array>
#include <cstdint>

#include "models/parts/r3000/r3000_decode.h"
#include "models/parts/r3010/r3010.h"

namespace dendro::r3000 {

struct Spec {
  std::uint32_t processor_id = 0x0230;  ///< PRId: implementation 2, revision 3.0. ASSUMED DEV-110
  unsigned fpu_interrupt = 3;           ///< hardware line, 0 to 5, that the R3010 pulls. ASSUMED DEV-112
};

struct TlbEntry {
  std::uint32_t hi = 0, lo = 0;
};

/// Everything that a program can see or feel. Plain data: a copy is a snapshot.
struct State {
  std::uint32_t r[33] = {};  ///< r[0] stays 0; r[32] takes what is written to it
  std::uint32_t hi = 0, lo = 0;
  std::uint32_t pc = kResetVector, next_pc = kResetVector + 4;
  bool in_slot = false;          ///< the word at pc is the delay slot of the branch before it
  std::uint8_t pending_reg = 0;  ///< register of a load that the word at pc does not see yet; 0: none
  std::uint32_t pending_value = 0;
  std::uint32_t index = 0, entry_lo = 0, context = 0, bad_vaddr = 0, entry_hi = 0, epc = 0;
  std::uint32_t status = kStatusBev, cause = 0;
  std::uint8_t lines = 0;          ///< interrupt lines 0 to 5 that devices pull
  std::uint64_t instructions = 0;  ///< completed
  std::uint64_t exceptions = 0;    ///< taken, interrupts included
  std::uint64_t tlb_refills = 0;   ///< of them, by the UTLB vector
  std::array<TlbEntry, kTlbEntries> tlb = {};
  r3010::State fpu;

  bool user() const { return status & kStatusKuc; }
};

struct Counters {
  std::uint64_t instructions = 0, exceptions = 0, tlb_refills = 0;
};
inline Counters operator-(const Counters& a, const Counters& b) {
  return {a.instructions - b.instructions, a.exceptions - b.exceptions, a.tlb_refills - b.tlb_refills};
}
inline Counters counters_of(const State& s) { return {s.instructions, s.exceptions, s.tlb_refills}; }

/// What went wrong with a word: the code, and for address faults the address and which vector.
struct Fault {
  unsigned code = 0;
  std::uint32_t address = 0;
  bool has_address = false;  ///< BadVAddr takes the address
  bool translation = false;  ///< Context and EntryHi take it too
  bool refill = false;       ///< through the UTLB vector
  unsigned coprocessor = 0;  ///< of kCpu
};

enum class Access { kFetch, kLoad, kStore };

/// The physical address of a virtual one, or false and what is wrong. Does not look at alignment.
bool translate(State& s, std::uint32_t address, Access access, std::uint32_t& physical, Fault& fault);
/// True for an address that goes past the caches: kseg1, or by its TLB entry. It must translate.
bool uncached(const State& s, std::uint32_t address);

/// True for kseg1 and for a page whose TLB entry has N set.
bool uncached(const State& s, std::uint32_t address);

/// The register that the load under way writes gets its value now.
void finish_load(State& s);

/// Enters an exception at the word at s.pc / s.in_slot: EPC, Cause, mode stack, vector. A load under way
/// completes first.
void enter_exception(State& s, const Fault& fault);

/// True if an interrupt is asked for and allowed.
bool interrupt_due(const State& s);
/// Cause as mfc0 reads it, with the lines.
std::uint32_t cause_of(const State& s);

/// `random` is the Random register's value, 8 to 63.
std::uint32_t read_cp0(const State& s, const Spec& spec, unsigned reg, unsigned random);
void write_cp0(State& s, unsigned reg, std::uint32_t value);
void tlb_read(State& s);
void tlb_write(State& s, unsigned index);
void tlb_probe(State& s);
void return_from_exception(State& s);

/// Random steps down once per instruction from 63 to 8 and starts again [GEN; MIPS I].
inline unsigned random_of(const State& s) {
  return kTlbEntries - 1 - static_cast<unsigned>(s.instructions % (kTlbEntries - kTlbWired));
}

}  // namespace dendro::r3000
