#include "firmware/tools/gia_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

using namespace bps32;

constexpr int kStackEntries = 5;  // [2910DS]

class Checker {
 public:
  Checker(const Program& program, const std::vector<std::uint64_t>& words, std::uint32_t entry, int ticks)
      : program_(program), words_(words), entry_(entry), ticks_(ticks) {}

  void run() {
    check_end();
    check_products();
    check_latches();
    check_stack();
  }

 private:
  [[noreturn]] void fail(std::size_t word, const std::string& message) const {
    const Micro& m = program_.micros[word];
    throw SourceError(program_.file, m.line, m.column, message);
  }

  void check_end() const {
    const std::size_t last = words_.size() - 1;
    if (!never_falls_through(words_[last]) && !get(words_[last], kHalt)) {
      fail(last, "the program runs off its end here: the last word must halt, jump or return");
    }
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const int target = successors(words_[i]).target;
      if (target >= static_cast<int>(words_.size())) fail(i, "this branch leads behind the last word");
    }
  }

  void check_products() const {
    const std::vector<int> under_way = products_under_way(words_, ticks_, false);
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (under_way[i] == 0) continue;
      const char* plural = under_way[i] == 1 ? "" : "s";
      if (starts_multiply(words_[i])) {
        fail(i,
             fmt::format("a multiplication is started while one is under way for {} more word{}: it takes {}",
                         under_way[i], plural, ticks_));
      }
      if (reads_product(words_[i]) && !program_.micros[i].old_product) {
        fail(i, fmt::format("the product is taken {} word{} too early: it is there {} words after the start "
                            "(old(product) means the one before)",
                            under_way[i], plural, ticks_));
      }
    }
  }

  void check_latches() const {
    std::set<int> seen;
    std::vector<int> work{static_cast<int>(entry_)};
    while (!work.empty()) {
      const int at = work.back();
      work.pop_back();
      if (at < 0 || at >= static_cast<int>(words_.size()) || !seen.insert(at).second) continue;
      const std::uint64_t w = words_[static_cast<std::size_t>(at)];
      const unsigned cond = get(w, kCond);
      if (uses_condition(w) && tests_flags(cond) &&
          !program_.micros[static_cast<std::size_t>(at)].old_condition) {
        fail(static_cast<std::size_t>(at),
             fmt::format(
                 "'{0}' is read before it is latched: no word from the entry to here latches the flags "
                 "(old({0}) if the flags at the start are meant)",
                 kCondNames[cond]));
      }
      if (latches_flags(w)) continue;
      const Successors next = successors(w);
      if (next.target >= 0) work.push_back(next.target);
      if (next.falls) work.push_back(at + 1);
    }
  }

  struct State {
    int at, depth;
    std::vector<int> calls;
  };

  void push(std::vector<State>& work, int at, int depth, const State& from, int call) const {
    State s{at, std::max(depth, 0), from.calls};
    if (call >= 0) s.calls.push_back(program_.micros[static_cast<std::size_t>(call)].line);
    work.push_back(std::move(s));
  }

  [[noreturn]] void too_deep(const State& s) const {
    std::string path;
    for (const int line : s.calls) path += fmt::format("{}, ", line);
    fail(static_cast<std::size_t>(s.at),
         fmt::format("the stack holds {} entries and this is number {}: pushes and calls in lines {}{}",
                     kStackEntries, kStackEntries + 1, path,
                     program_.micros[static_cast<std::size_t>(s.at)].line));
  }

  /// One step of the walk: the states that word `s.at` leads to.
  void step(const State& s, std::vector<State>& work) const {
    const std::uint64_t w = words_[static_cast<std::size_t>(s.at)];
    const unsigned seq = get(w, kSeq);
    const Successors next = successors(w);
    const bool pushes = seq == am2910::kPUSH || next.calls;
    if (pushes && s.depth == kStackEntries) too_deep(s);
    if (seq == am2910::kPUSH) return push(work, s.at + 1, s.depth + 1, s, s.at);
    if (seq == am2910::kJZ) return push(work, 0, 0, s, -1);
    const bool pops = seq == am2910::kRFCT || seq == am2910::kLOOP || seq == am2910::kTWB;
    const int below = pops ? s.depth - 1 : s.depth;
    if (next.target >= 0) {
      const int depth = next.calls ? s.depth + 1 : seq == am2910::kCJPP ? s.depth - 1 : below;
      push(work, next.target, depth, s, next.calls ? s.at : -1);
    }
    if (next.falls || next.calls) push(work, s.at + 1, below, s, -1);
  }

  void walk(int root, std::set<std::pair<int, int>>& seen) const {
    std::vector<State> work{{root, 0, {}}};
    while (!work.empty()) {
      const State s = std::move(work.back());
      work.pop_back();
      if (s.at < 0 || s.at >= static_cast<int>(words_.size()) || !seen.insert({s.at, s.depth}).second)
        continue;
      step(s, work);
    }
  }

  void check_stack() const {
    std::set<std::pair<int, int>> seen;
    walk(static_cast<int>(entry_), seen);
    // A host can start at any label, so code that the entry does not reach counts as started with an empty
    // stack.
    for (const Label& label : program_.labels) {
      const bool reached =
          std::any_of(seen.begin(), seen.end(), [&](const auto& s) { return s.first == label.at; });
      if (!reached) walk(label.at, seen);
    }
  }

  const Program& program_;
  const std::vector<std::uint64_t>& words_;
  std::uint32_t entry_;
  int ticks_;
};

