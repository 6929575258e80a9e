#include "firmware/half_space/stability/planes_support.h"

#include <algorithm>
#include <cmath>

#include "firmware/half_space/pixel_planes/planes_program.h"

namespace dendro::half_space {
namespace {

constexpr unsigned kMachineBits = 72, kColourBits = 24;

}  // namespace

PlanesRig::PlanesRig(const stability::Rig& rig, unsigned depth_bits) {
  layout_.depth_bits = depth_bits;
  layout_.front = 0, layout_.back = depth_bits, layout_.nearest = 2 * depth_bits, layout_.colour = 3 * depth_bits;
  layout_.used = layout_.scratch = layout_.index = 3 * depth_bits + kColourBits;
  site_.width = site_.height = kSide;
  site_.memory_bits = static_cast<int>(std::max(kMachineBits, layout_.used));
  rig_ = rig.with({{"array.memory_bits", site_.memory_bits}});
}

StreamPlane PlanesRig::stream(const ScreenPlane& plane, unsigned fraction) const {
  return make_stream_plane(plane, site_, layout_, fraction, 1, 16, {"stability", 0});
}

Field PlanesRig::draw(const std::vector<StreamPlane>& planes, unsigned low) const {
  PreparedPlanes prepared;
  prepared.width = prepared.height = kSide;
  prepared.layout = layout_;
  prepared.maxdepth = most();
  prepared.faces = {Rgb{255, 255, 255}};
  prepared.hulls.emplace_back();
  prepared.hulls[0].planes = planes;
  prepared.tiles = {{lib::Tile{}, {{0, planes}}}};
  Field field;
  const lib::IgcPrograms programs = rig_->igc_programs({"firmware/half_space/pixel_planes/half_space.igc"});
  rig_->run([&](HostPort& host) { half_space::run(host, prepared, programs, site_); },
            [&](const MachineView& machine) {
              for (std::uint32_t pixel = 0; pixel < kSide * kSide; ++pixel)
                field.push_back(machine.peek(pixel, low) & most());
            });
  return field;
}

std::int64_t exact_coefficient(float value, unsigned fraction) {
  const mpq_class scaled = mpq_class(value) * mpq_class(mpz_class(1) << fraction);
  mpz_class whole;
  mpz_fdiv_q(whole.get_mpz_t(), scaled.get_num_mpz_t(), scaled.get_den_mpz_t());
  const mpq_class rest = scaled - whole, half(1, 2);
  if (rest > half || (rest == half && mpz_odd_p(whole.get_mpz_t()))) ++whole;
  return static_cast<std::int64_t>(whole.get_si());
}

ExactStream::ExactStream(const StreamPlane& plane)
    : a_(exact_coefficient(plane.expression.a, plane.fraction)),
      b_(exact_coefficient(plane.expression.b, plane.fraction)),
      c_(exact_coefficient(plane.expression.c, plane.fraction)),
      fraction_(plane.fraction) {}

unsigned ExactStream::guard(unsigned depth_bits) const {
  constexpr int kLast = PlanesRig::kSide - 1;
  std::int64_t low = INT64_MAX, high = INT64_MIN;
  for (const int x : {0, kLast})
    for (const int y : {0, kLast}) low = std::min(low, floor(x, y)), high = std::max(high, floor(x, y));
  unsigned guard = 1;
  while (low < -(std::int64_t{1} << (depth_bits + guard - 1)) || high >= std::int64_t{1} << (depth_bits + guard - 1))
    ++guard;
  return guard;
}

ScreenPlane plane_of(PlaneKind kind, double a, double b, double c) {
  ScreenPlane plane = kind == PlaneKind::kFront ? ScreenPlane{a, b, -1, c} : ScreenPlane{-a, -b, 1, -c};
  plane.kind = kind;
  return plane;
}

double stream_slack(const ScreenPlane& plane, unsigned fraction, int x, int y) {
  const double steps = (x + y + 1) * std::ldexp(0.5, -static_cast<int>(fraction));
  const double sizes = (std::abs(plane.a) * x + std::abs(plane.b) * y + std::abs(plane.d)) / std::abs(plane.c);
  return steps + sizes * 0x1p-24 * (1 + 0x1p-20);
}

}  // namespace dendro::half_space
