#include "sim/scene/psnr.h"

#include <cmath>

namespace dendro::scene {

std::optional<double> psnr(double squares, std::size_t count) {
  if (squares == 0) return std::nullopt;
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(count) / squares);
}

std::optional<double> psnr(const std::vector<std::uint8_t>& a, const std::uint8_t* b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(double(a[i]) - double(b[i]), 2);
  return psnr(squares, a.size());
}

}  // namespace dendro::scene
