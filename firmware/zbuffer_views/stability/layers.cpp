#include <fmt/format.h>
#include <gmpxx.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "firmware/zbuffer_views/stability/cases.h"
#include "firmware/zbuffer_views/stability/support.h"

// N-B3: five fragments at one sample in every order of their triangles, each order at a sample of its own, seen from above.

namespace dendro::zbuffer_views {
namespace {

constexpr int kSide = 32, kFragments = 5;
constexpr float kPitch = 1.0f / 64, kThreshold = 0.125f;

using Heights = std::array<float, kFragments>;
/// One order of them: position in the array of triangles -> which fragment.
using Order = std::array<int, kFragments>;

struct Kept {
  float z = kZbvEmptyDepth;
  std::uint8_t colour = kZbvEmptyColour;
  bool operator==(const Kept& o) const { return z == o.z && colour == o.colour; }
};
using Stack = std::vector<Kept>;

/// Greedy from the front over the fragments in order of depth, and of their triangles where depths are equal.
Stack greedy(const Heights& z, const Order& order, std::size_t layers, float threshold) {
  Order sorted = order;
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return z[std::size_t(a)] < z[std::size_t(b)]; });
  Stack kept;
  for (const int f : sorted) {
    if (kept.size() == layers) break;
    if (kept.empty() || mpq_class(z[std::size_t(f)]) - mpq_class(kept.back().z) >= mpq_class(threshold))
      kept.push_back({z[std::size_t(f)], static_cast<std::uint8_t>(f)});
  }
  kept.resize(layers);
  return kept;
}

/// V4's rule *insert* in rationals.
Stack inserted(const Heights& z, const Order& order, std::size_t layers, float threshold) {
  Stack kept(layers);
  for (const int f : order)
    for (std::size_t k = 0; k < layers; ++k) {
      const Kept now = {z[std::size_t(f)], static_cast<std::uint8_t>(f)};
      if (abs(mpq_class(now.z) - mpq_class(kept[k].z)) < mpq_class(threshold)) {
        if (now.z < kept[k].z) kept[k] = now;
        break;
      }
      if (now.z < kept[k].z) {
        kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(k), now);
        kept.pop_back();
        break;
      }
    }
  return kept;
}

struct Cell {
  Heights z;
  Order order;
};

/// Every order of `sets` sets of heights: multiples of a quarter of the threshold, so that equality and ties happen.
std::vector<Cell> cells_of(std::mt19937_64& random, int sets) {
  std::vector<Cell> cells;
  for (int s = 0; s < sets; ++s) {
    Heights z;
    for (float& h : z) h = static_cast<float>(static_cast<int>(random() % 17) - 8) * kThreshold / 4;
    Order order;
    std::iota(order.begin(), order.end(), 0);
    do cells.push_back({z, order});
    while (std::next_permutation(order.begin(), order.end()));
  }
  return cells;
}

/// A triangle around one sample of the first view, which looks down: x is the world's, y is -z, depth is -y.
void add_fragment(TreeFile& tree, int i, int j, float z, std::uint32_t colour) {
  const auto place = [](double at) { return static_cast<float>((at - 0.5 * (kSide - 1)) * kPitch); };
  tree.add({place(i - 0.5), -z, -place(j - 0.25)}, {place(i + 0.5), -z, -place(j - 0.25)}, {place(i), -z, -place(j + 0.5)},
           colour);
}

struct Found {
  Faults peel, insert, order;
  std::int64_t dependent = 0, samples = 0;
};

void compare_layers(const stability::Rig& rig, const std::vector<Cell>& cells, std::uint32_t layers, float threshold,
                    Found& found) {
  TreeFile tree;
  tree.colours.clear();
  for (std::uint32_t f = 0; f < kFragments; ++f) tree.colours.push_back({kZbvBranch, f, f, 0});
  for (std::size_t n = 0; n < cells.size(); ++n)
    for (const int f : cells[n].order)
      add_fragment(tree, static_cast<int>(n) % kSide, static_cast<int>(n) / kSide, cells[n].z[std::size_t(f)],
                   static_cast<std::uint32_t>(f));
  for (const std::uint32_t rule : {kZbvPeel, kZbvInsert}) {
    JobFile job(tree);
    job.facts.bands = 2;
    job.facts.layers = layers;
    job.facts.view_width = job.facts.view_height = kSide;
    job.facts.pitch = kPitch;
    job.facts.threshold = threshold;
    job.facts.rule = rule;
    const ViewsFile views = precomputed(rig, tree, job);
    for (std::size_t n = 0; n < cells.size(); ++n) {
      Stack got;
      for (const auto& layer : views.layers[0]) got.push_back({layer.z[n], layer.colour[n]});
      const std::string where = fmt::format("{} layers, threshold {}: sample ({}, {})", layers, threshold, n % kSide, n / kSide);
      const Stack canonical = greedy(cells[n].z, cells[n].order, layers, threshold);
      ++found.samples;
      if (rule == kZbvPeel) {
        if (!(got == canonical)) found.peel.fault(where);
        const Stack first = greedy(cells[n].z, cells[n / 120 * 120].order, layers, threshold);
        for (std::size_t k = 0; k < got.size(); ++k)
          if (got[k].z != first[k].z) {
            found.order.fault(where);
            break;
          }
      } else {
        if (!(got == inserted(cells[n].z, cells[n].order, layers, threshold))) found.insert.fault(where);
        found.dependent += !(got == canonical);
      }
    }
  }
}

}  // namespace

stability::Result layer_threshold(const stability::Rig& rig, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Found found;
  for (const std::uint32_t layers : {1u, 2u, 3u, 4u})
    for (const float threshold : {kThreshold, 0.0f}) compare_layers(rig, cells_of(random, 8), layers, threshold, found);
  return {{no_fault("N-B3", "peel: samples that are not greedy from the front, all orders of 5 fragments", found.peel, "samples", "gmp"),
           no_fault("N-B3", "peel: samples whose depths change with the order", found.order, "samples", "gmp"),
           no_fault("N-B3", "insert: samples that are not V4's rule in the order of the triangles", found.insert, "samples", "gmp"),
           must_show("N-B3", "insert: samples that are not greedy from the front (MO95-K3)", static_cast<double>(found.dependent),
                     "samples", "gmp")},
          {}};
}

}  // namespace dendro::zbuffer_views
