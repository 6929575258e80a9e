#include "firmware/half_space/stability/exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dendro::half_space {
namespace {

constexpr unsigned kPlaces = 32;
constexpr std::int64_t kFar = std::int64_t{1} << 61;
constexpr double kUnit = 4294967296.0;  // 2^32

double largest_of(const ScreenPlane& p) { return std::max(std::abs(p.a), std::abs(p.b)); }

mpz_class floor_of(const mpz_class& numerator, const mpz_class& denominator) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  return result;
}

const char* name_of(PlaneKind kind) {
  return kind == PlaneKind::kFront ? "front" : kind == PlaneKind::kBack ? "back" : "edge-on";
}

int clamped_depth(std::int64_t value32, int maxdepth) {
  return static_cast<int>(std::clamp<std::int64_t>(value32 >> kPlaces, 0, maxdepth));
}

}  // namespace

ExactPlane::ExactPlane(const ScreenPlane& plane) : kind_(plane.kind), face_(plane.face) {
  const bool edge = plane.kind == PlaneKind::kEdgeOn;
  const double scale = largest_of(plane);
  const mpq_class by = edge ? mpq_class(scale > 0 ? scale : 1.0) : mpq_class(-plane.c);
  const mpq_class x = mpq_class(plane.a) / by, y = mpq_class(plane.b) / by, one = mpq_class(plane.d) / by;
  mpz_lcm(divisor_.get_mpz_t(), x.get_den().get_mpz_t(), y.get_den().get_mpz_t());
  mpz_lcm(divisor_.get_mpz_t(), divisor_.get_mpz_t(), one.get_den().get_mpz_t());
  x_ = x.get_num() * (divisor_ / x.get_den());
  y_ = y.get_num() * (divisor_ / y.get_den());
  one_ = one.get_num() * (divisor_ / one.get_den());
  x32_ = x_ << kPlaces, y32_ = y_ << kPlaces, one32_ = one_ << kPlaces;
}

std::int64_t ExactPlane::floor32(int x, int y) {
  mpz_mul_si(work_.get_mpz_t(), x32_.get_mpz_t(), x);
  mpz_add(work_.get_mpz_t(), work_.get_mpz_t(), one32_.get_mpz_t());
  mpz_mul_si(quotient_.get_mpz_t(), y32_.get_mpz_t(), y);
  mpz_add(work_.get_mpz_t(), work_.get_mpz_t(), quotient_.get_mpz_t());
  mpz_fdiv_q(quotient_.get_mpz_t(), work_.get_mpz_t(), divisor_.get_mpz_t());
  if (mpz_sizeinbase(quotient_.get_mpz_t(), 2) > 61) return sgn(quotient_) < 0 ? -kFar : kFar;
  return static_cast<std::int64_t>(quotient_.get_si());
}

PlaneRecord ExactPlane::truncated(const Box& box) const {
  const auto fixed = [&](const mpz_class& numerator) {
    return static_cast<std::int64_t>(floor_of(mpz_class(numerator << kFractionBits), divisor_).get_si());
  };
  PlaneRecord record;
  record.kind = kind_;
  record.face = face_;
  record.start = fixed(mpz_class(x_ * box.x0 + y_ * box.y0 + one_));
  record.step_x = fixed(x_);
  record.step_y = fixed(y_);
  return record;
}

Enclosure::Enclosure(const Prepared& prepared, Rounding rounding)
    : prepared_(prepared),
      step_slack_(static_cast<std::int64_t>(rounding) << (kPlaces - 17)),
      ranges_(prepared.screen.size()) {
  for (const ScreenPlane& plane : prepared.screen) exact_.emplace_back(plane);
}

std::int64_t Enclosure::slack(std::size_t index, int x, int y) const {
  if (step_slack_ == 0) return 0;
  const ScreenPlane& p = prepared_.screen[index];
  const Box& box = prepared_.program.box;
  const int i = x - box.x0, j = y - box.y0;
  // What the host's double precision adds: quotients are right to half an ulp, the start's sum to a few.
  const double divisor = p.kind == PlaneKind::kEdgeOn ? largest_of(p) : std::abs(p.c);
  const double sizes =
      std::abs(p.a) * (i + 1 + 4 * box.x0) + std::abs(p.b) * (j + 1 + 4 * box.y0) + 4 * std::abs(p.d);
  const double host = divisor > 0 ? std::min(std::ceil(sizes / divisor * kUnit * 0x1p-52) + 1, 0x1p60) : 1;
  return (i + j + 1) * step_slack_ + static_cast<std::int64_t>(host);
}

