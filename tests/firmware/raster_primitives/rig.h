#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/raster_primitives/host/host_program.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"

/// The shipped micro-programs on a small array, and the pixels in plain integers beside them.
namespace dendro::raster_primitives {

constexpr int kSide = 64;

pixel_planes::Spec small_spec(int side = kSide);

/// The sources in firmware/raster_primitives/pixel_planes with these names.
lib::IgcPrograms assemble(const std::vector<std::string>& names, const Layout& layout);

/// A host whose words go to an array without time; counts the words that programs send to the array.
class ArrayPort : public HostPort {
 public:
  explicit ArrayPort(const pixel_planes::Spec& spec, bool lazy = false) : spec_(spec), device_(spec, lazy) {}

  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t address, std::uint32_t value, unsigned) override {
    if (const auto done = device_.write(address, value)) clocks += done->words;
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    for (std::size_t i = 0; i < count; ++i) write(address + static_cast<std::uint32_t>(i) * step, words[i], function);
  }
  void dma_from(std::uint32_t, std::uint32_t*, std::size_t, unsigned, std::uint32_t) override {}
  void command(std::uint32_t) override {}
  void wait_interrupt() override {}
  void compute(const Work& work) override { flops += work.flops; }
  void phase(std::string_view) override {}

  /// A field of a pixel.
  std::uint32_t field(int x, int y, unsigned low, unsigned bits) {
    return device_.peek(static_cast<std::uint32_t>(y * spec_.array.width + x), low) & ((std::uint64_t{1} << bits) - 1);
  }
  const std::vector<pixel_planes::Plane>& memory() { return device_.engine().bits().memory; }
  const pixel_planes::WordCounters& counters() { return device_.engine().counters(); }
  Picture picture() { return device_.picture(); }
  std::uint32_t peek(std::uint32_t pixel, unsigned low) const override { return device_.peek(pixel, low); }
  void program(std::string_view, std::uint32_t) override {}

  std::uint64_t clocks = 0, flops = 0;

 private:
  pixel_planes::Spec spec_;
  mutable pixel_planes::Device device_;  // reading brings waiting tiles up to date
};

/// floor(T) at a pixel, from the coefficients as the translator rounds them.
std::int64_t value_at(const Stream& stream, int x, int y);

/// The pixel's depth lies on the plane's side of shadow.
bool is_on_side(const ShadowPlane& plane, int x, int y, std::int64_t depth);

/// What the micro-programs do to pixels, in integers.
struct IntegerPixels {
  IntegerPixels(const Layout& layout, std::uint32_t farthest, int side = kSide);

  void triangle(const TriangleSetup& triangle);
  void sphere(const SphereSetup& sphere);
  /// Of one triangle, into `shadow`.
  void cast(const ShadowSetup& caster);
  void darken(std::uint32_t farthest);

  Layout layout;
  int side;
  std::vector<std::uint32_t> depth;
  std::vector<std::array<std::uint8_t, 3>> colour;
  std::vector<bool> flag, shadow;
};

/// Fails for the first pixel whose fields are others.
void expect_same(ArrayPort& port, const IntegerPixels& wanted);

}  // namespace dendro::raster_primitives
