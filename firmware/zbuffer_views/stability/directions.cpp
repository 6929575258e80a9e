#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <sstream>

#include "firmware/lib/big_real.h"
#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/plane.h"

// N-B1: the smallest m with m > 2n sin(k pi / n) for all circles of 2 to 32 bands. N-B2: which views are chosen, with one view at
// a time holding a sample, and what a plane looks like from both sides of every border.

namespace dendro::zbuffer_views {
namespace {

using stability::BigReal;
using stability::Result;

constexpr int kTable[] = {7, 14, 23, 34, 51, 66, 87, 108, 135, 160, 191};  // 2 to 12 bands [algorithms.md N-B1]

/// Niven: the sine is rational at the sixths and the half only, where the product is n or 2n; elsewhere 128 bits tell.
int exact_circle(int n, int k) {
  if (k == 0 || k == n) return 1;
  const BigReal product = BigReal(2 * n) * sin(BigReal::pi() * BigReal(k) / BigReal(n));
  const double nearest = std::round(product.to_double());
  const bool whole = 6 * k == n || 6 * k == 5 * n || 2 * k == n;
  if (whole) return static_cast<int>(nearest) + 1;
  return static_cast<int>(floor(product).to_double()) + 1;
}

/// What plain double precision makes of it.
int careless_circle(int n, int k) {
  return k == 0 || k == n ? 1 : static_cast<int>(std::floor(2 * n * std::sin(M_PI * k / n))) + 1;
}

std::vector<int> numbers_after_colon(const std::string& text) {
  std::istringstream in(text.substr(text.find(':') + 1));
  std::vector<int> numbers;
  for (int n = 0; in >> n;) numbers.push_back(n);
  return numbers;
}

/// V5 by 128 bits. On a border, or as near as double precision cannot tell, both sides are admitted.
class ExactChoice {
 public:
  ExactChoice(int bands, const std::array<double, 3>& to_viewer) {
    const BigReal x = to_viewer[0], y = to_viewer[1], z = to_viewer[2], turn = BigReal(2) * BigReal::pi();
    const BigReal level = sqrt(x * x + z * z);
    BigReal phi = atan2(x, z);
    if (phi < BigReal(0)) phi = phi + turn;
    for (const int band : whole_parts(atan2(level, y) * BigReal(bands) / BigReal::pi())) {
      const int k = std::clamp(band, 0, bands - 1);
      std::vector<std::set<int>> sets = {{}};
      for (int circle = k; circle <= k + 1; ++circle) add_circle(bands, circle, phi / turn, sets);
      admitted_.insert(sets.begin(), sets.end());
    }
  }

  bool at_border() const { return admitted_.size() > 1; }
  bool admits(const std::set<int>& chosen) const { return admitted_.count(chosen) > 0; }

 private:
  /// The floor; two of them if a rounding of double precision may change it.
  static std::vector<int> whole_parts(const BigReal& value) {
    const BigReal nearest = floor(value + BigReal(0.5));
    const int whole = static_cast<int>(nearest.to_double());
    if (abs(value - nearest) < BigReal(0x1p-46)) return {whole - 1, whole};
    return {static_cast<int>(floor(value).to_double())};
  }

  static void add_circle(int bands, int circle, const BigReal& turns, std::vector<std::set<int>>& sets) {
    int first = 0;
    for (int k = 0; k < circle; ++k) first += exact_circle(bands, k);
    const int count = exact_circle(bands, circle);
    std::vector<std::set<int>> out;
    for (const std::set<int>& set : sets)
      for (const int whole : whole_parts(turns * BigReal(count))) {
        std::set<int> more = set;
        const int j = (whole % count + count) % count;
        more.insert({first + j, first + (j + 1) % count});
        out.push_back(more);
      }
    sets = out;
  }

