#include "models/machines/pixel_planes/flag_regions.h"

#include <algorithm>

namespace dendro::pixel_planes {
namespace {

/// floor(p / q), q > 0.
std::int64_t floor_div(std::int64_t p, std::int64_t q) { return p >= 0 ? p / q : -((-p + q - 1) / q); }

/// Bits low to high of a word, both within it or beyond.
std::uint64_t mask(std::int64_t low, std::int64_t high) {
  if (high < 0 || low > 63 || low > high) return 0;
  const std::uint64_t from = ~std::uint64_t{0} << std::max<std::int64_t>(low, 0);
  return from & (~std::uint64_t{0} >> (63 - std::min<std::int64_t>(high, 63)));
}

}  // namespace

FlagRegions::FlagRegions(const Spec& spec) : width_(spec.array.width), height_(spec.array.height) {}

FlagRegions::Region& FlagRegions::region(unsigned bit) {
  const auto found = std::find_if(regions_.begin(), regions_.end(), [bit](const Region& r) { return r.bit == bit; });
  if (found != regions_.end()) return *found;
  regions_.emplace_back();
  regions_.back().bit = bit;
  return regions_.back();
}

bool FlagRegions::fits(const Macro& sign) const {
  const std::int64_t ax = sign.a * (width_ - 1), by = sign.b * (height_ - 1);
  const std::int64_t low = sign.c + std::min<std::int64_t>(ax, 0) + std::min<std::int64_t>(by, 0);
  const std::int64_t high = sign.c + std::max<std::int64_t>(ax, 0) + std::max<std::int64_t>(by, 0);
  const std::int64_t most = (std::int64_t{1} << (sign.stream_bits - 1)) - 1;
  return low >= -most - 1 && high <= most;
}

bool FlagRegions::apply(const Macro& sign) {
  const unsigned bit = sign.fields[1].low;
  if (!fits(sign)) return false;
  Region& r = region(bit);
  const bool first = sign.kind == MacroKind::kSignFirst;
  if (!first && !r.known && !r.fresh) return false;
  if (r.edges.empty()) ++pending_;
  if (first) r.edges.clear();
  r.fresh = r.fresh || first;
  r.edges.push_back({sign.a, sign.b, sign.c});
  return true;
}

/// Pixels of a word that lie inside all edges.
std::uint64_t FlagRegions::inside(const std::vector<Edge>& edges, std::uint32_t word) const {
  const int per_row = width_ / 64;
  const std::int64_t x0 = static_cast<std::int64_t>(word) % per_row * 64, y = static_cast<std::int64_t>(word) / per_row;
  std::int64_t low = 0, high = 63;
  for (const Edge& e : edges) {
    const std::int64_t rest = e.a * x0 + e.b * y + e.c;
    if (e.a == 0 && rest < 0) return 0;
    if (e.a > 0) low = std::max(low, -floor_div(rest, e.a));
    if (e.a < 0) high = std::min(high, floor_div(rest, -e.a));
  }
  return mask(low, high);
}

/// Rows y0 to y1 - 1 of a flag that is 0 there.
void FlagRegions::fill(const std::vector<Edge>& edges, int y0, int y1, Region& r, Plane& plane) const {
  std::vector<Edge> open;  // those that some pixel of these rows may lie outside of
  for (const Edge& e : edges) {
    const std::int64_t at0 = e.b * y0 + e.c, at1 = e.b * (y1 - 1) + e.c, ax = e.a * (width_ - 1);
    if (std::max(at0, at1) + std::max<std::int64_t>(ax, 0) < 0) return;
    if (std::min(at0, at1) + std::min<std::int64_t>(ax, 0) < 0) open.push_back(e);
  }
  if (y1 - y0 > 1 && !open.empty()) {
    const int middle = (y0 + y1) / 2;
    fill(open, y0, middle, r, plane);
    fill(open, middle, y1, r, plane);
    return;
  }
  for (int y = y0; y < y1; ++y) {
    std::int64_t low = 0, high = width_ - 1;
    for (const Edge& e : open) {
      const std::int64_t rest = e.b * y + e.c;
      if (e.a > 0) low = std::max(low, -floor_div(rest, e.a));
      if (e.a < 0) high = std::min(high, floor_div(rest, -e.a));
    }
    if (low > high) continue;
    const auto row = static_cast<std::uint32_t>(y * (width_ / 64));
    for (std::int64_t g = low / 64; g <= high / 64; ++g) {
      const std::uint32_t word = row + static_cast<std::uint32_t>(g);
      plane[word] = mask(low - g * 64, high - g * 64);
      r.words.push_back(word);
    }
  }
}

void FlagRegions::settle(Region& r, Plane& plane) {
  if (r.edges.empty()) return;
  --pending_;
  if (r.fresh) {
    if (r.known)
      for (const std::uint32_t word : r.words) plane[word] = 0;
    else
      std::fill(plane.begin(), plane.end(), 0);
    r.words.clear();
    fill(r.edges, 0, height_, r, plane);
  } else {
    std::size_t kept = 0;
    for (const std::uint32_t word : r.words)
      if ((plane[word] &= inside(r.edges, word)) != 0) r.words[kept++] = word;
    r.words.resize(kept);
  }
  r.edges.clear();
  r.known = true, r.fresh = false;
}

const std::vector<std::uint32_t>* FlagRegions::live(unsigned bit, ArrayState& memory) {
  Region& r = region(bit);
  if (bit < memory.memory.size()) settle(r, memory.memory[bit]);
  return r.known ? &r.words : nullptr;
}

void FlagRegions::settle(ArrayState& memory) {
  if (pending_ == 0) return;
  for (Region& r : regions_) settle(r, memory.memory[r.bit]);
}

void FlagRegions::forget(unsigned bit) {
  for (Region& r : regions_)
    if (r.bit == bit) r.known = false;
}

void FlagRegions::forget_all(ArrayState& memory) {
  settle(memory);
  regions_.clear();
}

}  // namespace dendro::pixel_planes
