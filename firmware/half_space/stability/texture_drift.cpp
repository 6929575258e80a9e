#include <fmt/format.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/roughen_program.h"
#include "firmware/half_space/reference/colour_model.h"
#include "firmware/half_space/stability/surface.h"

// N-A8. Each of M's numbers is rounded to the nearest 2^-16, so that i pixels right, j down and z deep the
// coordinate is off by at most i + j + z + 1 halves of that.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr const char* kRoughen = "firmware/half_space/rds3000/roughen.gia";
constexpr unsigned kLoresPixel = 2;  // bus function code
constexpr int kWidth = 160, kHeight = 120;
constexpr int kViews = 4;
constexpr int kThickness = 8;  ///< so little that roughening opens holes

/// A slanted face, which the machine roughens; depths as hulls.gia would merge them.
struct Surface {
  std::vector<int> flat, rough;
};

int slanted(int x, int y) { return 40 + x / 2 + y / 2; }

Surface roughen_a_face(const stability::Rig& rig, std::uint64_t seed) {
  Surface surface;
  std::vector<std::uint32_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      surface.flat.push_back(slanted(x, y));
      pixels.push_back(static_cast<std::uint32_t>(slanted(x, y) | (slanted(x, y) + kThickness) << 8));
    }
  const lib::ProgramImage image = rig.program(kRoughen);
  rig.run(
      [&](HostPort& host) {
        for (std::uint32_t y = 0; y < kHeight; ++y)
          host.dma_to(y << 11, &pixels[y * kWidth], kWidth, kLoresPixel, 2);
        lib::RdsDriver driver(host);
        driver.load_program(image);
        run_roughen(driver, image,
                    make_roughening({0.1, 0.5}, 200, {0, 0, kWidth - 1, kHeight - 1}, kFarthest, seed, 0));
      },
      [&](const MachineView& machine) {
        for (std::uint32_t y = 0; y < kHeight; ++y)
          for (std::uint32_t x = 0; x < kWidth; ++x) {
            const auto front = static_cast<int>(machine.peek(x << 1 | y << 11, kLoresPixel) & 0xFF);
            surface.rough.push_back(front > 0 ? front : kFarthest);
          }
      });
  return surface;
}

/// A turn, half a texel to two texels a pixel, less in depth, its origin inside the picture: both signs
/// occur.
scene::Affine random_map(std::mt19937_64& random) {
  std::uniform_real_distribution<double> degrees(0, 360), size(0.5, 2), depth(0.05, 0.3), part(-3, 3);
  scene::Object object;
  object.rotate = {degrees(random), degrees(random), degrees(random)};
  scene::Affine map;
  map.linear = scene::Placement(object).rotation * size(random);
  map.linear[2] *= depth(random);
  const glm::dvec3 middle(kWidth / 2.0, kHeight / 2.0, 128);
  map.shift = glm::dvec3(part(random), part(random), part(random)) - map.linear * middle;
  return map;
}

mpq_class coordinate(const scene::Affine& map, int axis, int x, int y, int z) {
  return mpq_class(map.shift[axis]) + x * mpq_class(map.linear[0][axis]) +
         y * mpq_class(map.linear[1][axis]) + z * mpq_class(map.linear[2][axis]);
}

/// word - exact in 2^-16, both modulo 2^32.
mpq_class difference(std::uint32_t word, const mpq_class& exact) {
  const mpq_class modulus(mpz_class(1) << 32);
  mpq_class d = mpq_class(word) - exact * 65536;
  const mpq_class turns = d / modulus + mpq_class(1, 2);
  mpz_class whole;
  mpz_fdiv_q(whole.get_mpz_t(), turns.get_num_mpz_t(), turns.get_den_mpz_t());
  d -= whole * modulus;
  return d;
}

struct Drift {
  double largest = 0, bound = 0, share = 0;  ///< in 2^-16
  std::string where;

  void see(const mpq_class& off, int halves, const std::function<std::string()>& place) {
    const double error = std::abs(off.get_d()), allowed = halves / 2.0;
    bound = std::max(bound, allowed);
    largest = std::max(largest, error);
    // A bound of 0 has no share: whatever is off by then is off by more than it.
    const double part = allowed > 0 ? error / allowed : error > 0 ? INFINITY : 0;
    if (part > share) share = part, where = place();
  }
};

