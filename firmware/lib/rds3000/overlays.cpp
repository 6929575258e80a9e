#include "firmware/lib/rds3000/overlays.h"

#include <algorithm>

#include "sim/base/check.h"

namespace dendro::lib {
namespace {

constexpr std::uint32_t kPageWords = 4096;
constexpr std::uint32_t kMostPages = 8;  // three bits of the entry point
constexpr unsigned kPageLow = 12;        // of the entry point

}  // namespace

Overlays::Overlays(RdsDriver& driver, std::uint32_t control_store_words)
    : driver_(driver), pages_(std::clamp(control_store_words / kPageWords, 1u, kMostPages)) {}

std::uint32_t Overlays::activate(const ProgramImage& image) {
  DENDRO_CHECK(image.entry < kPageWords, "{} is not at origin 0", image.name);
  auto page = std::find_if(pages_.begin(), pages_.end(), [&](const Page& p) { return p.image == &image; });
  const bool resident = page != pages_.end();
  if (!resident)
    page = std::min_element(pages_.begin(), pages_.end(),
                            [](const Page& a, const Page& b) { return a.wanted < b.wanted; });
  const auto number = static_cast<std::uint32_t>(page - pages_.begin());
  *page = {&image, ++clock_};
  if (resident) {
    driver_.write_initial_scratch(image);
  } else {
    driver_.load_program(image, number);
    ++loads_;
  }
  return image.entry | number << kPageLow;
}

}  // namespace dendro::lib
