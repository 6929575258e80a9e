#include "firmware/half_space/stability/growth_exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "firmware/lib/big_real.h"

namespace dendro::half_space {

using stability::BigReal;
namespace {

using Vector = std::array<BigReal, 3>;

constexpr double kUnit = 0x1p-53;  ///< of a double's rounding, relative
constexpr int kMostDraws = 1000;

Vector operator*(const Vector& v, const BigReal& s) { return {v[0] * s, v[1] * s, v[2] * s}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
BigReal dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double size(const Vector& v) { return std::sqrt(dot(v, v).to_double()); }

struct Normal {
  Vector origin{}, direction{};
  BigReal length = 0, mean_angle = 0, sigma_angle = 0;
  int generation = 0;
  std::uint64_t index = 0;
  double origin_bound = 0, direction_bound = 0, length_bound = 0;  ///< of the doubles, absolute
};

std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return x ^ x >> 31;
}

/// The uniform numbers of one split, and what Box-Muller makes of them.
class Stream {
 public:
  Stream(std::uint64_t seed, const Normal& n)
      : engine_(mix(mix(mix(seed) + static_cast<std::uint64_t>(n.generation)) + n.index)) {}

  BigReal uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  BigReal gauss() {
    const BigReal radius = sqrt(BigReal(-2) * log(BigReal(1) - uniform()));
    return radius * cos(BigReal(2) * BigReal::pi() * uniform());
  }

  /// The radius is at most 8.6 and off by a few roundings; the cosine by that of an argument up to 2 pi.
  static constexpr double kGaussBound = 8.6 * (4 + 7 + 1) * kUnit;

 private:
  std::mt19937_64 engine_;
};

struct Refused {};

class Exact {
 public:
  explicit Exact(const GrowthParameters& p) : p_(p) {}

  ExactGrown run() {
    try {
      for (std::size_t i = 0; i < p_.start.size(); ++i) {
        const Vector v = {p_.start[i].x, p_.start[i].y, p_.start[i].z};
        Normal n;
        n.length = sqrt(dot(v, v));
        n.direction = v * (BigReal(1) / n.length);
        n.mean_angle = p_.mean_angle, n.sigma_angle = p_.sigma_angle;
        n.index = i;
        n.direction_bound = 4 * kUnit, n.length_bound = 4 * kUnit * n.length.to_double();
        add(n);
      }
    } catch (const Refused&) {
      result_.refused = true;
      result_.planes.clear();
    }
    return std::move(result_);
  }

 private:
  struct Side {
    BigReal angle = 0, length = 0;
    double angle_bound = 0, length_bound = 0;
  };

  /// The planes that a normal ends as: itself after the last generation, else its children's. Splits are
  /// counted generation by generation, so `splits` needs another order: it is not supported here.
  void add(const Normal& n) {
    if (n.generation == p_.generations) {
      put(n);
      return;
    }
    const std::size_t before = result_.planes.size();
    bool kept = false;
    for (const std::optional<Normal>& child : split(n))
      if (child) kept = true, add(*child);
    if (!kept && p_.keep_parent) result_.planes.resize(before), put(n);
  }

  void put(const Normal& n) {
    ExactGrownPlane plane;
    for (int i = 0; i < 3; ++i) plane.normal[i] = n.direction[i].to_double();
    plane.offset = (dot(n.direction, n.origin) + n.length).to_double();
    const double reach = size(n.origin), length = std::abs(n.length.to_double());
    plane.normal_bound = n.direction_bound + kUnit;
    plane.offset_bound =
        3 * reach * n.direction_bound + 2 * n.origin_bound + n.length_bound + 5 * kUnit * (reach + length);
    result_.planes.push_back(plane);
  }

  template <typename Draw, typename Good>
  BigReal draw_until(Draw&& draw, Good&& good) {
    for (int i = 0; i < kMostDraws; ++i, ++result_.redraws)
      if (const BigReal value = draw(); good(value)) return value;
    throw Refused();
  }

