#include "firmware/tools/gia_schedule.h"

#include <algorithm>
#include <random>

#include "sim/base/check.h"

namespace dendro::tools {
namespace {

using namespace bps32;

// A guess of how long accesses take, only to rank orders that are all correct.
constexpr int kReadGuess = 5;
constexpr int kWriteGuess = 3;
constexpr long kWordRank = 1 << 16;  // of two orders of the same ticks the one with fewer words wins
constexpr int kManyTries = 200;
constexpr int kFewTries = 24;
constexpr std::size_t kLongBlock = 64;

struct Edge {
  int from;
  int words;
  bool join;
};

class Scheduler {
 public:
  Scheduler(const Block& block, int multiply_ticks)
      : block_(block), ticks_(multiply_ticks), n_(block.operations.size()) {
    find_edges();
    find_heights();
  }

  std::vector<PackedWord> run() {
    std::vector<PackedWord> best = as_written();
    long best_cost = cost(best);
    const int tries = n_ > kLongBlock ? kFewTries : kManyTries;
    std::mt19937 random(1);
    for (int t = 0; t < tries; ++t) {
      std::vector<PackedWord> words = attempt(t, random);
      const long c = cost(words);
      if (c < best_cost) {
        best = std::move(words);
        best_cost = c;
      }
    }
    return best;
  }

 private:
  const Operation& op(int i) const { return block_.operations[static_cast<std::size_t>(i)]; }

  void find_edges() {
    edges_.resize(n_);
    earliest_.assign(n_, 0);
    const int shortest = std::min(block_.words, block_.product_wait);
    length_ = shortest;
    for (int j = 0; j < static_cast<int>(n_); ++j) {
      auto& e = edges_[static_cast<std::size_t>(j)];
      for (int i = 0; i < j; ++i) {
        int d = distance(op(i), op(j), ticks_);
        // A product that a later block reads must be no longer under way there than it was before packing.
        if (op(j).last && op(i).starts) d = std::max(d, tail(op(i)) - 1);
        if (d >= 0) e.push_back({i, d, can_join(op(i), op(j), ticks_)});
      }
      if (op(j).product || op(j).starts) earliest_[static_cast<std::size_t>(j)] = block_.product_wait;
      if (op(j).last) earliest_[static_cast<std::size_t>(j)] = std::max(shortest - 1, 0);
    }
  }

  int tail(const Operation& start) const { return std::min(block_.words - start.order, ticks_); }

  void find_heights() {
    height_.assign(n_, 0);
    for (int j = static_cast<int>(n_) - 1; j >= 0; --j) {
      for (const Edge& e : edges_[static_cast<std::size_t>(j)]) {
        int words = e.words;
        if (op(e.from).bus_read && op(j).data) words = kReadGuess;
        if (op(e.from).bus_write && (op(j).bus_read || op(j).bus_write)) words = kWriteGuess;
        int& h = height_[static_cast<std::size_t>(e.from)];
        h = std::max(h, height_[static_cast<std::size_t>(j)] + words);
      }
    }
  }

  bool compatible(const PackedWord& w, const Operation& o, bool join) const {
    std::uint64_t mask = o.mask;
    if (join) {
      if (get(w.bits, kYdst) != kYNone) return false;
      mask &= ~alu_mask();
    }
    const std::uint64_t imm = put(0, kImm, ~0u);
    if (w.mask & mask & ~imm) return false;
    const bool share = w.mask & mask & imm;
    return !share || (w.imm == o.imm && get(w.bits, kImm) == get(o.bits, kImm));
  }

  void place(PackedWord& w, int j, bool join) const {
    const Operation& o = op(j);
    if (join) {
      w.bits = put(w.bits, kYdst, get(o.bits, kYdst));
      const std::uint64_t rest = o.mask & ~alu_mask();
      w.bits = (w.bits & ~rest) | (o.bits & rest);
    } else {
      w.bits = (w.bits & ~o.mask) | o.bits;
    }
    if (o.mask & put(0, kImm, ~0u)) w.imm = o.imm;
    w.mask |= o.mask;
    w.operations.push_back(j);
  }

