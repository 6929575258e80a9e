#pragma once

#include <algorithm>
#include <cstdint>

#include "models/parts/bps32/bps32.h"

namespace dendro::bps32 {

/// Why a word cannot execute, in the order of blame of README.md.
enum class Cause : std::uint8_t { kNone, kHost, kBranch, kData, kBus, kScratch };

/// The first cause that holds a word, and the tick from which on it no longer does.
struct Hold {
  Cause cause = Cause::kNone;
  std::int64_t until = 0;
};

/// The ticks before which words of one kind or another cannot execute: the data sheet's table of causes as numbers.
class Holds {
 public:
  explicit Holds(const ProcessorSpec& spec) : spec_(spec) {}

  /// The processor starts: a wait for the scratchpad that had begun is forgotten.
  void start() { scratch_ = kNotBegun; }
  /// A host access granted at `tick` steals the ticks after it.
  void steal(std::int64_t tick) { any(host_ = tick + 1 + spec_.steal_ticks); }
  /// A word at `tick` went elsewhere than to the next address.
  void branch(std::int64_t tick) { any(branch_ = tick + 1 + spec_.taken_branch_ticks); }
  /// An access of the processor's was granted and is complete at `done`.
  void access(bool write, std::int64_t done) {
    access_ = done;
    if (!write) data_ = done;
    if (spec_.accesses_in_flight == 0) any(done);
  }

  bool bus_busy(std::int64_t tick) const { return access_ > tick; }
  bool data_ready(std::int64_t tick) const { return data_ <= tick; }

  /// Tick at which the last access is complete.
  std::int64_t access_done() const { return access_; }
  /// True when nothing of the past can hold any word from this tick on.
  bool rests(std::int64_t tick) const {
    return std::max({any_, host_, branch_, data_, access_}) <= tick && scratch_ == kNotBegun;
  }

  /// True when a word that asks nothing of bus and scratchpad may be held, too.
  bool holds_any(std::int64_t tick) const { return tick < any_; }

  /// True when nothing keeps the word from executing at `tick`; false may also mean "ask at()".
  bool clear(const Decoded& word, std::int64_t tick) const {
    return tick >= any_ && (!word.reads_bus || tick >= data_) && (!word.starts_access || tick >= access_) &&
           (!word.touches_scratch || spec_.scratch_ticks == 1);
  }

  /// What holds the word at `tick`. Ask at the first tick at which the word could execute and then at each `until`.
  Hold at(const Decoded& word, std::int64_t tick) {
    if (tick < host_) return {Cause::kHost, host_};
    if (tick < branch_) return {Cause::kBranch, branch_};
    if (word.reads_bus && tick < data_) return {Cause::kData, data_};
    if ((word.starts_access || spec_.accesses_in_flight == 0) && tick < access_) return {Cause::kBus, access_};
    if (word.touches_scratch && spec_.scratch_ticks > 1) {
      if (scratch_ == kNotBegun) scratch_ = tick + spec_.scratch_ticks - 1;
      if (tick < scratch_) return {Cause::kScratch, scratch_};
      scratch_ = kNotBegun;
    }
    return {};
  }

 private:
  static constexpr std::int64_t kNotBegun = -1;

  void any(std::int64_t tick) { any_ = std::max(any_, tick); }

  ProcessorSpec spec_;
  std::int64_t any_ = 0, host_ = 0, branch_ = 0, data_ = 0, access_ = 0;
  std::int64_t scratch_ = kNotBegun;
};

}  // namespace dendro::bps32
