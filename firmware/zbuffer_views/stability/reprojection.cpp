#include <fmt/format.h>
#include <gmpxx.h>

#include <cmath>
#include <random>

#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/support.h"

// Single samples of the view from above, seen from above, where every sum of the program is exact: N-B4 ties between views, N-B6
// half pixels, N-B7 distances around 0.

namespace dendro::zbuffer_views {
namespace {

constexpr int kSide = 32;
constexpr float kPitch = 1.0f / 64;
constexpr float kStep = 0x1p-18f;  ///< that single precision keeps up to 32
constexpr std::uint32_t kOptions[] = {0, kZbvFullProduct, kZbvSkipEmpty};

/// Sample (0, 0) of every view lies on the trunk's axis.
Blank at_axis(const stability::Rig& rig) {
  Blank blank = blank_views(rig, 3, kSide, kPitch);
  for (zbv_view& view : blank.views.views) view.x0 = view.y0 = 0;
  return blank;
}

zbv_frame from_above(float height) { return {{0, height, 0}, {1, 0, 0, 0, 0, -1, 0, -1, 0}, {0, 1, 0}, 0}; }

mpz_class floor_of(const mpq_class& v) {
  mpz_class quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), v.get_num_mpz_t(), v.get_den_mpz_t());
  return quotient;
}

/// Ties to even: what has to differ.
long careless_round(double v) { return static_cast<long>(std::nearbyint(v)); }

struct Halves {
  Faults pixels;
  std::int64_t careless = 0, halves = 0;
};

/// All samples in a grid at depths of their own, at places that are multiples of half a pixel but for a smallest step.
void compare_halves(const stability::Rig& rig, Blank blank, std::mt19937_64& random, float centre_x, float centre_y, Halves& out) {
  const int w = 40;
  std::vector<float> wanted(std::size_t(w) * w, kZbvFarDepth);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const float z = static_cast<float>(static_cast<int>(random() % 4096) - 2048) / 4096;
      put_sample(blank.views, 0, i, j, z, 0);
      const mpq_class x = mpq_class(i, 2) + mpq_class(centre_x), y = mpq_class(j, 2) + mpq_class(centre_y), half(1, 2);
      const long column = floor_of(x + half).get_si(), row = floor_of(y + half).get_si();
      out.halves += floor_of(2 * x) * 1 == 2 * x && floor_of(x) != x;
      out.careless += careless_round(x.get_d()) != column;
      if (column < 0 || row < 0 || column >= w || row >= w) continue;
      float& at = wanted[static_cast<std::size_t>((w - 1 - row) * w + column)];
      at = std::min(at, z + 4);
    }
  blank.job.facts.scale = 32;
  blank.job.facts.centre_x = centre_x;
  blank.job.facts.centre_y = centre_y;
  blank.job.frames = {from_above(4)};
  for (const std::uint32_t options : kOptions) {
    blank.job.facts.options = options;
    const auto picture = reconstructed(rig, blank.views, blank.job).pictures.at(0);
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (wanted[k] != picture.depth[k])
        out.pixels.fault(fmt::format("centre ({:.9g}, {:.9g}), options {}: pixel ({}, {}) has depth {:.9g}, not {:.9g}", centre_x,
                                     centre_y, options, k % w, k / w, picture.depth[k], wanted[k]));
  }
}

/// One pixel in which the samples of all views meet; the nearest of those that are chosen, else the lowest number.
struct Ties {
  Faults lowest, nearer;
  std::int64_t with_others = 0, not_first = 0;  ///< pictures in which others meet; in which the nearest is not the first
};

void compare_ties(const stability::Rig& rig, const Blank& blank, std::mt19937_64& random, Ties& out) {
  JobFile job = blank.job;
  // The axis in the middle of a pixel, which the steps of depth do not leave.
  job.facts.width = job.facts.height = 8;
  job.facts.centre_x = job.facts.centre_y = 4;
  for (int k = 0; k < 120; ++k) {
    std::array<double, 3> d;
    for (double& c : d) c = static_cast<double>(random() % 2001) / 1000 - 1;
    job.frames.push_back(facing(d, 4));
  }
  const std::size_t views = blank.views.views.size();
  std::vector<std::vector<std::size_t>> chosen(job.frames.size());
  for (std::size_t v = 0; v < views; ++v) {
    ViewsFile one = blank.views;
    put_sample(one, v, 0, 0, 0, static_cast<std::uint8_t>(v));
    const Pictures drawn = reconstructed(rig, one, job);
    for (std::size_t f = 0; f < chosen.size(); ++f)
      if (drawn.pictures[f].facts.covered > 0) chosen[f].push_back(v);
  }
  ViewsFile all = blank.views, nearer = blank.views;
  for (std::size_t v = 0; v < views; ++v) {
    put_sample(all, v, 0, 0, 0, static_cast<std::uint8_t>(v));
    // Nearer by some steps of single precision, the more the higher the number.
    put_sample(nearer, v, 0, 0, -0x1p-18f * static_cast<float>(1 + 8 * v), static_cast<std::uint8_t>(v));
  }
  const Pictures tied = reconstructed(rig, all, job), apart = reconstructed(rig, nearer, job);
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    const auto shown = [&](const Pictures& p) {
      for (const std::uint8_t c : p.pictures[f].colour)
        if (c != kZbvEmptyColour) return static_cast<std::size_t>(c);
      return views;
    };
    out.with_others += chosen[f].size() > 1;
    if (chosen[f].empty() || shown(tied) != chosen[f].front())
      out.lowest.fault(fmt::format("frame {}: view {} is shown", f, shown(tied)));
    // The depth moves by -z (forward · forward'): the nearest of the chosen, from the exact products.
    std::size_t best = views;
    mpq_class least = 0;
    bool clear = true;
    for (const std::size_t v : chosen[f]) {
      mpq_class product = 0;
      for (std::size_t i = 0; i < 3; ++i)
        product += mpq_class(job.frames[f].frame[6 + i]) * mpq_class(blank.views.views[v].frame[6 + i]);
      const mpq_class moved = product * -mpq_class(0x1p-18 * static_cast<double>(1 + 8 * v));
      if (best != views && abs(moved - least) < mpq_class(0x1p-20)) clear = false;
      if (best == views || moved < least) best = v, least = moved;
    }
    if (!clear) continue;
    out.not_first += best != chosen[f].front();
    if (shown(apart) != best) out.nearer.fault(fmt::format("frame {}: view {} is shown, not {}", f, shown(apart), best));
  }
}