  std::set<std::set<int>> admitted_;
};

/// Directions exactly on borders (integers), just beside them, and anywhere.
std::vector<std::array<double, 3>> directions(std::uint64_t seed) {
  std::vector<std::array<double, 3>> all;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          for (const double aside : {0.0, 0x1p-20, -0x1p-20})
            for (std::size_t axis = 0; axis < (aside == 0 ? 1u : 3u); ++axis) {
              std::array<double, 3> d = {4.0 * x, 4.0 * y, 4.0 * z};
              d[axis] += aside;
              all.push_back(d);
            }
  std::mt19937_64 random(seed);
  for (int i = 0; i < 200; ++i) {
    std::array<double, 3> d;
    for (double& c : d) c = (static_cast<double>(random() % 2001) - 1000) / 128;
    if (d[0] != 0 || d[1] != 0 || d[2] != 0) all.push_back(d);
  }
  return all;
}

struct Counts {
  Faults choice, border, places;
  std::int64_t borders = 0;
};

/// Which views the program takes: one at a time has a sample, at the tree's centre.
void compare_choices(const stability::Rig& rig, int bands, std::uint64_t seed, Counts& counts) {
  const auto all = directions(seed);
  std::vector<std::set<int>> chosen(all.size());
  Blank blank = blank_views(rig, bands, 8, 0.125f);
  blank.job.facts.projection = kZbvPerspective;
  blank.job.facts.scale = 1;
  blank.job.facts.width = blank.job.facts.height = 8;
  blank.job.facts.centre_x = blank.job.facts.centre_y = 3.5f;
  for (const auto& d : all) {
    zbv_frame frame = facing(d, 1);
    // The direction is that of the eye, which holds these numbers exactly.
    for (std::size_t i = 0; i < 3; ++i) frame.eye[i] = static_cast<float>(d[i]);
    blank.job.frames.push_back(frame);
  }
  for (std::size_t v = 0; v < blank.views.views.size(); ++v) {
    ViewsFile views = blank.views;
    put_sample(views, v, 4, 4, 0, 0);
    const Pictures drawn = reconstructed(rig, views, blank.job);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (drawn.pictures[i].facts.covered > 0) chosen[i].insert(static_cast<int>(v));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ExactChoice exact(bands, all[i]);
    counts.borders += exact.at_border();
    if (exact.admits(chosen[i])) continue;
    (exact.at_border() ? counts.border : counts.choice)
        .fault(fmt::format("{} bands, direction ({}, {}, {}): {} views are not those around it", bands, all[i][0], all[i][1],
                           all[i][2], chosen[i].size()));
  }
}

struct Border {
  const char* name;
  double latitude, longitude;    ///< degrees
  double up, around;             ///< the step over the border
};
/// Of 3 bands: circles at 90, 30, -30, -90 degrees of latitude, six views each.
constexpr Border kBorders[] = {{"north pole", 90, 0, 0, 0},       {"circle at 30 degrees", 30, 20, 1, 0},
                               {"circle at -30 degrees", -30, 40, 1, 0}, {"wrap of longitudes", 10, 0, 0, 1},
                               {"longitude of a view", 55, 60, 0, 1}, {"south pole", -90, 0, 0, 0}};

struct Changes {
  double worst = 0;  ///< error of depth in reprojection errors
  std::string where;
  Faults holes;
  std::int64_t switched = 0, pixels = 0;
};

std::array<double, 3> direction_of(double latitude, double longitude) {
  const double t = latitude * M_PI / 180, p = longitude * M_PI / 180;
  return {std::cos(t) * std::sin(p), std::sin(t), std::cos(t) * std::cos(p)};
}

/// A sample may lie half a pixel beside the middle of its pixel; the rest is single precision.
constexpr double kSingle = 0x1p-17;

void compare_plane(const Pictures::Picture& picture, const JobFile& job, const zbv_frame& frame, const Plane& plane,
                   const std::string& name, Changes& out) {
  const int w = static_cast<int>(job.facts.width), h = static_cast<int>(job.facts.height);
  const double pixel = 1.0 / job.facts.scale, bound = plane.steepness(frame.frame) * pixel / 2 + kSingle;
  double towards = 0;
  for (std::size_t i = 0; i < 3; ++i) towards += static_cast<double>(frame.frame[6 + i]) * frame.eye[i];
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const double x = (i - double(job.facts.centre_x)) * pixel, y = (j - double(job.facts.centre_y)) * pixel;
      const auto at = static_cast<std::size_t>((h - 1 - j) * w + i);
      if (picture.colour[at] == kZbvEmptyColour) {
        if (plane.contains(frame.frame, x, y, 2 * pixel))
          out.holes.fault(fmt::format("{}: pixel ({}, {}) is empty", name, i, h - 1 - j));
        continue;
      }
      ++out.pixels;
      const double error = std::abs(double(picture.depth[at]) - (plane.depth(frame.frame, x, y) - towards)) / bound;
      if (error > out.worst)
        out.worst = error, out.where = fmt::format("{}: pixel ({}, {})", name, i, h - 1 - j);
    }
}

/// Pictures of a plane that faces the camera obliquely, from both sides of a border.
void cross_border(const stability::Rig& rig, const Blank& blank, const Border& border, Changes& out) {
  constexpr double kStep = 1e-3;
  const bool pole = border.up == 0 && border.around == 0;
  std::vector<std::array<double, 3>> sides;
  if (pole)
    for (const double longitude : {10.0, 100.0, 220.0})
      sides.push_back(direction_of(border.latitude * (1 - 1e-5), longitude));
  else
    for (const double s : {-kStep, kStep})
      sides.push_back(direction_of(border.latitude + s * border.up, border.longitude + s * border.around));
  const auto d = direction_of(border.latitude, border.longitude);
  const Plane plane = {{d[0] + 0.3, d[1] - 0.2, d[2] + 0.25}, 0.05};
  ViewsFile views = blank.views;
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    const float* f = views.views[v].frame + 6;
    if (plane.normal[0] * f[0] + plane.normal[1] * f[1] + plane.normal[2] * f[2] < -0.3)
      store_plane(views, v, plane, static_cast<std::uint8_t>(v));
  }
  JobFile job = blank.job;
  for (const auto& side : sides) job.frames.push_back(facing(side, 8));
  const Pictures drawn = reconstructed(rig, views, job);
  std::set<std::set<std::uint8_t>> shown;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Pictures::Picture& picture = drawn.pictures[k];
    compare_plane(picture, job, job.frames[k], plane, fmt::format("{}, side {}", border.name, k + 1), out);
    shown.insert({picture.colour.begin(), picture.colour.end()});
  }
  out.switched += shown.size() > 1;
}

}  // namespace