  Side draw_side(const Normal& n, const BigReal& distance, double distance_bound, Stream& stream) {
    const double length = n.length.to_double();
    for (int i = 0; i < kMostDraws; ++i, ++result_.redraws) {
      Side side;
      side.angle = draw_until([&] { return stream.gauss() * n.sigma_angle + n.mean_angle; },
                              [&](const BigReal& a) { return abs(a) < BigReal(p_.angle_limit); });
      const BigReal noise = stream.gauss() * BigReal(p_.sigma_length) * n.length;
      side.length = distance / cos(side.angle) + noise;
      if (side.length < BigReal(1e-9) * n.length || !(side.length < BigReal(p_.length_limit) * n.length))
        continue;
      // 1 / cos a moves by tan a / cos a for each unit of a.
      const double angle = side.angle.to_double(), cosine = std::cos(angle),
                   tangent = std::abs(std::tan(angle));
      const double far = distance.to_double() / cosine, sigma = n.sigma_angle.to_double();
      side.angle_bound = sigma * (Stream::kGaussBound + 10 * kUnit) +
                         (n.generation + 2) * kUnit * (std::abs(n.mean_angle.to_double()) + 9 * sigma) +
                         kUnit * std::abs(angle);
      side.length_bound =
          distance_bound / cosine + far * (tangent * side.angle_bound + 2 * kUnit) +
          p_.sigma_length * (length * (Stream::kGaussBound + 20 * kUnit) + 9 * n.length_bound) +
          2 * kUnit * (far + std::abs(noise.to_double()));
      return side;
    }
    throw Refused();
  }

  /// Both children, one that is pruned without a value.
  std::array<std::optional<Normal>, 2> split(const Normal& n) {
    Stream stream(p_.seed, n);
    const double length = n.length.to_double();
    const BigReal share =
        draw_until([&] { return stream.gauss() * BigReal(p_.sigma_b) + BigReal(p_.mean_b); },
                   [&](const BigReal& d) { return !(d < BigReal(1e-9)); });
    const BigReal distance = share * n.length;
    const double distance_bound =
        length * (p_.sigma_b * (Stream::kGaussBound + 20 * kUnit) + 3 * kUnit * std::abs(share.to_double())) +
        std::abs(share.to_double()) * n.length_bound;
    const Vector b = n.origin + n.direction * (n.length - distance);
    const double along = std::abs((n.length - distance).to_double());
    const double b_bound = n.origin_bound + along * n.direction_bound + n.length_bound + distance_bound +
                           4 * kUnit * (size(n.origin) + along + length);

    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (abs(n.direction[i]) < abs(n.direction[k])) k = i;
    Vector axis{};
    axis[k] = 1;
    Vector e1 = cross(axis, n.direction);
    e1 = e1 * (BigReal(1) / sqrt(dot(e1, e1)));
    const Vector e2 = cross(n.direction, e1);
    const BigReal turn = BigReal(2) * BigReal::pi() * stream.uniform();
    const Vector across = e1 * cos(turn) + e2 * sin(turn);
    // |axis x u| is at least sqrt(2/3); an angle up to 2 pi is off by as many roundings.
    const double across_bound = 4 * n.direction_bound + (14 + 12) * kUnit;

    std::array<std::optional<Normal>, 2> children;
    for (int i = 0; i < 2; ++i) {
      const Side side = draw_side(n, distance, distance_bound, stream);
      const Vector turned = across * sin(side.angle), straight = n.direction * cos(side.angle);
      Normal child;
      child.origin = b;
      child.direction = i == 0 ? straight + turned : straight - turned;
      child.length = side.length;
      child.mean_angle = n.mean_angle * BigReal(p_.ratio),
      child.sigma_angle = n.sigma_angle * BigReal(p_.ratio);
      child.generation = n.generation + 1;
      child.index = 2 * n.index + static_cast<std::uint64_t>(i);
      child.origin_bound = b_bound;
      child.direction_bound = n.direction_bound + across_bound + side.angle_bound + 6 * kUnit;
      child.length_bound = side.length_bound;
      bool outwards = true;
      for (int c = 0; c < 3; ++c) outwards = outwards && !(child.direction[c] * b[c] < BigReal(0));
      if (!p_.prune || outwards) children[static_cast<std::size_t>(i)] = child;
    }
    return children;
  }

  const GrowthParameters& p_;
  ExactGrown result_;
};

}  // namespace

ExactGrown grow_exactly(const GrowthParameters& parameters) { return Exact(parameters).run(); }

}  // namespace dendro::half_space