struct Distances {
  Faults drawn, missing;
  std::int64_t behind = 0, ahead = 0;
};

/// Distances around 0 and around `near`, one sample a picture: all are drawn onto the axis, where dividing does not matter.
void compare_distances(const stability::Rig& rig, const Blank& blank, float near, std::uint32_t options, Distances& out) {
  std::vector<float> distances = {-1, -near, -0x1p-20f, 0, 0x1p-20f, near / 2, near, 2 * near, 0.5f};
  for (const float from : {near, 0x1p-20f}) distances.push_back(std::nextafter(from, 0.0f)), distances.push_back(std::nextafter(from, 1.0f));
  JobFile job = blank.job;
  job.facts.projection = kZbvPerspective;
  job.facts.near = near;
  job.facts.options = options;
  job.facts.centre_x = job.facts.centre_y = 19;
  job.frames = {from_above(0.5f)};
  for (const float distance : distances) {
    // Distances as far below 1/2 as single precision goes: the program's sum is then exact.
    const float z = distance - 0.5f;
    const mpq_class exact = mpq_class(z) + mpq_class(0.5f);
    ViewsFile views = blank.views;
    views.facts.radius = views.facts.half_height = 0.25f;
    put_sample(views, 0, 0, 0, z, 0);
    const auto picture = reconstructed(rig, views, job).pictures.at(0);
    const bool ahead = exact > mpq_class(near);
    ++(ahead ? out.ahead : out.behind);
    const std::string where = fmt::format("near {:.9g}, options {}: distance {:.9g}: {} pixels", near, options, exact.get_d(),
                                          picture.facts.covered);
    const bool right = !ahead || picture.depth[(39 - 19) * 40 + 19] == static_cast<float>(exact.get_d());
    if (!ahead && picture.facts.covered != 0) out.drawn.fault(where);
    if (ahead && (picture.facts.covered != 1 || !right)) out.missing.fault(where);
  }
}

}  // namespace

stability::Result view_ties(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Ties ties;
  compare_ties(rig, at_axis(rig), random, ties);
  return {{no_fault("N-B4", "pictures that do not show the lowest number of the views that tie", ties.lowest, "pictures", "integers"),
           no_fault("N-B4", "a few steps apart: pictures that do not show the nearest", ties.nearer, "pictures", "gmp"),
           must_show("N-B4", "pictures in which several views meet", static_cast<double>(ties.with_others), "pictures", "integers"),
           must_show("N-B4", "a few steps apart: pictures whose nearest has not the lowest number", static_cast<double>(ties.not_first),
                     "pictures", "gmp")},
          {}};
}

stability::Result half_pixels(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Blank blank = at_axis(rig);
  Halves halves;
  for (const float x : {9.0f, 8.5f, -0.5f, -3.0f, 8.5f + kStep, 8.5f - kStep, -0.5f - kStep})
    compare_halves(rig, blank, random, x, x + 5, halves);
  return {{no_fault("N-B6", fmt::format("pixels that are not those of floor(x + 1/2), {} columns on a half", halves.halves),
                    halves.pixels, "pixels", "gmp"),
           must_show("N-B6", "columns that rounding halves to even puts elsewhere", static_cast<double>(halves.careless), "samples",
                     "gmp")},
          {}};
}

stability::Result near_eye(const stability::Rig& rig, std::uint64_t) {
  const Blank blank = at_axis(rig);
  Distances distances;
  for (const float near : {0.125f, 0x1p-10f})
    for (const std::uint32_t options : kOptions) compare_distances(rig, blank, near, options, distances);
  return {{no_fault("N-B7", fmt::format("{} samples at the eye, behind it or not beyond `near` that are drawn", distances.behind),
                    distances.drawn, "samples", "gmp"),
           no_fault("N-B7", fmt::format("{} samples beyond `near` that are not drawn at their distance", distances.ahead),
                    distances.missing, "samples", "gmp")},
          {}};
}

}  // namespace dendro::zbuffer_views
