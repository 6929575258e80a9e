#include <fmt/format.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "firmware/lib/big_real.h"
#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/support.h"

// N-B5: the bytes of normals of small triangles, one colour each, in views from everywhere.

namespace dendro::zbuffer_views {
namespace {

using stability::BigReal;
using Corners = std::array<Vertex, 3>;

/// The normal of a triangle, and its places on the scales of the two bytes.
struct Exact {
  std::array<BigReal, 3> normal;
  BigReal latitude = 0, longitude = 0;  ///< in bytes before rounding
  bool pole = false;
};

mpq_class component(const Corners& c, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const auto side = [&](std::size_t corner, std::size_t axis) { return mpq_class(mpq_class(c[corner][axis]) - mpq_class(c[0][axis])); };
  return side(1, j) * side(2, k) - side(1, k) * side(2, j);
}

Exact exact_of(const Corners& c) {
  Exact e;
  BigReal length = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const mpq_class v = component(c, i);
    // Sums of two products of singles: a double and what it leaves hold them to 100 bits.
    const double high = v.get_d();
    e.normal[i] = BigReal(high) + BigReal(mpq_class(v - mpq_class(high)).get_d());
    length = length + e.normal[i] * e.normal[i];
  }
  length = sqrt(length);
  for (BigReal& n : e.normal) n = n / length;
  const BigReal level = sqrt(e.normal[0] * e.normal[0] + e.normal[2] * e.normal[2]), pi = BigReal::pi();
  e.pole = !(BigReal(0) < level);
  e.latitude = (atan2(e.normal[1], level) / pi + BigReal(0.5)) * BigReal(255);
  if (!e.pole) e.longitude = atan2(e.normal[0], e.normal[2]) / pi * BigReal(128);
  return e;
}

/// Whether `byte` is `value` rounded, modulo 256; on a tie, as near as double precision cannot tell, either of both.
bool rounds_to(const BigReal& value, int byte) {
  const int nearest = static_cast<int>(floor(value + BigReal(0.5)).to_double());
  if ((nearest & 255) == byte) return true;
  const BigReal rest = value - floor(value);
  if (!(abs(rest - BigReal(0.5)) < BigReal(0x1p-42))) return false;
  return ((nearest - 1) & 255) == byte;
}

/// Degrees between a normal and what its bytes stand for.
double angle(const Exact& e, int latitude, int longitude) {
  const BigReal lat = BigReal::pi() * (BigReal(latitude) / BigReal(255) - BigReal(0.5)), lon = BigReal::pi() * BigReal(longitude) / BigReal(128);
  const BigReal d[3] = {cos(lat) * sin(lon), sin(lat), cos(lat) * cos(lon)};
  BigReal chord = 0;
  for (std::size_t i = 0; i < 3; ++i) chord = chord + (d[i] - e.normal[i]) * (d[i] - e.normal[i]);
  return (BigReal(360) / BigReal::pi() * asin(sqrt(chord) / BigReal(2))).to_double();
}

Corners around(const std::array<double, 3>& n, const std::array<double, 3>& at, double size) {
  const std::array<double, 3> other = std::abs(n[1]) < 0.5 ? std::array<double, 3>{0, 1, 0} : std::array<double, 3>{1, 0, 0};
  const std::array<double, 3> u = {n[1] * other[2] - n[2] * other[1], n[2] * other[0] - n[0] * other[2], n[0] * other[1] - n[1] * other[0]};
  const std::array<double, 3> v = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
  Corners c;
  for (std::size_t i = 0; i < 3; ++i) {
    c[0][i] = static_cast<float>(at[i] - size * (u[i] + v[i]));
    c[1][i] = static_cast<float>(at[i] + size * (u[i] - v[i]));
    c[2][i] = static_cast<float>(at[i] + size * v[i]);
  }
  return c;
}

/// Poles, the axes, the wrap of longitudes, the equator between two latitudes, and anywhere.
std::vector<Corners> triangles_of(std::mt19937_64& random) {
  std::vector<std::array<double, 3>> normals = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const double tiny : {0x1p-12, -0x1p-12, 0x1p-6, -0x1p-6})
    for (const double side : {1.0, -1.0}) {
      normals.push_back({tiny, side, 0}), normals.push_back({0, side, tiny});
      normals.push_back({tiny, 0, side}), normals.push_back({side, tiny, 0});
    }
  // The worst place: half a step of both bytes away, at the equator.
  for (int k = 0; k < 16; ++k) {
    const double p = (2 * (k * 16 + 3) + 1) * M_PI / 256;
    normals.push_back({std::sin(p), 0, std::cos(p)});
  }
  // All but half a step of latitude from the poles, where the byte says a pole.
  for (int k = 0; k < 8; ++k) {
    const double tilt = 0.999 * M_PI / 510, p = (2 * k + 1) * M_PI / 8;
    normals.push_back({std::sin(tilt) * std::sin(p), (k % 2 == 0 ? 1 : -1) * std::cos(tilt), std::sin(tilt) * std::cos(p)});
  }
  while (normals.size() < 240) {
    std::array<double, 3> n;
    for (double& c : n) c = static_cast<double>(random() % 20001) / 10000 - 1;
    const double size = std::hypot(n[0], n[1], n[2]);
    if (size < 0.1) continue;
    for (double& c : n) c /= size;
    normals.push_back(n);
  }
  std::vector<Corners> triangles;
  for (std::size_t k = 0; k < normals.size(); ++k) {
    // On a helix, so that every one is seen from some side.
    const double turn = 2.4 * static_cast<double>(k), y = static_cast<double>(k) / 120 - 1;
    triangles.push_back(around(normals[k], {std::sin(turn), y, std::cos(turn)}, 0.0625));
  }
  return triangles;
}

