#include "models/machines/rds3000/clocked_cards.h"

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::rds3000 {
namespace {

constexpr std::array<std::uint64_t, 256> all_lanes() {
  std::array<std::uint64_t, 256> lanes{};
  for (unsigned cards = 0; cards < 256; ++cards)
    for (unsigned card = 0; card < 8; ++card)
      if ((cards >> card) & 1) lanes[cards] |= std::uint64_t{0xFF} << (8 * card);
  return lanes;
}

}  // namespace

const std::array<std::uint64_t, 256> ClockedCards::kLanes = all_lanes();

ClockedCards::ClockedCards(const dr64::Spec& spec)
    : cards_(spec.cards()),
      card_busy_ticks_(spec.card_busy_ticks),
      fetch_ticks_(spec.fetch_ticks),
      kinds_(64) {
  DENDRO_CHECK(cards_ >= 1 && cards_ <= kMostCards, "{} cards", cards_);
  const int longest = std::max(spec.card_busy_ticks + spec.masked_write_extra_ticks, spec.fetch_ticks);
  if (longest > kMostBusyTicks)
    throw UserError(
        fmt::format("level clocked: a memory card may be busy for at most {} ticks at a time, not {}",
                    kMostBusyTicks, longest));
}

void ClockedCards::queue(Kind kind) {
  const std::uint64_t oldest = *std::min_element(served_.begin(), served_.begin() + cards_);
  if (queued_ - oldest == kinds_.size()) {
    std::vector<std::uint8_t> larger(2 * kinds_.size());
    for (std::uint64_t e = oldest; e < queued_; ++e) larger[e % larger.size()] = kinds_[e % kinds_.size()];
    kinds_ = std::move(larger);
  }
  kinds_[queued_++ % kinds_.size()] = kind;
  pending_ = (1u << cards_) - 1;
}

void ClockedCards::serve_pending(dr64::Counters& counters) {
  for (unsigned card = 0; card < cards_; ++card) {
    const std::uint32_t bit = 1u << card;
    while ((pending_ & bit) != 0 && free(bit)) {
      if (kinds_[served_[card] % kinds_.size()] == kRefresh) {
        take(bit, card_busy_ticks_);
        counters.busy_refresh += static_cast<unsigned>(card_busy_ticks_);
        ++counters.refreshes;
      } else {
        take(bit, fetch_ticks_);
        counters.busy_video += static_cast<unsigned>(fetch_ticks_);
        ++counters.fetches;
      }
      if (++served_[card] == queued_) pending_ &= ~bit;
    }
  }
}

}  // namespace dendro::rds3000
