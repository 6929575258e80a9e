#include "models/machines/sgi_4d35/debug.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace dendro::sgi_4d35 {
namespace {

/// GDB's numbers of a MIPS machine's registers.
enum Number : std::size_t {
  kGprs = 0,
  kStatusRegister = 32,
  kLo,
  kHi,
  kBadAddress,
  kCauseRegister,
  kPc,
  kFprs,
  kFpuControl = kFprs + 32,
  kFpuRevision,
  kRegisters,
};

constexpr std::uint64_t kWordsPerLook = 1 << 16;

r3000::State after_load(r3000::State s) {
  r3000::finish_load(s);
  return s;
}

std::string describe() {
  std::string text =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE target SYSTEM \"gdb-target.dtd\">\n<target version=\"1.0\">\n"
      "<architecture>mips:3000</architecture>\n<feature name=\"org.gnu.gdb.mips.cpu\">\n";
  const auto reg = [&text](const std::string& name, std::size_t number, const char* type) {
    text += fmt::format("<reg name=\"{}\" bitsize=\"32\" regnum=\"{}\" type=\"{}\"/>\n", name, number, type);
  };
  for (std::size_t i = 0; i < 32; ++i) reg(fmt::format("r{}", i), kGprs + i, "uint32");
  reg("lo", kLo, "uint32");
  reg("hi", kHi, "uint32");
  reg("pc", kPc, "code_ptr");
  text += "</feature>\n<feature name=\"org.gnu.gdb.mips.cp0\">\n";
  reg("status", kStatusRegister, "uint32");
  reg("badvaddr", kBadAddress, "uint32");
  reg("cause", kCauseRegister, "uint32");
  text += "</feature>\n<feature name=\"org.gnu.gdb.mips.fpu\">\n";
  for (std::size_t i = 0; i < 32; ++i) reg(fmt::format("f{}", i), kFprs + i, "ieee_single");
  reg("fcsr", kFpuControl, "uint32");
  reg("fir", kFpuRevision, "uint32");
  return text + "</feature>\n</target>\n";
}

}  // namespace

ElfDebuggee::ElfDebuggee(Core core, Board& board, std::uint64_t limit)
    : core_(std::move(core)), board_(board), left_(limit) {}

const std::string& ElfDebuggee::description() const {
  static const std::string text = describe();
  return text;
}

std::size_t ElfDebuggee::program_counter() const { return kPc; }

void ElfDebuggee::enter() {
  while (!over() && core_.state.pc != board_.program.entry) {
    core_.run(1);
    --left_;
  }
  monitored_ = in_program();
}

std::vector<std::uint32_t> ElfDebuggee::registers() const {
  const r3000::State s = faulted_ ? state_at_fault() : after_load(core_.state);
  std::vector<std::uint32_t> values(kRegisters);
  std::copy(s.r, s.r + 32, values.begin());
  values[kStatusRegister] = s.status;
  values[kLo] = s.lo;
  values[kHi] = s.hi;
  values[kBadAddress] = s.bad_vaddr;
  values[kCauseRegister] = r3000::cause_of(s);
  values[kPc] = s.pc;
  std::copy(s.fpu.r, s.fpu.r + 32, values.begin() + kFprs);
  values[kFpuControl] = s.fpu.control;
  values[kFpuRevision] = r3010::kRevision;
  return values;
}

/// The monitor kept the program's registers, or has them in its frame (monitor.S, fpu) where k0 points.
r3000::State ElfDebuggee::state_at_fault() const {
  r3000::State s = core_.state;
  s.cause = board_.block.arguments[0];
  s.pc = board_.block.arguments[1] + (s.cause & r3000::kCauseBd ? 4 : 0);
  if (fault_code() != r3000::kInt) return s;
  const auto kept = [&](unsigned word) {
    const std::uint32_t physical = (core_.state.r[26] & 0x1FFFFFFF) + 4 * word;
    return board_.in_memory(physical) ? board_.word(physical) : 0;
  };
  s.hi = s.r[16];
  s.lo = s.r[17];
  for (unsigned i = 1; i < 32; ++i)
    if (i != 26 && i != 27) s.r[i] = kept(i);
  s.fpu.control = kept(64);
  return s;
}

bool ElfDebuggee::set_register(std::size_t number, std::uint32_t value) {
  r3000::State& s = core_.state;
  if (faulted_ || board_.stopped() || !core_.forget_code) return false;
  if (number < 32) {
    if (number == s.pending_reg) s.pending_reg = 0;
    if (number != 0) s.r[number] = value;
  } else if (number == kLo) {
    s.lo = value;
  } else if (number == kHi) {
    s.hi = value;
  } else if (number == kPc) {
    if (value != s.pc) core_.jump(value);
  } else if (number >= kFprs && number < kFpuControl) {
    s.fpu.r[number - kFprs] = value;
  } else {
    return false;
  }
  return true;
}