Enclosure::Pixel Enclosure::at(int x, int y) {
  const int maxdepth = prepared_.program.maxdepth;
  Pixel pixel;
  pixel.back = {maxdepth, maxdepth};
  for (std::size_t k = 0; k < exact_.size(); ++k) {
    const std::int64_t value = exact_[k].floor32(x, y), off = slack(k, x, y);
    const std::int64_t low = value - off, high = value + off;
    const PlaneKind kind = prepared_.screen[k].kind;
    if (kind == PlaneKind::kEdgeOn) {
      const bool sure = low > 0;
      if (sure) pixel.surely_outside = true, pixel.outside = k;
      if (sure || (off != 0 && high >= 0)) pixel.maybe_outside = true;
      continue;
    }
    const Range range{clamped_depth(low, maxdepth), clamped_depth(high, maxdepth)};
    ranges_[k] = range;
    if (kind == PlaneKind::kBack) {
      pixel.back.low = std::min(pixel.back.low, range.low);
      if (range.high < pixel.back.high) pixel.back.high = range.high, pixel.lowest_back = k;
    } else {
      if (range.low > pixel.front.low) pixel.front.low = range.low, pixel.highest_front = k;
      pixel.front.high = std::max(pixel.front.high, range.high);
    }
  }
  return pixel;
}

std::string Enclosure::describe(std::size_t index, int x, int y) {
  const Box& box = prepared_.program.box;
  const ScreenPlane& p = prepared_.screen[index];
  return fmt::format("plane {} ({}{}) at step {} of line {} is at {:.6f} +- {:.6f}", index + 1,
                     name_of(p.kind), p.face != 0 ? fmt::format(", face {}", p.face) : "", x - box.x0,
                     y - box.y0, static_cast<double>(exact_[index].floor32(x, y)) / kUnit,
                     static_cast<double>(slack(index, x, y)) / kUnit);
}

std::string Enclosure::object_to_face(int x, int y, int face, int depth) {
  for (std::size_t k = 0; k < prepared_.screen.size(); ++k) {
    const ScreenPlane& plane = prepared_.screen[k];
    if (plane.kind != PlaneKind::kFront) continue;
    const bool possible = ranges_[k].low <= depth && depth <= ranges_[k].high;
    if (plane.face == face) return possible ? "" : describe(k, x, y);
    if (possible && ranges_[k].low == ranges_[k].high) return "earlier " + describe(k, x, y);
  }
  return fmt::format("there is no face {}", face);
}

std::string Enclosure::objection(int x, int y, std::uint32_t word) {
  const Pixel pixel = at(x, y);
  const int maxdepth = prepared_.program.maxdepth;
  const int face = face_of(word), depth = depth_of(word);
  std::string why;
  if (face == 0) {
    const bool surely =
        !pixel.maybe_outside && pixel.front.high < pixel.back.low && pixel.back.high < maxdepth;
    if (!surely) return "";
    why = describe(pixel.highest_front, x, y) + " before " + describe(pixel.lowest_back, x, y);
  } else if (pixel.surely_outside) {
    why = describe(pixel.outside, x, y);
  } else if (pixel.back.low >= maxdepth || pixel.front.low >= pixel.back.high) {
    why = pixel.back.low >= maxdepth
              ? "no back plane is before the largest depth"
              : describe(pixel.highest_front, x, y) + " not before " + describe(pixel.lowest_back, x, y);
  } else if (depth < pixel.front.low || depth > pixel.front.high) {
    why = fmt::format("front is {}..{}: ", pixel.front.low, pixel.front.high) +
          describe(pixel.highest_front, x, y);
  } else {
    why = object_to_face(x, y, face, depth);
  }
  if (why.empty()) return "";
  return fmt::format("pixel ({}, {}) shows {}, but {}", x, y,
                     face == 0 ? "background" : fmt::format("face {} at depth {}", face, depth), why);
}

