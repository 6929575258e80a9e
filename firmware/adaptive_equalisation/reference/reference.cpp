#include "firmware/adaptive_equalisation/reference/reference.h"

namespace dendro::adaptive_equalisation {
namespace {

/// Numbers of grey values, and how many lie below one, in steps logarithmic in the number of values.
class Histogram {
 public:
  Histogram() : sums_((1u << 16) + 1) {}

  void add(unsigned value, std::int32_t count) {
    for (unsigned k = value + 1; k < sums_.size(); k += k & (~k + 1)) sums_[k] += count;
  }
  std::uint32_t below(unsigned value) const {
    std::int32_t sum = 0;
    for (unsigned k = value; k > 0; k -= k & (~k + 1)) sum += sums_[k];
    return static_cast<std::uint32_t>(sum);
  }

 private:
  std::vector<std::int32_t> sums_;
};

/// Moved into 0..side - 1.
int moved(int first, int region, int side) {
  if (first < 0) return 0;
  return first + region > side ? side - region : first;
}

}  // namespace

std::vector<std::uint32_t> ranks(const std::vector<std::uint16_t>& grey, int width, int height, int region) {
  std::vector<std::uint32_t> out;
  for (int y = 0; y < height; ++y) {
    const int top = moved(y - region / 2, region, height);
    Histogram histogram;
    const auto column = [&](int x, std::int32_t count) {
      for (int k = top; k < top + region; ++k) histogram.add(grey[static_cast<std::size_t>(k * width + x)], count);
    };
    int left = 0;
    for (int x = 0; x < region; ++x) column(x, 1);
    for (int x = 0; x < width; ++x) {
      for (const int wanted = moved(x - region / 2, region, width); left < wanted; ++left) {
        column(left, -1);
        column(left + region, 1);
      }
      out.push_back(histogram.below(grey[static_cast<std::size_t>(y * width + x)]));
    }
  }
  return out;
}

}  // namespace dendro::adaptive_equalisation