Result view_counts(const stability::Rig& rig, std::uint64_t) {
  Faults table, circles;
  int careless = 0;
  for (int n = kZbvLeastBands; n <= kZbvMostBands; ++n) {
    stability::Files files;
    const auto counts = numbers_after_colon(exec(rig, "zbuffer_views_precompute", {"--directions", std::to_string(n)}, files));
    int sum = 0;
    for (int k = 0; k <= n; ++k) {
      const int got = k < static_cast<int>(counts.size()) ? counts[static_cast<std::size_t>(k)] : 0, wanted = exact_circle(n, k);
      sum += got;
      careless += careless_circle(n, k) != wanted;
      if (got != wanted) circles.fault(fmt::format("{} bands, circle {}: {} views, not {}", n, k, got, wanted));
    }
    if (n <= 12 && sum != kTable[n - 2]) table.fault(fmt::format("{} bands: {} views, not {}", n, sum, kTable[n - 2]));
  }
  return {{no_fault("N-B1", "2 to 12 bands: numbers of views that are not the table's", table, "numbers", "table"),
           no_fault("N-B1", "2 to 32 bands: circles whose number of views is not exact", circles, "circles", "mpfr, Niven"),
           must_show("N-B1", "circles that plain double precision gets wrong", careless, "circles", "mpfr, Niven")},
          {}};
}

Result view_borders(const stability::Rig& rig, std::uint64_t seed) {
  Counts counts;
  for (const int bands : {2, 3, 4}) compare_choices(rig, bands, seed, counts);
  Changes changes;
  const Blank blank = blank_views(rig, 3, 64, 1.0f / 32);
  for (const Border& border : kBorders) cross_border(rig, blank, border, changes);
  return {{no_fault("N-B2", "directions off every border whose views are not those around them", counts.choice, "directions",
                    "mpfr"),
           no_fault("N-B2", fmt::format("{} directions on a border with views of neither side", counts.borders), counts.border,
                    "directions", "mpfr"),
           {"N-B2", fmt::format("a plane on both sides of {} borders: largest error of depth", std::size(kBorders)),
            changes.worst, 1, "half pixels", "gmp", Bound::kAtMost, changes.where},
           no_fault("N-B2", fmt::format("pixels inside of the plane that are empty ({} are covered)", changes.pixels),
                    changes.holes, "pixels", "gmp"),
           must_show("N-B2", "borders where other views are shown on the other side",
                     static_cast<double>(changes.switched), "borders", "machine")},
          {}};
}

}  // namespace dendro::zbuffer_views