struct Seen {
  Faults bytes, sides;
  double worst = 0, worst_pole = 0;
  std::string where;
  std::int64_t samples = 0;
  std::vector<bool> found;
};

void look_at(const ViewsFile& views, const std::vector<Exact>& exact, Seen& seen) {
  for (std::size_t v = 0; v < views.layers.size(); ++v)
    for (const auto& layer : views.layers[v])
      for (std::size_t at = 0; at < layer.colour.size(); ++at) {
        const std::size_t k = layer.colour[at];
        if (k == kZbvEmptyColour) continue;
        const int latitude = layer.latitude[at], longitude = layer.longitude[at];
        const std::string where = fmt::format("view {}, sample ({}, {}): triangle {} has bytes {}, {}", v, at % views.facts.width,
                                              at / views.facts.width, k, latitude, longitude);
        ++seen.samples;
        seen.found[k] = true;
        const Exact& e = exact[k];
        if (!rounds_to(e.latitude, latitude) || (!e.pole && !rounds_to(e.longitude, longitude))) seen.bytes.fault(where);
        const double error = angle(e, latitude, longitude);
        if (error > seen.worst) seen.worst = error, seen.where = where;
        if (latitude == 0 || latitude == 255) seen.worst_pole = std::max(seen.worst_pole, error);
      }
}

}  // namespace

stability::Result normal_bytes(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<Corners> triangles = triangles_of(random);
  TreeFile tree;
  tree.colours.clear();
  std::vector<Exact> exact;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const auto colour = static_cast<std::uint32_t>(k);
    tree.colours.push_back({kZbvBranch, 0xFFFFFF, colour, 0});
    tree.add(triangles[k][0], triangles[k][1], triangles[k][2], colour);
    exact.push_back(exact_of(triangles[k]));
  }
  JobFile job(tree);
  job.facts.layers = 3;
  job.facts.view_width = job.facts.view_height = 128;
  Seen seen;
  seen.found.resize(exact.size());
  look_at(precomputed(rig, tree, job), exact, seen);
  Faults lost;
  for (std::size_t k = 0; k < seen.found.size(); ++k)
    if (!seen.found[k]) lost.fault(fmt::format("triangle {}", k));
  // Half a step of latitude and half a step of longitude, at the equator.
  const BigReal pi = BigReal::pi();
  const double bound = (BigReal(180) / pi * acos(cos(pi / BigReal(510)) * cos(pi / BigReal(256)))).to_double();
  return {{no_fault("N-B5", fmt::format("{} samples: bytes that are not the exact normal's", seen.samples), seen.bytes, "samples", "gmp, mpfr"),
           {"N-B5", "largest angle between a normal and its bytes", seen.worst, bound * (1 + 1e-9), "degrees", "gmp, mpfr", Bound::kAtMost,
            seen.where},
           {"N-B5", "the same where the byte says a pole", seen.worst_pole, 180.0 / 510 * (1 + 1e-9), "degrees", "gmp, mpfr", Bound::kAtMost, seen.where},
           no_fault("N-B5", "triangles that no view has", lost, "triangles", "machine")},
          {}};
}

}  // namespace dendro::zbuffer_views
