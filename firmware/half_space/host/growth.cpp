#include "firmware/half_space/host/growth.h"

#include <array>
#include <cmath>
#include <random>

#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kMostDraws = 1000;

/// A number that counts what is done with it.
class Real {
 public:
  Real(double value, GrowthCount& count) : value_(value), count_(&count) {}

  double value() const { return value_; }
  /// The same number, its further operations booked elsewhere.
  Real in(GrowthCount& count) const { return {value_, count}; }
  Real looked_up(double (*function)(double)) const {
    ++count_->look_ups;
    return {function(value_), *count_};
  }
  bool below(double limit) const {
    ++count_->comparisons;
    return value_ < limit;
  }

  friend Real operator+(Real a, Real b) { return a.after(a.value_ + b.value_); }
  friend Real operator-(Real a, Real b) { return a.after(a.value_ - b.value_); }
  friend Real operator*(Real a, Real b) { return a.after(a.value_ * b.value_); }
  friend Real operator/(Real a, Real b) { return a.after(a.value_ / b.value_); }
  friend Real operator*(Real a, double b) { return a.after(a.value_ * b); }
  friend Real operator+(Real a, double b) { return a.after(a.value_ + b); }

 private:
  Real after(double value) const {
    ++count_->flops;
    return {value, *count_};
  }

  double value_;
  GrowthCount* count_;
};

using Vector = std::array<Real, 3>;

Vector vector(const glm::dvec3& v, GrowthCount& count) {
  return {Real(v.x, count), Real(v.y, count), Real(v.z, count)};
}
glm::dvec3 plain(const Vector& v) { return {v[0].value(), v[1].value(), v[2].value()}; }
Vector operator*(const Vector& v, Real s) { return {v[0] * s, v[1] * s, v[2] * s}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

struct Node {
  glm::dvec3 origin{}, direction{};
  double length = 0;
  double mean_angle = 0, sigma_angle = 0;
  int generation = 0;
  std::uint64_t index = 0;  ///< in the unpruned tree: the children of i are 2i and 2i + 1

  bool is_split = false;
  glm::dvec3 b{};                       ///< the children's origin
  std::array<double, 2> angle{};        ///< between this and each child
  std::array<int, 2> child = {-1, -1};  ///< numbers of nodes, -1: pruned
};

/// SplitMix64's finaliser: every bit of the input moves every bit of the result.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return x ^ x >> 31;
}

class Stream {
 public:
  Stream(std::uint64_t seed, int generation, std::uint64_t index)
      : engine_(mix(mix(mix(seed) + static_cast<std::uint64_t>(generation)) + index)) {}

  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Box-Muller.  ASSUMED DEV-045
  Real gauss(GrowthCount& count) {
    ++count.look_ups;
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return {radius * std::cos(2.0 * kPi * uniform()), count};
  }

 private:
  std::mt19937_64 engine_;
};

class Growth {
 public:
  explicit Growth(const GrowthParameters& parameters) : parameters_(parameters) {
    for (std::size_t i = 0; i < parameters.start.size(); ++i) {
      Node node;
      node.length = length_of(parameters.start[i]);
      DENDRO_CHECK(node.length > 0);
      node.direction = parameters.start[i] / node.length;
      node.mean_angle = parameters.mean_angle, node.sigma_angle = parameters.sigma_angle;
      node.index = i;
      nodes_.push_back(node);
      result_.original.push_back({node.direction, node.length});
    }
  }

  Grown run() {
    std::vector<int> current;
    for (std::size_t i = 0; i < nodes_.size(); ++i) current.push_back(static_cast<int>(i));
    for (int generation = 0; generation < parameters_.generations; ++generation) {
      std::vector<int> next;
      for (const int at : current)
        if (!parameters_.splits || result_.splits < *parameters_.splits) split(at, next);
      current = std::move(next);
    }
    for (std::size_t i = 0; i < parameters_.start.size(); ++i) collect(static_cast<int>(i));
    for (std::size_t i = 0; i < parameters_.start.size(); ++i)
      if (const std::optional<double> offset = relaxed_offset(static_cast<int>(i)))
        result_.relaxed.push_back({nodes_[i].direction, *offset});
    return std::move(result_);
  }

