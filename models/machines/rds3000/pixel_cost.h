#pragma once

#include <cstdint>
#include <vector>

namespace dendro::rds3000 {

/// Which pixel the processor's ticks go to: from one access to image memory to the next they belong to the pixel of
/// the former; before the first access of a start they belong to none.
class PixelCost {
 public:
  explicit PixelCost(std::size_t pixels) : ticks_(pixels, 0), visits_(pixels, 0) {}

  void start(std::int64_t tick) {
    since_ = tick;
    pixel_ = kNone;
  }
  void access(std::size_t pixel, std::int64_t tick) {
    settle(tick);
    pixel_ = pixel;
    ++visits_[pixel];
  }
  void stop(std::int64_t tick) {
    settle(tick);
    pixel_ = kNone;
  }

  const std::vector<std::uint64_t>& ticks() const { return ticks_; }
  const std::vector<std::uint64_t>& visits() const { return visits_; }
  /// Ticks that belong to no pixel.
  std::uint64_t elsewhere() const { return elsewhere_; }

 private:
  static constexpr std::size_t kNone = SIZE_MAX;

  void settle(std::int64_t tick) {
    (pixel_ == kNone ? elsewhere_ : ticks_[pixel_]) += static_cast<std::uint64_t>(tick - since_);
    since_ = tick;
  }

  std::vector<std::uint64_t> ticks_, visits_;
  std::uint64_t elsewhere_ = 0;
  std::size_t pixel_ = kNone;
  std::int64_t since_ = 0;
};

}  // namespace dendro::rds3000