  /// Whether `j` can stand in word `t`; `join`: only on the Y bus of an operation there.
  bool ready(int j, int t, const std::vector<int>& at, bool& join) const {
    join = false;
    if (t < earliest_[static_cast<std::size_t>(j)]) return false;
    for (const Edge& e : edges_[static_cast<std::size_t>(j)]) {
      const int p = at[static_cast<std::size_t>(e.from)];
      if (p < 0) return false;
      if (p + e.words <= t) continue;
      if (p != t || !e.join) return false;
      join = true;
    }
    return true;
  }

  /// The source's own words, which every correct schedule has to beat.
  std::vector<PackedWord> as_written() const {
    std::vector<PackedWord> words(static_cast<std::size_t>(block_.words));
    for (int j = 0; j < static_cast<int>(n_); ++j) {
      PackedWord& w = words[static_cast<std::size_t>(op(j).order)];
      DENDRO_CHECK(compatible(w, op(j), false), "line {}", op(j).line);
      place(w, j, false);
    }
    return words;
  }

  std::vector<PackedWord> attempt(int number, std::mt19937& random) const {
    std::vector<int> score(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      score[i] = 8 * height_[i] + (number == 0 ? 0 : static_cast<int>(random() % (number % 2 ? 8u : 40u)));
    }
    const bool defer = number % 3 != 2;
    std::vector<int> at(n_, -1);
    std::vector<PackedWord> words;
    std::size_t left = n_;
    int data_at = 0;
    for (int t = 0; left > 0; ++t) {
      words.emplace_back();
      for (;;) {
        bool join = false;
        const int j = choose(t, at, words.back(), score, defer ? data_at : 0, join);
        if (j < 0) break;
        place(words.back(), j, join);
        at[static_cast<std::size_t>(j)] = t;
        if (op(j).bus_read) data_at = t + kReadGuess;
        --left;
      }
    }
    int length = std::max(length_, static_cast<int>(words.size()));
    for (std::size_t j = 0; j < n_; ++j) {
      if (block_.operations[j].starts) length = std::max(length, at[j] + tail(block_.operations[j]));
    }
    words.resize(static_cast<std::size_t>(length));
    return words;
  }

  int choose(int t, const std::vector<int>& at, const PackedWord& w, const std::vector<int>& score,
             int data_at, bool& join) const {
    int best = -1;
    int best_score = 0;
    for (int j = 0; j < static_cast<int>(n_); ++j) {
      bool as_join = false;
      if (at[static_cast<std::size_t>(j)] >= 0 || !ready(j, t, at, as_join)) continue;
      if (!compatible(w, op(j), as_join)) continue;
      int s = score[static_cast<std::size_t>(j)];
      if (op(j).data && t < data_at) s -= 1 << 20;
      if (as_join) s += 1 << 10;
      if (best < 0 || s > best_score) {
        best = j;
        best_score = s;
        join = as_join;
      }
    }
    return best;
  }

  /// Ticks with guessed access times, doubled, plus what is left of the last access; then words.
  long cost(const std::vector<PackedWord>& words) const {
    int t = 0;
    int bus_free = kWriteGuess;
    int data_at = kWriteGuess;
    for (const PackedWord& w : words) {
      int start = t;
      for (const int j : w.operations) {
        if (op(j).bus_read || op(j).bus_write) start = std::max(start, bus_free);
        if (op(j).data) start = std::max(start, data_at);
      }
      for (const int j : w.operations) {
        if (op(j).bus_read) bus_free = data_at = start + kReadGuess;
        if (op(j).bus_write) bus_free = start + kWriteGuess;
      }
      t = start + 1;
    }
    return (2L * t + std::max(0, bus_free - t)) * kWordRank + static_cast<long>(words.size());
  }

  const Block& block_;
  int ticks_;
  std::size_t n_;
  int length_ = 0;
  std::vector<std::vector<Edge>> edges_;
  std::vector<int> earliest_, height_;
};

}  // namespace

std::vector<PackedWord> schedule(const Block& block, int multiply_ticks) {
  return Scheduler(block, multiply_ticks).run();
}

}  // namespace dendro::tools
