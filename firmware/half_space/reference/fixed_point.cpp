#include "firmware/half_space/reference/fixed_point.h"

#include <algorithm>

#include "firmware/half_space/reference/stepper.h"

namespace dendro::half_space {
namespace {

class Passes {
 public:
  Passes(const PlaneProgram& program, FixedPointPicture& picture) : program_(program), picture_(picture) {}

  void run() {
    const auto maxdepth = static_cast<std::uint32_t>(program_.maxdepth);
    each_pixel([&](std::uint32_t&) { return maxdepth << kBackLow; });
    for (const PlaneRecord& plane : program_.back)
      scan(plane, [&](std::uint32_t pixel, std::int64_t z) {
        const std::uint32_t depth = clamp_depth(z);
        return depth < back_of(pixel) ? front_of(pixel) | depth << kBackLow : pixel;
      });
    for (const PlaneRecord& plane : program_.edge_on)
      scan(plane, [&](std::uint32_t pixel, std::int64_t side) {
        return side > 0 ? with_front(pixel, back_of(pixel)) : pixel;
      });
    for (const PlaneRecord& plane : program_.front)
      scan(plane, [&](std::uint32_t pixel, std::int64_t z) {
        const std::uint32_t depth = clamp_depth(z);
        return depth > front_of(pixel) ? with_front(pixel, std::min(depth, back_of(pixel))) : pixel;
      });
    each_pixel([&](std::uint32_t& pixel) {
      const bool empty = front_of(pixel) == back_of(pixel) || back_of(pixel) == maxdepth;
      return empty ? kBackgroundWord : front_of(pixel);
    });
    for (const PlaneRecord& plane : program_.front)
      scan(plane, [&](std::uint32_t pixel, std::int64_t z) {
        return pixel == clamp_depth(z) ? pixel | static_cast<std::uint32_t>(plane.face) << kFaceLow : pixel;
      });
  }

 private:
  static std::uint32_t front_of(std::uint32_t pixel) { return pixel & kFieldMask; }
  static std::uint32_t back_of(std::uint32_t pixel) { return pixel >> kBackLow & kFieldMask; }
  static std::uint32_t with_front(std::uint32_t pixel, std::uint32_t front) {
    return (pixel & ~kFieldMask) | front;
  }

  std::uint32_t clamp_depth(std::int64_t z) const {
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(z >> kFractionBits, 0, program_.maxdepth));
  }

  std::uint32_t& pixel(int x, int y) {
    return picture_.pixels[static_cast<std::size_t>(y) * picture_.width + x];
  }

  template <typename F>
  void each_pixel(F&& next) {
    for (int y = program_.box.y0; y <= program_.box.y1; ++y)
      for (int x = program_.box.x0; x <= program_.box.x1; ++x) pixel(x, y) = next(pixel(x, y));
  }

  template <typename F>
  void scan(const PlaneRecord& plane, F&& next) {
    step_over(plane, program_.box, program_.steep,
              [&](int x, int y, std::int64_t value) { pixel(x, y) = next(pixel(x, y), value); });
  }

  const PlaneProgram& program_;
  FixedPointPicture& picture_;
};

}  // namespace

FixedPointPicture run_fixed_point(const PlaneProgram& program, std::uint32_t before) {
  FixedPointPicture picture{
      program.width, program.height,
      std::vector<std::uint32_t>(static_cast<std::size_t>(program.width) * program.height, before)};
  Passes(program, picture).run();
  return picture;
}

}  // namespace dendro::half_space
