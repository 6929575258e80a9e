#include <fmt/format.h>
#include <gmpxx.h>

#include "firmware/half_space/stability/surface.h"

// N-A7. Coordinates on both sides of 0. What a pixel shows is the texel that the microcode took; the oracle
// is the floor of the rational coordinate, and its floor modulo the cube's side.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr int kWidth = 128, kHeight = 96;
constexpr double kQuarter = 0.25;
constexpr double kTiny = 1.0 / 65536;

/// Texels at pixel (0, 0) and depth 0; steps to the right, down, and into depth.
struct View {
  const char* name;
  unsigned bits, level;
  double start[3], right[3], down[3], deeper[3];
};

constexpr View kViews[] = {
    {"whole texels", 5, 0, {-50, -70, -90}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {"quarter texels", 5, 0, {-10, -12, -20}, {kQuarter, 0, 0}, {0, kQuarter, 0}, {0, 0, kQuarter}},
    {"backwards", 4, 0, {40, 30, 70}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
    {"least steps", 5, 1, {-64 * kTiny, -40 * kTiny, -kTiny}, {kTiny, 0, 0}, {0, kTiny, 0}, {0, 0, 0}},
    {"turned", 5, 0, {3.7, -31.2, -15.9}, {-0.31, 0.72, -0.11}, {0.53, 0.12, -0.87}, {-0.02, 0.06, 0.09}},
    {"turned, coarse",
     4,
     2,
     {-1.7, 2.2, -5.9},
     {0.031, -0.072, 0.11},
     {-0.053, 0.012, 0.087},
     {0.012, -0.016, 0.01}},
};

Colouring::Vector words_of(const double (&values)[3]) {
  return {to_texel_word(values[0]), to_texel_word(values[1]), to_texel_word(values[2])};
}

Colouring colouring_of(const View& view) {
  Colouring colouring;
  colouring.width = kWidth, colouring.height = kHeight;
  colouring.start = words_of(view.start), colouring.step_x = words_of(view.right);
  colouring.step_y = words_of(view.down), colouring.step_z = words_of(view.deeper);
  colouring.level = cube_layout(view.bits, false).levels.at(view.level);
  return colouring;
}

/// All crown depths; constant along a line for views whose runs are counted.
int depth_at(int x, int y, bool flat) { return flat ? 1 + y % 254 : 1 + (7 * x + 13 * y) % 254; }

mpq_class exact(std::uint32_t word) {
  mpq_class value(static_cast<std::int32_t>(word), 65536);
  value.canonicalize();
  return value;
}

std::uint32_t floor_modulo(const mpq_class& value, unsigned bits, bool truncate) {
  mpz_class whole, rest;
  if (truncate)
    mpz_tdiv_q(whole.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  else
    mpz_fdiv_q(whole.get_mpz_t(), value.get_num_mpz_t(), value.get_den_mpz_t());
  mpz_fdiv_r_2exp(rest.get_mpz_t(), whole.get_mpz_t(), bits);
  return static_cast<std::uint32_t>(rest.get_ui());
}

struct Totals {
  Tally index, seam;
  std::int64_t negative = 0;   ///< pixels with a negative coordinate
  std::int64_t truncated = 0;  ///< that rounding towards 0 would bring to another texel
};

void compare(const View& view, const Words& words, bool flat, Totals& totals) {
  const Colouring c = colouring_of(view);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int z = depth_at(x, y, flat);
      Texel wanted{}, rounded{};
      bool below = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const mpq_class q =
            exact(c.start[k]) + x * exact(c.step_x[k]) + y * exact(c.step_y[k]) + z * exact(c.step_z[k]);
        below = below || q < 0;
        wanted[k] = floor_modulo(q, c.level.bits, false);
        rounded[k] = floor_modulo(q, c.level.bits, true);
      }
      totals.negative += below, totals.truncated += wanted != rounded;
      ++totals.index.pixels;
      const Texel got = texel_of(words[static_cast<std::size_t>(y * kWidth + x)]);
      if (got != wanted)
        totals.index.fault(fmt::format("{}: pixel ({}, {}) at depth {} shows texel {}, not {}", view.name, x,
                                       y, z, name_of(got), name_of(wanted)));
    }
}

/// Along a line the texel changes after every `run` pixels, by one, also where the coordinate changes sign.
void count_seams(const View& view, const Words& words, int run, Totals& totals) {
  const std::uint32_t side = 1u << (view.bits - view.level);
  const std::uint32_t step = view.right[0] > 0 ? 1 : side - 1;
  for (int y = 0; y < kHeight; ++y)
    for (int x = run; x < kWidth; ++x) {
      const std::size_t at = static_cast<std::size_t>(y * kWidth + x);
      const std::uint32_t here = texel_of(words[at])[0], before = texel_of(words[at - run])[0];
      ++totals.seam.pixels;
      if (here != (before + step) % side || texel_of(words[at])[1] != texel_of(words[at - run])[1])
        totals.seam.fault(fmt::format("{}: pixel ({}, {}) shows {}, the one {} to its left {}", view.name, x,
                                      y, name_of(texel_of(words[at])), run,
                                      name_of(texel_of(words[at - run]))));
    }
}

}  // namespace

stability::Result texture_index(const stability::Rig& rig, std::uint64_t) {
  Totals totals;
  for (const View& view : kViews) {
    const int run = view.right[0] == kQuarter ? 4 : std::abs(view.right[0]) == 1 ? 1 : 0;
    std::vector<int> nearest;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) nearest.push_back(depth_at(x, y, run > 0));
    const IndexPicture picture = draw_indices(rig, colouring_of(view), nearest);
    compare(view, picture.words, run > 0, totals);
    if (run > 0) count_seams(view, picture.words, run, totals);
  }
  return {
      {{"N-A7",
        fmt::format("texels that differ from the floor modulo, {} pixels, {} with a negative coordinate",
                    totals.index.pixels, totals.negative),
        static_cast<double>(totals.index.count), 0, "pixels", "gmp", Bound::kAtMost, totals.index.first},
       {"N-A7",
        fmt::format("pixels that break the even steps of a line through 0, {} pixels", totals.seam.pixels),
        static_cast<double>(totals.seam.count), 0, "pixels", "machine", Bound::kAtMost, totals.seam.first},
       {"N-A7", "pixels that rounding towards 0 would bring to another texel",
        static_cast<double>(totals.truncated), 0, "pixels", "gmp", Bound::kMoreThan, ""}},
      {}};
}

}  // namespace dendro::half_space