bool Enclosure::decided(int x, int y) {
  const Pixel p = at(x, y);
  const int maxdepth = prepared_.program.maxdepth;
  if (p.surely_outside || p.back.low >= maxdepth || p.front.low >= p.back.high) return true;
  if (p.maybe_outside || p.back.high >= maxdepth || p.front.high >= p.back.low) return false;
  if (p.front.low != p.front.high) return false;
  for (std::size_t k = 0; k < prepared_.screen.size(); ++k) {
    if (prepared_.screen[k].kind != PlaneKind::kFront) continue;
    if (ranges_[k].high < p.front.low) continue;
    return ranges_[k].low == ranges_[k].high;
  }
  return true;
}

namespace {

class RecordValue {
 public:
  RecordValue(const PlaneRecord& record, const Box& box)
      : record_(record),
        box_(box),
        start_(static_cast<long>(record.start)),
        step_x_(static_cast<long>(record.step_x)),
        step_y_(static_cast<long>(record.step_y)) {}

  const PlaneRecord& record() const { return record_; }

  /// For an edge-on plane the sign.
  int sign(int x, int y) { return sgn(evaluate(x, y)); }
  int depth(int x, int y, int maxdepth) {
    mpz_fdiv_q_2exp(value_.get_mpz_t(), evaluate(x, y).get_mpz_t(), kFractionBits);
    if (sgn(value_) <= 0) return 0;
    return cmp(value_, maxdepth) >= 0 ? maxdepth : static_cast<int>(value_.get_si());
  }

 private:
  const mpz_class& evaluate(int x, int y) {
    mpz_mul_si(value_.get_mpz_t(), step_x_.get_mpz_t(), x - box_.x0);
    mpz_mul_si(line_.get_mpz_t(), step_y_.get_mpz_t(), y - box_.y0);
    mpz_add(value_.get_mpz_t(), value_.get_mpz_t(), line_.get_mpz_t());
    mpz_add(value_.get_mpz_t(), value_.get_mpz_t(), start_.get_mpz_t());
    return value_;
  }

  const PlaneRecord& record_;
  const Box& box_;
  mpz_class start_, step_x_, step_y_, value_, line_;
};

std::vector<RecordValue> values_of(const std::vector<PlaneRecord>& records, const Box& box) {
  std::vector<RecordValue> values;
  for (const PlaneRecord& record : records) values.emplace_back(record, box);
  return values;
}

}  // namespace

std::vector<std::uint32_t> exact_record_words(const PlaneProgram& program) {
  auto back = values_of(program.back, program.box);
  auto edge_on = values_of(program.edge_on, program.box);
  auto front = values_of(program.front, program.box);
  const int maxdepth = program.maxdepth;
  std::vector<int> depths(front.size());
  const auto word_at = [&](int x, int y) {
    for (RecordValue& plane : edge_on)
      if (plane.sign(x, y) > 0) return kBackgroundWord;
    int nearest_back = maxdepth, farthest_front = 0;
    for (RecordValue& plane : back) nearest_back = std::min(nearest_back, plane.depth(x, y, maxdepth));
    for (std::size_t k = 0; k < front.size(); ++k) {
      depths[k] = front[k].depth(x, y, maxdepth);
      farthest_front = std::max(farthest_front, depths[k]);
    }
    if (nearest_back == maxdepth || farthest_front >= nearest_back) return kBackgroundWord;
    const auto shown = std::find(depths.begin(), depths.end(), farthest_front);
    const int face = shown == depths.end() ? 0 : front[shown - depths.begin()].record().face;
    return static_cast<std::uint32_t>(face << kFaceLow | farthest_front);
  };
  std::vector<std::uint32_t> words(static_cast<std::size_t>(program.width) * program.height, 0);
  for (int y = program.box.y0; y <= program.box.y1; ++y)
    for (int x = program.box.x0; x <= program.box.x1; ++x)
      words[static_cast<std::size_t>(y) * program.width + x] = word_at(x, y);
  return words;
}

}  // namespace dendro::half_space
