#pragma once

#include "models/parts/r3000/r3000.h"

/// Where the timed core knows which position stands in which stage. In step j the word of position j is in ALU:
/// its wait there, then the fetch of position j + 2, then the run clock is over; in the next clock the word is in
/// MEM and waits there, which ends the step. Between steps time_.bias is the clock in which MEM lets go.
namespace dendro::r3000 {

template <class Port, class Timing>
bool Core<Port, Timing>::is_plain(std::uint32_t address) const {
  return (address & (kPageMask | 3)) == fetches_[s_.user()][address >> 12 & (kMappings - 1)].tag;
}

/// True if the word is in the instruction cache and nothing else is to be known of it.
template <class Port, class Timing>
bool Core<Port, Timing>::fetched(std::uint32_t address, std::uint64_t left) {
  const FetchMapping& m = fetches_[s_.user()][address >> 12 & (kMappings - 1)];
  if (__builtin_expect((address & (kPageMask | 3)) == m.tag, 1) &&
      __builtin_expect(time_.has_word(m.physical | (address & ~kPageMask)), 1))
    return true;
  fetch_slowly(address, left);
  return false;
}

/// A fetch that kFast and kWarm have already counted as an access.
template <class Port, class Timing>
void Core<Port, Timing>::fetch_slowly(std::uint32_t address, std::uint64_t left) {
  const std::uint64_t now = time_.bias - left;
  time_.uncount_fetch();
  time_.bias += fetch_at(address, now) - now;
  if (is_plain(address) && !time_.streaming(time_.bias - left + 1)) return;
  careful_ = leave_ = true;
}

/// IF looks at the word from clock `now` on; returns the clock in which it goes on.
template <class Port, class Timing>
std::uint64_t Core<Port, Timing>::fetch_at(std::uint32_t address, std::uint64_t now) {
  std::uint32_t physical = 0;
  Fault unseen;
  if ((address & 3) != 0 || !translate(s_, address, Access::kFetch, physical, unseen)) return now;
  if (port_.page(physical) == nullptr || uncached(s_, address))
    return time_.fetch_uncached(physical, now);
  const auto code = code_.find(physical & kPageMask);
  if (code != code_.end() && code->second->plain)
    fetches_[s_.user()][address >> 12 & (kMappings - 1)] =
        {address & kPageMask, physical & kPageMask, code->second.get()};
  return time_.fetch(physical, now, warm_);
}

/// What a step put off, now that its next word has done what it does to translation.
template <class Port, class Timing>
void Core<Port, Timing>::catch_up(std::uint64_t left) {
  if (!deferred_) return;
  deferred_ = false;
  const std::uint64_t now = time_.bias - left - 1;
  const std::uint64_t then = fetch_at(deferred_address_, now);
  time_.run_clock(then);
  time_.bias += then - now;
  time_.bias += time_.put_off_memory(time_.bias - left) - (time_.bias - left);
}

/// The end of a step, after the wait in ALU: `next` is the word that executes next, `npc` the one behind it.
template <class Port, class Timing>
void Core<Port, Timing>::finish_careful(std::uint32_t pc, std::uint32_t next, std::uint32_t npc, bool rfe,
                                        std::uint64_t left) {
  const std::uint64_t now = time_.bias - left;
  time_.before_step();
  if (is_plain(next)) {
    const std::uint64_t then = fetch_at(npc, now);
    time_.run_clock(then);
    time_.bias += then - now;
    time_.bias += time_.memory(then + 1) - (then + 1);
  } else {
    deferred_ = true;
    deferred_address_ = npc;
    time_.put_off();
  }
  time_.in_memory(pc, false, false, rfe);
}

template <class Port, class Timing>
void Core<Port, Timing>::finish_fault(std::uint32_t pc, std::uint32_t npc, bool refill, std::uint64_t left) {
  const std::uint64_t now = time_.bias - left, then = fetch_at(npc + 4, now);
  time_.before_step();
  time_.run_clock(then);
  time_.bias += then - now;
  time_.bias += time_.memory(then + 1) - (then + 1);
  time_.in_memory(pc, true, refill, false);
  time_.lost(1);
  lost_ = time_.exception_positions();
  careful_ = leave_ = true;
}

/// The word at pc is interrupted: a position like one that faults, but that the budget does not count.
template <class Port, class Timing>
void Core<Port, Timing>::interrupted() {
  catch_up(0);
  finish_fault(s_.pc, s_.next_pc, false, 0);
  ++time_.bias;
}

/// The positions between an exception and its handler, or before the first word of all.
template <class Port, class Timing>
void Core<Port, Timing>::lose_positions() {
  for (; lost_ != 0; --lost_) {
    const std::uint64_t now = time_.bias;
    time_.before_step();
    if (lost_ == 1 && !is_plain(s_.pc)) {
      deferred_ = true;
      deferred_address_ = s_.next_pc;
      time_.put_off();
    } else {
      time_.bias = lost_ > 2 ? now : fetch_at(lost_ == 2 ? s_.pc : s_.next_pc, now);
      time_.run_clock(time_.bias);
    }
    ++time_.bias;
    time_.in_no_memory();
    time_.lost(1);
  }
}

template <class Port, class Timing>
bool Core<Port, Timing>::may_hurry() const {
  return !deferred_ && lost_ == 0 && !(s_.status & kStatusIsc) && is_plain(s_.pc) && is_plain(s_.next_pc) && !time_.streaming(time_.bias) &&
         time_.may_hurry();
}

template <class Port, class Timing>
void Core<Port, Timing>::settle() {
  catch_up(0);
  time_.finish();
}

/// From here on in a hurry, if nothing speaks against it.
template <class Port, class Timing>
void Core<Port, Timing>::hurry() {
  if (!careful_ || !may_hurry()) return;
  careful_ = false;
  time_.hurry();
}

template <class Port, class Timing>
std::uint64_t Core<Port, Timing>::run_words(std::uint64_t budget) {
  if constexpr (!kTimed) {
    return run_plain<Pace::kFunction>(budget);
  } else {
    hurry();
    time_.bias += budget;
    const std::uint64_t left = careful_ ? run_plain<Pace::kCareful>(budget)
                               : warm_  ? run_plain<Pace::kWarm>(budget)
                                        : run_plain<Pace::kFast>(budget);
    time_.bias -= left;
    return left;
  }
}

/// Where no load is under way: blocks, and word by word what they leave.
template <class Port, class Timing>
std::uint64_t Core<Port, Timing>::run_paced(std::uint64_t budget) {
  if constexpr (kTimed) {
    hurry();
    if (careful_) return run_words(budget);
  }
  if (!s_.in_slot && s_.next_pc == s_.pc + 4) {
    if constexpr (!kTimed)
      budget = run_blocks<Pace::kFunction>(budget);
    else
      budget = warm_ ? run_blocks<Pace::kWarm>(budget) : run_blocks<Pace::kFast>(budget);
    if (budget == 0) return 0;
    if (short_) return run_words(budget);
  }
  return budget - 1 + run_words(1);
}

}  // namespace dendro::r3000
