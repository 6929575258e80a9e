#include "firmware/tools/gia_pack.h"

#include <algorithm>
#include <set>

#include "firmware/tools/gia_check.h"
#include "firmware/tools/gia_schedule.h"
#include "firmware/tools/source_error.h"

namespace dendro::tools {
namespace {

class Packer {
 public:
  Packer(const Program& program, const std::vector<std::uint64_t>& words, int ticks)
      : program_(program), words_(words), ticks_(ticks), wait_(products_under_way(words, ticks, true)) {
    result_.program = program;
    result_.program.micros.clear();
  }

  Packed run() {
    check_targets();
    const std::vector<std::size_t> starts = block_starts();
    std::vector<int> moved(words_.size() + 1, 0);
    for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
      moved[starts[b]] = static_cast<int>(result_.program.micros.size());
      pack_block(starts[b], starts[b + 1]);
    }
    moved[words_.size()] = static_cast<int>(result_.program.micros.size());
    for (Label& label : result_.program.labels) label.at = moved[static_cast<std::size_t>(label.at)];
    if (program_.entry_label < 0) result_.program.entry_address = 0;
    return std::move(result_);
  }

 private:
  void check_targets() const {
    for (const Micro& m : program_.micros) {
      if (!m.numeric_target) continue;
      throw SourceError(program_.file, m.line, m.column,
                        "a branch to a number cannot be packed, because words move: branch to a label");
    }
    if (program_.entry_label < 0 && program_.entry_address != 0) {
      throw SourceError(program_.file, 1, 1, "with packing the entry is a label, because words move");
    }
  }

  bool stands_alone(std::size_t i) const { return program_.micros[i].verbatim; }

  std::vector<std::size_t> block_starts() const {
    std::set<std::size_t> starts{0, words_.size()};
    for (const Label& label : program_.labels) starts.insert(static_cast<std::size_t>(label.at));
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (stands_alone(i)) starts.insert(i);
      if (stands_alone(i) || ends_block(words_[i])) starts.insert(i + 1);
    }
    return {starts.begin(), starts.end()};
  }

  void pack_block(std::size_t first, std::size_t end) {
    // A word that wants the product before the one under way depends on every distance: such a stretch stays
    // as it is.
    const bool fixed = std::any_of(program_.micros.begin() + static_cast<std::ptrdiff_t>(first),
                                   program_.micros.begin() + static_cast<std::ptrdiff_t>(end),
                                   [](const Micro& m) { return m.verbatim || m.old_product; });
    if (fixed) return copy_block(first, end);
    Block block;
    block.words = static_cast<int>(end - first);
    block.product_wait = wait_[first];
    for (std::size_t i = first; i < end; ++i) {
      split(program_.micros[i], words_[i], static_cast<int>(i - first), block.operations);
    }
    for (const PackedWord& w : schedule(block, ticks_)) append(block, w, first);
  }

  void copy_block(std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      result_.program.micros.push_back(program_.micros[i]);
      result_.lines.push_back({program_.micros[i].line});
    }
  }

  void append(const Block& block, const PackedWord& w, std::size_t first) {
    Micro m = program_.micros[first];
    m.word = w.bits;
    m.imm = w.imm;
    std::set<int> lines;
    for (const int j : w.operations) lines.insert(block.operations[static_cast<std::size_t>(j)].line);
    if (!lines.empty()) m.line = *lines.begin();
    result_.program.micros.push_back(m);
    result_.lines.emplace_back(lines.begin(), lines.end());
  }

  const Program& program_;
  const std::vector<std::uint64_t>& words_;
  int ticks_;
  std::vector<int> wait_;
  Packed result_;
};

}  // namespace

Packed pack_program(const Program& program, const std::vector<std::uint64_t>& words, int multiply_ticks) {
  return Packer(program, words, multiply_ticks).run();
}

}  // namespace dendro::tools
