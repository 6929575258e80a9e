#include <fmt/format.h>

#include <cmath>

#include "firmware/half_space/stability/support.h"
#include "sim/scene/view.h"

// N-A1. A plane of slope s on a picture 512 pixels wide: 16.16 overflows where the depth leaves +-32,768.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr int kWidth = 512, kHeight = 128;

/// A back plane `degrees` from edge-on that rises towards `azimuth` on the screen and is at depth 2048 in
/// column `crossing` of the first line; one unit of depth per pixel.
struct SteepPlane {
  double degrees, azimuth, crossing;
};

constexpr SteepPlane kPlanes[] = {
    {2, 20, 256.3},    {1.2, 75, 100.7},   {0.9, 0, 0.5},       {0.89, 0, 500.25},   {0.5, 10, 250.3},
    {0.5, 190, 250.3}, {0.1, 45, 300.123}, {0.05, 275, 200.6},  {0.01, 5, 399.9},    {0.001, 170, 222.2},
    {1e-5, 33, 128.4}, {1e-7, 60, 310.77}, {1e-9, 12, 255.501}, {1e-11, 181, 77.77},
};
constexpr int kIcosahedra = 4;

Prepared steep_scene(const SteepPlane& p, SteepPolicy policy) {
  const double angle = p.degrees * M_PI / 180;
  const double c = std::sin(angle);
  const double a = -std::cos(angle) * scene::cosine_of_degrees(p.azimuth);
  const double b = -std::cos(angle) * scene::sine_of_degrees(p.azimuth);
  return from_screen(
      {{0, 0, 1, -4000}, {a, b, c, -(a * p.crossing + c * 2048)}, {0, 0, -1, 5}, {1.0 / 64, 0, -1, 7}},
      kWidth, kHeight, policy);
}

struct Totals {
  Tally wide_record, wide_plane, wrap, saturate, wrap_model, gentle;
  std::int64_t steep = 0;
};

/// Pass 2 takes 1.0 off every depth, so in the microcode a front plane below -32767 wraps one unit before the
/// model's does.
bool wraps_early(const PlaneProgram& program, int x, int y) {
  for (const PlaneRecord& r : program.front) {
    const std::int64_t value = r.start + r.step_x * (x - program.box.x0) + r.step_y * (y - program.box.y0);
    if (static_cast<std::int32_t>(static_cast<std::uint32_t>(value)) < -32767 * 65536) return true;
  }
  return false;
}

void compare_with_model(const Words& words, const PlaneProgram& program, const std::string& name,
                        Tally& tally) {
  Words wanted = run_fixed_point(program).pixels;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wraps_early(program, static_cast<int>(i) % program.width, static_cast<int>(i) / program.width))
      wanted[i] = words[i];
  compare_words(words, wanted, program.width, name, tally);
}

/// The scene under all policies; wrong pixels of wide, wrap and saturate go to `row`.
void measure(const stability::Rig& rig, const std::string& name,
             const std::function<Prepared(SteepPolicy)>& make, Totals& totals, std::vector<double>& row) {
  const Prepared wide = make(SteepPolicy::kWide), wrap = make(SteepPolicy::kWrap),
                 saturate = make(SteepPolicy::kSaturate);
  const int width = wide.program.width;
  Enclosure enclosure(wide);
  Tally wide_plane, wrapped, saturated;
  const Words words = draw(rig, wide), wrap_words = draw(rig, wrap);
  compare_words(words, exact_record_words(wide.program), width, name, totals.wide_record);
  compare_enclosed(words, enclosure, width, name, wide_plane);
  compare_enclosed(wrap_words, enclosure, width, name, wrapped);
  compare_with_model(wrap_words, wrap.program, name, totals.wrap_model);
  compare_enclosed(run_fixed_point(saturate.program).pixels, enclosure, width, name, saturated);
  row = {static_cast<double>(wide.program.wide_records()), wide_plane.per_million(), wrapped.per_million(),
         saturated.per_million()};
  const auto add = [](Tally& sum, const Tally& one) {
    if (sum.count == 0) sum.first = one.first;
    sum.count += one.count, sum.pixels += one.pixels;
  };
  add(totals.wide_plane, wide_plane);
  const bool steep = wide.program.wide_records() > 0;
  totals.steep += steep;
  add(steep ? totals.wrap : totals.gentle, wrapped);
  add(steep ? totals.saturate : totals.gentle, saturated);
}

std::vector<stability::Row> rows_of(const Totals& t, const std::string& of) {
  const auto count = [](const Tally& tally) { return static_cast<double>(tally.count); };
  return {
      {"N-A1", "wide: words that differ from the records' exact depths, " + of, count(t.wide_record), 0,
       "pixels", "gmp", Bound::kAtMost, t.wide_record.first},
      {"N-A1", "wide: pixels outside what the exact planes allow, " + of, count(t.wide_plane), 0, "pixels",
       "gmp", Bound::kAtMost, t.wide_plane.first},
      {"N-A1", "wrap: must fail, " + of, t.wrap.per_million(), 0, "pixels per 1e6", "gmp", Bound::kMoreThan,
       t.wrap.first},
      {"N-A1", "saturate (integer model): must fail, " + of, t.saturate.per_million(), 0, "pixels per 1e6",
       "gmp", Bound::kMoreThan, t.saturate.first},
      {"N-A1", "wrap: words that differ from the integer model where no front plane is below -32767, " + of,
       count(t.wrap_model), 0, "pixels", "fixed-point model", Bound::kAtMost, t.wrap_model.first},
  };
}

}  // namespace

stability::Result steep_planes(const stability::Rig& rig, std::uint64_t seed) {
  stability::Result result;
  stability::Curve curve{
      "N-A1",
      "wrong pixels of a steep plane",
      {"degrees from edge-on", "wide records", "wide (per 1e6)", "wrap (per 1e6)", "saturate (per 1e6)"},
      {},
      false,
      ""};
  Totals planes;
  for (const SteepPlane& plane : kPlanes) {
    std::vector<double> row;
    measure(
        rig, fmt::format("{} degrees", plane.degrees),
        [&](SteepPolicy policy) { return steep_scene(plane, policy); }, planes, row);
    row.insert(row.begin(), plane.degrees);
    curve.rows.push_back(row);
  }
  result.rows = rows_of(planes, fmt::format("{} planes, {} steep", std::size(kPlanes), planes.steep));
  result.rows.push_back({"N-A1", "planes that 16.16 holds: wrong under wrap or saturate",
                         static_cast<double>(planes.gentle.count), 0, "pixels", "gmp", Bound::kAtMost,
                         planes.gentle.first});

  std::mt19937_64 random(seed);
  Totals solids;
  for (int i = 0; i < kIcosahedra; ++i) {
    const scene::Scene scene = looking_at(random_solid(random, "icosahedron"), kWidth, 2.6);
    std::vector<double> row;
    measure(
        rig, fmt::format("icosahedron {} of seed {}", i + 1, seed),
        [&](SteepPolicy policy) {
          const char* name = policy == SteepPolicy::kWide   ? "wide"
                             : policy == SteepPolicy::kWrap ? "wrap"
                                                            : "saturate";
          // The microcode has no saturating adder; the host's set-up is the same.
          return prepare(with(scene, "steep", {std::string(name), {"stability", 0}}));
        },
        solids, row);
  }
  for (const stability::Row& row : rows_of(solids, fmt::format("{} random icosahedra", kIcosahedra)))
    result.rows.push_back(row);
  result.curves.push_back(curve);
  return result;
}

}  // namespace dendro::half_space