std::uint32_t index_of(const mpq_class& value, unsigned bits) {
  mpz_class whole, rest;
  mpz_fdiv_q(whole.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  mpz_fdiv_r_2exp(rest.get_mpz_t(), whole.get_mpz_t(), bits);
  return static_cast<std::uint32_t>(rest.get_ui());
}

struct Totals {
  Drift pixels, table, lines;
  Tally machine;
  std::int64_t undecided = 0;  ///< pixels whose bound reaches over a texel's side
  std::int64_t moved = 0;      ///< that the face's own depth would bring to another texel
  std::int64_t holes = 0;
};

void compare_pixels(const Colouring& c, const scene::Affine& map, const Surface& surface, const Words& words,
                    const std::string& name, Totals& totals) {
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      const int z = surface.rough[at], halves = x + y + z + 1;
      if (z == kFarthest) {
        ++totals.holes;
        continue;
      }
      const Texel got = texel_of(words[at]);
      Texel low{}, high{}, flat{};
      bool possible = true;
      for (unsigned k = 0; k < 3; ++k) {
        const int axis = static_cast<int>(k);
        const mpq_class q = coordinate(map, axis, x, y, z), slack(halves, 131072);
        totals.pixels.see(difference(texel_coordinate(c, k, x, y, z), q), halves, [&] {
          return fmt::format("{}: pixel ({}, {}) at depth {}, axis {}, step {} of line {}", name, x, y, z,
                             axis, x, y);
        });
        low[k] = index_of(q - slack, c.level.bits), high[k] = index_of(q + slack, c.level.bits);
        flat[k] = index_of(coordinate(map, axis, x, y, surface.flat[at]), c.level.bits);
        possible = possible && (got[k] == low[k] || got[k] == high[k]);
      }
      ++totals.machine.pixels;
      totals.undecided += low != high, totals.moved += low == high && flat != low;
      if (!possible)
        totals.machine.fault(
            fmt::format("{}: pixel ({}, {}) at depth {} shows texel {}, possible are {} to {}", name, x, y, z,
                        name_of(got), name_of(low), name_of(high)));
    }
}

/// The machine's own words: the table that it made by repeated addition, and its line below the last one.
void compare_sums(const scene::Affine& map, const IndexPicture& picture, const std::string& name,
                  Totals& totals) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int z = 0; z < kDepths; ++z)
      totals.table.see(difference(picture.depths[static_cast<std::size_t>(3 * z + axis)],
                                  z * mpq_class(map.linear[2][axis])),
                       z, [&] { return fmt::format("{}: depth {}, axis {}", name, z, axis); });
    totals.lines.see(
        difference(picture.line_q[static_cast<std::size_t>(axis)], coordinate(map, axis, 0, kHeight, 0)),
        kHeight + 1, [&] { return fmt::format("{}: line {}, axis {}", name, kHeight, axis); });
  }
}

stability::Row drift_row(const std::string& what, const Drift& drift) {
  return {"N-A8",
          fmt::format("{}; largest {:.2f} of 2^-16, allowed up to {:.1f}", what, drift.largest, drift.bound),
          drift.share,
          1,
          "of the bound",
          "gmp",
          Bound::kAtMost,
          drift.where};
}

}  // namespace

stability::Result texture_drift(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Surface surface = roughen_a_face(rig, seed);
  Totals totals;
  for (int i = 0; i < kViews; ++i) {
    const scene::Affine map = random_map(random);
    ColourSettings settings;
    settings.level = static_cast<unsigned>(i % 2);
    const Colouring c = make_colouring(settings, map, cube_layout(5, false), kWidth, kHeight, 0, seed, 0);
    const IndexPicture picture = draw_indices(rig, c, surface.rough);
    const std::string name = fmt::format("view {} of seed {}", i + 1, seed);
    compare_pixels(c, map, surface, picture.words, name, totals);
    compare_sums(map, picture, name, totals);
  }
  const auto count = [](const std::string& what, double value, Bound bound, const std::string& where) {
    return stability::Row{"N-A8", what, value, 0, "pixels", "gmp", bound, where};
  };
  return {
      {drift_row("coordinates of every pixel, steps x half 2^-16", totals.pixels),
       drift_row("the machine's table of depths", totals.table),
       drift_row("the machine's coordinates below the last line", totals.lines),
       count(fmt::format("texels outside what the bound allows, {} pixels, {} at a texel's side, {} holes",
                         totals.machine.pixels, totals.undecided, totals.holes),
             static_cast<double>(totals.machine.count), Bound::kAtMost, totals.machine.first),
       count("pixels that roughening brings to another texel", static_cast<double>(totals.moved),
             Bound::kMoreThan, "")},
      {}};
}

}  // namespace dendro::half_space
