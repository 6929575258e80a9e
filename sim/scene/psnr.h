#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace dendro::scene {

/// Peak signal-to-noise ratio, dB, of `count` 8-bit samples whose differences have this sum of squares; none: identical.
std::optional<double> psnr(double squares, std::size_t count);

/// Of as many samples as `a` has; none: identical.
std::optional<double> psnr(const std::vector<std::uint8_t>& a, const std::uint8_t* b);

}  // namespace dendro::scene
