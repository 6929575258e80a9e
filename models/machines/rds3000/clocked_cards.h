#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/machines/rds3000/rds3000_state.h"
#include "models/parts/dr64/dr64_spec.h"

namespace dendro::rds3000 {

/// The memory cards of the clocked level: per card a countdown of busy ticks and its place in the queue of
/// refresh and video events.
class ClockedCards {
 public:
  static constexpr unsigned kMostCards = 8;
  static constexpr int kMostBusyTicks = 120;

  /// Throws UserError for busy times beyond kMostBusyTicks.
  explicit ClockedCards(const dr64::Spec& spec);

  /// An event fell due at this tick, for every card. On one tick, refresh is queued first.
  void queue_refresh() { queue(kRefresh); }
  void queue_fetch() { queue(kFetch); }

  /// Free cards take what waits for them.
  void serve(dr64::Counters& counters) {
    if (pending_ != 0) serve_pending(counters);
  }
  /// Whether all of `cards` (a bit each) are free in this tick.
  bool free(std::uint32_t cards) const { return (busy_ & lanes(cards)) == 0; }
  /// The cards are busy from this tick on, for `ticks`.
  void take(std::uint32_t cards, int ticks) {
    busy_ |= (lanes(cards) & kOnes) * static_cast<unsigned>(ticks);
  }

  /// The tick ends: every countdown that is not 0 goes down by one.
  void end_tick() { busy_ -= ((busy_ + kMostPerLane) >> 7) & kOnes; }

  int busy_ticks(unsigned card) const { return static_cast<int>((busy_ >> (8 * card)) & 0xFF); }
  std::uint64_t waiting(unsigned card) const { return queued_ - served_[card]; }

 private:
  enum Kind : std::uint8_t { kRefresh, kFetch };
  static constexpr std::uint64_t kOnes = 0x0101010101010101;
  static constexpr std::uint64_t kMostPerLane = 0x7F7F7F7F7F7F7F7F;

  // A card per byte: 0xFF where the card takes part.
  static std::uint64_t lanes(std::uint32_t cards) { return kLanes[cards & 0xFF]; }
  static const std::array<std::uint64_t, 256> kLanes;

  void queue(Kind kind);
  void serve_pending(dr64::Counters& counters);

  unsigned cards_;
  int card_busy_ticks_, fetch_ticks_;
  std::uint64_t busy_ = 0;           ///< eight countdowns, card c in bits 8c to 8c+7
  std::uint32_t pending_ = 0;        ///< cards with events to serve
  std::vector<std::uint8_t> kinds_;  ///< ring of event kinds, by sequence number
  std::uint64_t queued_ = 0;         ///< events so far; each card has served the first served_[card] of them
  std::array<std::uint64_t, kMostCards> served_{};
};

}  // namespace dendro::rds3000
