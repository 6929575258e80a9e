#include "firmware/half_space/reference/texture_model.h"

#include <algorithm>

#include "firmware/half_space/host/seeds.h"
#include "sim/base/check.h"

namespace dendro::half_space {
namespace {

/// Multiplicative congruential numbers of 16 bits  ASSUMED DEV-049
class Numbers {
 public:
  explicit Numbers(std::vector<std::uint32_t> seeds) : seeds_(std::move(seeds)) {}

  std::uint32_t draw() {
    const std::size_t at = count_ % kDrawsPerSeed;
    if (at == 0) DENDRO_CHECK(count_ / kDrawsPerSeed < seeds_.size(), "{} draws", count_);
    state_ = at == 0 ? seeds_[count_ / kDrawsPerSeed] : state_ * 25173 & 0xFFFF;
    ++count_;
    return state_;
  }

  std::int64_t draw_signed() { return static_cast<std::int16_t>(draw()); }

 private:
  std::vector<std::uint32_t> seeds_;
  std::size_t count_ = 0;
  std::uint32_t state_ = 0;
};

using Point = std::array<int, 3>;

/// Texels of one level; coordinates are taken modulo its side.
class Texels {
 public:
  Texels(int side, std::vector<std::uint8_t>& bytes) : side_(side), bytes_(bytes) {
    bytes_.resize(static_cast<std::size_t>(4) * side * side * side);
  }

  int side() const { return side_; }

  std::uint8_t& byte(const Point& p, int c) {
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis)
      index = index * side_ + static_cast<std::size_t>((p[axis] % side_ + side_) % side_);
    return bytes_[index * 4 + c];
  }

  void set(const Point& p, const Rgb& rgb, int value) {
    for (int c = 0; c < 3; ++c) byte(p, c) = rgb[c];
    byte(p, 3) = static_cast<std::uint8_t>(value);
  }

 private:
  int side_;
  std::vector<std::uint8_t>& bytes_;
};

void place_chunks(Texels& texels, const TextureSettings& settings, Numbers& numbers) {
  const int side = texels.side(), edge = settings.chunk_edge;
  const auto origins = chunk_origins(settings);
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) texels.set({x, y, z}, settings.base, 0);
  for (int chunk = 0; chunk < settings.chunks; ++chunk) {
    const auto& origin = origins[static_cast<std::size_t>(chunk) * 4 / kDrawsPerSeed];
    Point at;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<int>((numbers.draw() * side >> 16) + origin[axis]);
    const std::uint32_t draw = numbers.draw();
    const ChunkColour& colour =
        *std::find_if(settings.chunk_colours.begin(), settings.chunk_colours.end(),
                      [&](const ChunkColour& candidate) { return draw < candidate.below; });
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) texels.set({at[0] + x, at[1] + y, at[2] + z}, colour.rgb, 0);
  }
}

class Brownian {
 public:
  Brownian(Texels& texels, const TextureSettings& settings, Numbers& numbers)
      : texels_(texels), settings_(settings), numbers_(numbers) {}

  void run() {
    texels_.set({0, 0, 0}, settings_.colours[128], 128);
    half_ = texels_.side();
    for (const Amplitudes& of : amplitudes(settings_.bits, settings_.hurst)) {
      half_ /= 2;
      cells(0, [&](const Point& p) { body(p, of.body); });
      for (int turn = 0; turn < 3; ++turn) cells(turn, [&](const Point& p) { face(p, turn, of.face); });
      for (int turn = 0; turn < 3; ++turn) cells(turn, [&](const Point& p) { edge(p, turn, of.edge); });
    }
  }

 private:
  template <typename F>
  void cells(int turn, F&& make) {
    const int u = turn, v = (turn + 1) % 3, w = (turn + 2) % 3;
    Point p{};
    for (p[w] = 0; p[w] < texels_.side(); p[w] += 2 * half_)
      for (p[v] = 0; p[v] < texels_.side(); p[v] += 2 * half_)
        for (p[u] = 0; p[u] < texels_.side(); p[u] += 2 * half_) make(p);
  }

  int value(Point p, int axis = 0, int by = 0) {
    p[axis] += by;
    return texels_.byte(p, 3);
  }

  void body(Point p, std::uint32_t amplitude) {
    for (int& coordinate : p) coordinate += half_;
    int sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      Point q = p;
      for (int axis = 0; axis < 3; ++axis) q[axis] += corner >> axis & 1 ? half_ : -half_;
      sum += value(q);
    }
    settle(p, sum, amplitude);
  }

  void face(Point p, int turn, std::uint32_t amplitude) {
    const int u = turn, v = (turn + 1) % 3, w = (turn + 2) % 3;
    p[u] += half_, p[v] += half_;
    int sum = 2 * (value(p, w, half_) + value(p, w, -half_));
    for (const int along_u : {-half_, half_})
      for (const int along_v : {-half_, half_}) {
        Point q = p;
        q[u] += along_u;
        sum += value(q, v, along_v);
      }
    settle(p, sum, amplitude);
  }

  void edge(Point p, int turn, std::uint32_t amplitude) {
    const int u = turn, v = (turn + 1) % 3, w = (turn + 2) % 3;
    p[w] += half_;
    int sum = 0;
    for (const int by : {-half_, half_}) sum += 2 * value(p, w, by) + value(p, u, by) + value(p, v, by);
    settle(p, sum, amplitude);
  }

  void settle(const Point& p, int sum, std::uint32_t amplitude) {
    const auto displacement = static_cast<int>(numbers_.draw_signed() * amplitude >> 16);
    const int result = std::clamp((sum + displacement + 4) >> 3, 0, 255);
    texels_.set(p, settings_.colours[result], result);
  }

  Texels& texels_;
  const TextureSettings& settings_;
  Numbers& numbers_;
  int half_ = 0;
};

void make_coarser(Texels& fine, Texels& coarse) {
  for (int z = 0; z < coarse.side(); ++z)
    for (int y = 0; y < coarse.side(); ++y)
      for (int x = 0; x < coarse.side(); ++x)
        for (int c = 0; c < 4; ++c) {
          int sum = 0;
          for (int corner = 0; corner < 8; ++corner)
            sum += fine.byte({2 * x + (corner & 1), 2 * y + (corner >> 1 & 1), 2 * z + (corner >> 2)}, c);
          coarse.byte({x, y, z}, c) = static_cast<std::uint8_t>(sum / 8);
        }
}

}  // namespace

CubeBytes make_texture(const TextureSettings& settings) {
  DENDRO_CHECK(settings.kind != TextureKind::kNone, "no texture");
  Numbers numbers(texture_seeds(settings));
  CubeBytes cube(settings.bits + 1);
  std::vector<Texels> levels;
  for (unsigned k = 0; k <= settings.bits; ++k) levels.emplace_back(1 << (settings.bits - k), cube[k]);
  if (settings.kind == TextureKind::kChunks)
    place_chunks(levels[0], settings, numbers);
  else
    Brownian(levels[0], settings, numbers).run();
  for (unsigned k = 1; k <= settings.bits; ++k) make_coarser(levels[k - 1], levels[k]);
  return cube;
}

}  // namespace dendro::half_space