 private:
  static double length_of(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

  /// Repeats `draw` until `good` accepts it.
  template <typename Draw, typename Good>
  static Real draw_until(const char* what, Draw&& draw, Good&& good) {
    for (int i = 0; i < kMostDraws; ++i)
      if (const Real value = draw(); good(value)) return value;
    throw GrowthError(what);
  }

  /// Two unit vectors across `u` and a turn about it: the plane in which a normal splits (FG86-K7).
  Vector across(const Vector& u, Real turn) {
    GrowthCount& count = result_.vectors;
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (Real(std::abs(u[i].value()), count).below(std::abs(u[k].value()))) k = i;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real length = (u[i] * u[i] + u[j] * u[j]).looked_up(std::sqrt);
    // axis_k x u, then u x that: the component k of the first is zero, which saves half the products.
    Vector e1 = u, e2 = u;
    e1[k] = Real(0, count), e1[i] = u[j] * -1.0 / length, e1[j] = u[i] / length;
    e2[k] = u[i] * e1[j] - u[j] * e1[i], e2[i] = u[k] * e1[j] * -1.0, e2[j] = u[k] * e1[i];
    const Real c = turn.looked_up(std::cos), s = turn.looked_up(std::sin);
    Vector across = e2 * s;
    across[i] = across[i] + e1[i] * c, across[j] = across[j] + e1[j] * c;
    return across;
  }

  Real draw_angle(const Node& node, Stream& stream) {
    GrowthCount& count = result_.printed;
    return draw_until(
        "1000 angles in a row are not below alpha_max",
        [&] { return stream.gauss(count) * node.sigma_angle + node.mean_angle; },
        [&](Real a) { return Real(std::abs(a.value()), count).below(parameters_.angle_limit); });
  }

  struct Side {
    Real angle, cosine, length;
  };

  /// Steps 2 and 3 for one child. A length beyond its limit takes a new angle too: near a right angle no
  /// noise would mend it.
  Side draw_side(const Node& node, Real distance, Real noise, Stream& stream) {
    GrowthCount& count = result_.printed;
    for (int i = 0; i < kMostDraws; ++i) {
      const Real angle = draw_angle(node, stream);
      const Real cosine = angle.looked_up(std::cos);
      const Real length = stream.gauss(count) * noise + distance / cosine;
      if (!length.below(1e-9 * node.length) && length.below(parameters_.length_limit * node.length))
        return {angle, cosine, length};
    }
    throw GrowthError("1000 lengths in a row lie beyond length_limit");
  }

  void split(int at, std::vector<int>& next) {
    Node node = nodes_[at];
    Stream stream(parameters_.seed, node.generation, node.index);
    GrowthCount &printed = result_.printed, &space = result_.vectors;
    ++result_.splits;
    const Real l(node.length, printed);
    const Real distance = draw_until(
        "1000 distances |BC| in a row are not positive",
        [&] { return (stream.gauss(printed) * parameters_.sigma_b + parameters_.mean_b) * l; },
        [&](Real d) { return !d.below(1e-9 * node.length); });
    const Vector u = vector(node.direction, space);
    const Vector b = vector(node.origin, space) + u * (l.in(space)-distance);
    const Vector s = across(u, Real(2.0 * kPi * stream.uniform(), space));
    const Real noise = l * parameters_.sigma_length;
    node.is_split = true;
    node.b = plain(b);
    for (int side = 0; side < 2; ++side) {
      const Side drawn = draw_side(node, distance, noise, stream);
      const Real sine = drawn.angle.in(space).looked_up(std::sin);
      const Vector turned = s * sine, along = u * drawn.cosine.in(space);
      const Vector direction = side == 0 ? along + turned : along - turned;
      Node child;
      child.origin = node.b;
      child.direction = plain(direction);
      child.length = drawn.length.value();
      child.generation = node.generation + 1;
      child.index = 2 * node.index + static_cast<std::uint64_t>(side);
      node.angle[side] = drawn.angle.value();
      if (parameters_.prune && !points_outwards(direction, b)) {
        ++result_.pruned;
        continue;
      }
      node.child[side] = static_cast<int>(nodes_.size());
      nodes_.push_back(child);
    }
    narrow(node);
    if (node.child[0] < 0 && node.child[1] < 0 && parameters_.keep_parent) node.is_split = false;
    for (const int child : node.child)
      if (child >= 0) next.push_back(child);
    nodes_[at] = node;
  }

  /// Step 4: one smaller angle for both children.
  void narrow(const Node& node) {
    const double mean = (Real(node.mean_angle, result_.printed) * parameters_.ratio).value();
    const double sigma = (Real(node.sigma_angle, result_.printed) * parameters_.ratio).value();
    for (const int child : node.child)
      if (child >= 0) nodes_[child].mean_angle = mean, nodes_[child].sigma_angle = sigma;
  }

  bool points_outwards(const Vector& direction, const Vector& origin) {
    for (int i = 0; i < 3; ++i)
      if ((direction[i].in(result_.pruning) * origin[i]).below(0)) return false;
    return true;
  }

  void collect(int at) {
    const Node& node = nodes_[at];
    if (!node.is_split) {
      result_.planes.push_back({node.direction, offset_of(node)});
      return;
    }
    for (const int child : node.child)
      if (child >= 0) collect(child);
  }

  static double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static double offset_of(const Node& node) { return dot(node.direction, node.origin) + node.length; }

  /// sin a2·u2 + sin a1·u3 = sin(a1 + a2)·u, so bounds along both children give one along the parent.
  std::optional<double> relaxed_offset(int at) const {
    const Node& node = nodes_[at];
    if (!node.is_split) return offset_of(node);
    const double a1 = node.angle[0], a2 = node.angle[1];
    if (node.child[0] < 0 || node.child[1] < 0 || !(a1 > 0) || !(a2 > 0)) return std::nullopt;
    const std::optional<double> e2 = relaxed_offset(node.child[0]), e3 = relaxed_offset(node.child[1]);
    if (!e2 || !e3) return std::nullopt;
    const double l2 = *e2 - dot(nodes_[node.child[0]].direction, node.b);
    const double l3 = *e3 - dot(nodes_[node.child[1]].direction, node.b);
    return dot(node.direction, node.b) + (l2 * std::sin(a2) + l3 * std::sin(a1)) / std::sin(a1 + a2);
  }

  const GrowthParameters& parameters_;
  std::vector<Node> nodes_;
  Grown result_;
};

}  // namespace

GrowthCount& GrowthCount::operator+=(const GrowthCount& other) {
  flops += other.flops, look_ups += other.look_ups, comparisons += other.comparisons;
  return *this;
}

Grown grow(const GrowthParameters& parameters) { return Growth(parameters).run(); }

}  // namespace dendro::half_space
