#include "sim/study/stability_tree.h"

#include "models/parts/igc/clocked_tree.h"

namespace dendro::study {
namespace {

unsigned levels_of(int side) {
  unsigned levels = 0;
  while (1 << levels < side) ++levels;
  return levels;
}

/// What the leaves show in a clock.
struct Shown {
  std::size_t stream = 0;
  unsigned bit = 0;
  bool wanted = false, first = false;
};

std::vector<Shown> schedule(const std::vector<stability::TreeStream>& streams, unsigned gap) {
  std::vector<Shown> clocks;
  for (std::size_t s = 0; s < streams.size(); ++s)
    for (unsigned n = 0; n < gap + streams[s].bits; ++n) clocks.push_back({s, n - gap, n >= gap, n == 0});
  return clocks;
}

}  // namespace

std::vector<std::vector<std::int64_t>> drive_tree(int width, int height, const stability::TreeDrive& drive,
                                                  const std::vector<stability::TreeStream>& streams,
                                                  const std::vector<stability::TreePixel>& pixels) {
  const unsigned levels_x = levels_of(width), levels_y = levels_of(height), latency = levels_x + levels_y;
  const auto skew = [](unsigned right, int late) { return static_cast<unsigned>(static_cast<int>(right) + late); };
  igc::TreeFeed feed(skew(levels_x - 1, drive.a_late), skew(latency - 1, drive.b_late), drive.gap);
  igc::ClockedTree tree(levels_x, levels_y, drive.masked);
  std::vector<std::size_t> leaves;
  for (const stability::TreePixel& p : pixels)
    leaves.push_back(igc::leaf_of(levels_x, static_cast<unsigned>(p.x), static_cast<unsigned>(p.y)));

  std::vector<std::vector<std::int64_t>> values(streams.size(), std::vector<std::int64_t>(pixels.size()));
  const std::vector<Shown> clocks = schedule(streams, drive.gap);
  for (std::size_t n = 0; n < clocks.size() + latency; ++n) {
    if (n >= latency && clocks[n - latency].wanted) {
      const Shown& now = clocks[n - latency];
      // The last bit is the sign: all bits from it up.
      const bool sign = now.bit + 1 == streams[now.stream].bits;
      const std::uint64_t weight = (sign ? ~std::uint64_t{0} : std::uint64_t{1}) << now.bit;
      for (std::size_t p = 0; p < pixels.size(); ++p)
        if (tree.leaves()[leaves[p] / 64] >> leaves[p] % 64 & 1)
          values[now.stream][p] |= static_cast<std::int64_t>(weight);
    }
    if (n < clocks.size() && clocks[n].first) {
      const stability::TreeStream& s = streams[clocks[n].stream];
      feed.start(s.a, s.b, s.c);
    }
    tree.clock(feed.clock());
  }
  return values;
}

}  // namespace dendro::study