/// Goes forward until nothing changes.
class ProductFlow {
 public:
  ProductFlow(const std::vector<std::uint64_t>& words, int ticks, bool through_returns)
      : words_(words), ticks_(ticks), result_(words.size(), 0) {
    if (through_returns) collect_places();
  }

  std::vector<int> run() {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (starts_multiply(words_[i])) leave(i);
    }
    while (!work_.empty()) {
      const std::size_t at = work_.back();
      work_.pop_back();
      if (result_[at] > 0) leave(at);
    }
    return std::move(result_);
  }

 private:
  void collect_places() {
    std::set<int> places{0};
    for (std::size_t i = 0; i < words_.size(); ++i) {
      const Successors s = successors(words_[i]);
      if (s.target >= 0) places.insert(s.target);
      if (s.calls || get(words_[i], kSeq) == am2910::kPUSH) places.insert(static_cast<int>(i) + 1);
    }
    unknown_.assign(places.begin(), places.end());
  }

  void leave(std::size_t i) {
    const int out = starts_multiply(words_[i]) ? ticks_ - 1 : std::max(result_[i] - 1, 0);
    if (out == 0) return;
    const Successors s = successors(words_[i]);
    if (s.target >= 0) enter(s.target, out);
    if (s.falls) enter(static_cast<int>(i) + 1, out);
    if (s.unknown) {
      for (const int place : unknown_) enter(place, out);
    }
  }

  void enter(int at, int value) {
    if (at >= static_cast<int>(result_.size())) return;
    int& r = result_[static_cast<std::size_t>(at)];
    if (value <= r) return;
    r = value;
    work_.push_back(static_cast<std::size_t>(at));
  }

  const std::vector<std::uint64_t>& words_;
  int ticks_;
  std::vector<int> result_;
  std::vector<int> unknown_;
  std::vector<std::size_t> work_;
};

}  // namespace

Successors successors(std::uint64_t word) {
  Successors s;
  const unsigned seq = get(word, kSeq);
  const bool from_y = get(word, kYdst) == kYSeq;
  const bool always = get(word, kCond) == kAlways;
  const bool passes = !(always && get(word, kPol));
  const bool fails = !(always && !get(word, kPol));
  const auto jump = [&] {
    if (from_y) {
      s.unknown = true;
    } else {
      s.target = static_cast<int>(get(word, kImm));
    }
  };
  switch (seq) {
    case am2910::kJZ:
      s.target = 0;
      break;
    case am2910::kCJS:
      if (passes) jump();
      s.calls = passes;
      s.falls = fails;
      break;
    case am2910::kJMAP:
      jump();
      break;
    case am2910::kCJP:
    case am2910::kCJV:
    case am2910::kCJPP:
      if (passes) jump();
      s.falls = fails;
      break;
    case am2910::kJSRP:
      if (passes) jump();
      s.unknown |= fails;
      s.calls = true;
      break;
    case am2910::kJRP:
      if (passes) jump();
      s.unknown |= fails;
      break;
    case am2910::kRFCT:
      s.falls = s.unknown = true;
      break;
    case am2910::kRPCT:
      jump();
      s.falls = true;
      break;
    case am2910::kCRTN:
      s.unknown = passes;
      s.falls = fails;
      break;
    case am2910::kLOOP:
      s.falls = passes;
      s.unknown = fails;
      break;
    case am2910::kTWB:
      jump();
      s.falls = passes;
      s.unknown = true;
      break;
    default:
      s.falls = true;
      break;
  }
  return s;
}

std::vector<int> products_under_way(const std::vector<std::uint64_t>& words, int multiply_ticks,
                                    bool through_returns) {
  return ProductFlow(words, multiply_ticks, through_returns).run();
}

void check_program(const Program& program, const std::vector<std::uint64_t>& words, std::uint32_t entry,
                   int multiply_ticks) {
  Checker(program, words, entry, multiply_ticks).run();
}

}  // namespace dendro::tools
