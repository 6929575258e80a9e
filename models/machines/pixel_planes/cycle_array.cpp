#include "models/machines/pixel_planes/cycle_array.h"

#include <algorithm>

namespace dendro::pixel_planes {
namespace {

constexpr std::int64_t kFarBit = 1000;  ///< of a stream: its sign

}  // namespace

CycleArray::CycleArray(const Spec& spec) : spec_(spec), stolen_(spec), state_(spec) {}

void CycleArray::start(std::int64_t a, std::int64_t b, std::int64_t c) {
  igc::Command expression;
  expression.a = a, expression.b = b, expression.c = c;
  streams_.push_back(expression);
  starts_ = true;
}

// The lines go on between words, but not in stolen clocks.
void CycleArray::move_position(std::int64_t clock) {
  if (starts_ || !begun_) {
    position_ = starts_ ? 0 : kFarBit;
  } else if (clock - last_ > 2 * kFarBit) {
    position_ = kFarBit;
  } else {
    const auto [refresh, video] = stolen_.count(last_, clock);
    position_ = std::min(kFarBit, position_ + clock - last_ - static_cast<std::int64_t>(refresh + video));
  }
  starts_ = false, begun_ = true;
  last_ = clock;
}

std::optional<std::int64_t> CycleArray::send(std::int64_t clock, const igc::ArrayWord& word) {
  stolen_.skip(last_ < clock - 4 * kFarBit ? clock : 0);
  if (stolen_.first_free(clock) != clock) return std::nullopt;
  move_position(clock);
  Sent sent;
  sent.visible = stolen_.advance(clock, static_cast<std::uint64_t>(spec_.latency())) + 1;
  sent.stream = streams_.size() - 1;
  sent.step.word = word;
  const std::int64_t bit = position_ - spec_.tree.gap_clocks;
  sent.step.bit = word.tree && bit >= 0 ? static_cast<int>(std::min<std::int64_t>(bit, 127)) : -1;
  sent_.push_back(sent);
  stolen_.forget(clock);
  return sent.visible;
}

void CycleArray::go_to(std::int64_t clock) {
  std::vector<ArrayStep> steps;
  while (!sent_.empty() && sent_.front().visible <= clock) {
    const std::size_t stream = sent_.front().stream;
    steps.clear();
    for (; !sent_.empty() && sent_.front().visible <= clock && sent_.front().stream == stream; sent_.pop_front())
      steps.push_back(sent_.front().step);
    apply_steps(spec_, streams_[stream], steps, state_);
  }
}

}  // namespace dendro::pixel_planes