bool ElfDebuggee::physical_of(std::uint32_t address, std::uint32_t& physical) const {
  r3000::State s = core_.state;
  s.status &= ~r3000::kStatusKuc;
  r3000::Fault unseen;
  if (!r3000::translate(s, address, r3000::Access::kLoad, physical, unseen)) {
    if (address >= r3000::kKseg0 || !board_.program.mapped) return false;
    const std::uint32_t from_top = r3000::kKseg0 - address;
    const std::uint32_t place = (DENDRO_PAGE_TABLE & 0x1FFFFFFF) + (address >> 12) * 4;
    const std::uint32_t entry = board_.in_memory(place) ? board_.word(place) : 0;
    if (entry & r3000::kLoValid)
      physical = (entry & r3000::kPageMask) | (address & ~r3000::kPageMask);
    else if (from_top <= DENDRO_STACK_BYTES)
      physical = static_cast<std::uint32_t>(board_.memory.size()) - from_top;
    else
      return false;
  }
  return board_.in_memory(physical);
}

std::size_t ElfDebuggee::read(std::uint32_t address, std::uint8_t* to, std::size_t bytes) const {
  std::uint32_t physical = 0;
  std::size_t i = 0;
  for (; i < bytes; ++i, ++address, ++physical) {
    if ((i == 0 || (address & ~r3000::kPageMask) == 0) && !physical_of(address, physical)) break;
    to[i] = board_.memory[physical];
  }
  return i;
}

std::size_t ElfDebuggee::write(std::uint32_t address, const std::uint8_t* from, std::size_t bytes) {
  if (!core_.forget_code) return 0;
  std::uint32_t physical = 0;
  std::size_t i = 0;
  for (; i < bytes; ++i, ++address, ++physical) {
    if (i == 0 || (address & ~r3000::kPageMask) == 0) {
      if (!physical_of(address, physical)) break;
      core_.forget_code(physical);
    }
    board_.memory[physical] = from[i];
  }
  return i;
}

void ElfDebuggee::set_breakpoint(std::uint32_t address, bool on) {
  if (on)
    breakpoints_.insert(address);
  else
    breakpoints_.erase(address);
}

int ElfDebuggee::fault_signal() const {
  switch (fault_code()) {
    case r3000::kBp:
      return kTrap;
    case r3000::kRi:
    case r3000::kCpu:
      return kIllegal;
    case r3000::kOv:
    case r3000::kInt:
      return kArithmetic;
    case r3000::kAdel:
    case r3000::kAdes:
    case r3000::kIbe:
    case r3000::kDbe:
      return kBus;
    default:
      return kSegment;
  }
}

/// A program that faulted stands first at the word that did it, its registers as they were, and then ends.
Debuggee::Stop ElfDebuggee::stop(int signal) {
  if (!over()) return {signal, false};
  if (!board_.stopped()) return {kLimit, true};
  // The monitor's last word stored the call's number, from k1 or, behind the R3010's interrupt, from t0.
  const unsigned number = fault_code() == r3000::kInt ? 8 : 27;
  if (!monitored_ || core_.state.r[number] != DENDRO_CALL_FAULT) return {0, true};
  const bool seen = std::exchange(faulted_, true);
  return {fault_signal(), seen};
}

/// The monitor's words, up to the program's next one. False: a breakpoint in the monitor, or the end.
bool ElfDebuggee::leave_monitor() {
  while (!in_program()) {
    if (over() || at_breakpoint()) return false;
    core_.run(1);
    --left_;
  }
  return true;
}

Debuggee::Stop ElfDebuggee::step() {
  const r3000::State& s = core_.state;
  const std::uint32_t pc = s.pc;
  const bool slot = s.in_slot, program = in_program();
  while (!over()) {
    // What faulted in a branch's slot begins again at the branch.
    const bool whole = s.pc == pc;
    const std::uint64_t exceptions = s.exceptions;
    core_.run(1);
    --left_;
    if (s.exceptions == exceptions ? whole : !program || !leave_monitor()) break;
    if (s.pc != pc && !(slot && s.pc == pc - 4)) break;
  }
  return stop(kTrap);
}

Debuggee::Stop ElfDebuggee::run(const std::function<bool()>& interrupted) {
  Stop first = step();
  if (first.ended || faulted_ || at_breakpoint()) return first;
  while (!over()) {
    if (interrupted()) {
      if (monitored_) leave_monitor();
      return stop(kInterrupted);
    }
    std::uint64_t words = std::min(left_, kWordsPerLook);
    left_ -= words;
    if (breakpoints_.empty()) {
      while (words != 0 && !board_.stopped()) words = core_.run(words);
    } else {
      while (words != 0 && !board_.stopped()) {
        core_.run(1);
        --words;
        if (at_breakpoint()) break;
      }
    }
    left_ += words;
    if (!over() && at_breakpoint()) break;
  }
  return stop(kTrap);
}

std::uint64_t debugged(Debugger* debugger, ElfDebuggee::Core core, Board& board, std::uint64_t limit) {
  if (debugger == nullptr) return limit;
  ElfDebuggee program(std::move(core), board, limit);
  program.enter();
  return debugger->debug(program) ? program.left() : 0;
}

}  // namespace dendro::sgi_4d35
