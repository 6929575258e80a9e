#include "firmware/tools/assembler.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/tools/gia_check.h"
#include "firmware/tools/gia_pack.h"
#include "firmware/tools/gia_parser.h"
#include "firmware/tools/source_error.h"
#include "models/parts/bps32/bps32_isa.h"

namespace dendro::tools {
namespace {

using namespace bps32;

constexpr std::uint32_t kImmScratch = 4096;  // what the imm field reaches

void check_options(const AssembleOptions& o) {
  if (o.pack != "none" && o.pack != "full") throw UserError("pack is none or full, not '" + o.pack + "'");
  if (o.multiply_ticks < 1 || o.multiply_ticks > 64) throw UserError("multiply_ticks is 1 to 64");
  if (o.scratch_words < 1 || o.scratch_words > 8192) throw UserError("scratch_words is 1 to 8192");
  if (o.control_words < 1 || o.control_words > kPageWords) throw UserError("control_words is 1 to 4096");
}

/// Puts the constant pool into free scratch words and returns the address of each constant.
std::vector<std::uint32_t> place_pool(Program& program, unsigned scratch_words) {
  std::vector<bool> used(std::min<std::size_t>(scratch_words, kImmScratch), false);
  const auto mark = [&](std::uint32_t at) {
    if (at < used.size()) used[at] = true;
  };
  for (const auto& [name, s] : program.scratch) {
    for (std::uint32_t i = 0; i < s.size; ++i) mark(s.address + i);
  }
  for (const auto& [at, value] : program.scratch_data) mark(at);
  std::vector<std::uint32_t> addresses;
  std::uint32_t at = 0;
  for (const std::uint32_t value : program.pool) {
    while (at < used.size() && used[at]) ++at;
    if (at == used.size()) {
      throw UserError(program.file, 0, "",
                      fmt::format("scratchpad overflow: no word below {} is left for the constant 0x{:x}",
                                  used.size(), value));
    }
    addresses.push_back(at);
    program.scratch_data[at++] = value;
  }
  return addresses;
}

std::vector<std::uint64_t> resolve(const Program& program, const std::vector<std::uint32_t>& pool) {
  std::vector<std::uint64_t> words;
  words.reserve(program.micros.size());
  for (const Micro& m : program.micros) {
    std::uint64_t w = m.word;
    if (m.imm.kind == Fixup::kLabel) {
      const int at = program.labels[static_cast<std::size_t>(m.imm.index)].at + m.imm.offset;
      if (at < 0 || at > 4095) {
        throw SourceError(program.file, m.line, m.column,
                          fmt::format("address {} does not exist: 0 to 4095", at));
      }
      w = put(w, kImm, static_cast<unsigned>(at));
    } else if (m.imm.kind == Fixup::kPool) {
      w = put(w, kImm, pool[static_cast<std::size_t>(m.imm.index)]);
    }
    words.push_back(w);
  }
  return words;
}

void check_size(const Program& program, unsigned control_words) {
  if (program.micros.size() <= control_words) return;
  const Micro& m = program.micros[control_words];
  throw SourceError(program.file, m.line, m.column,
                    fmt::format("control store overflow: this is word {} of {} and {} fit", control_words + 1,
                                program.micros.size(), control_words));
}

std::uint32_t entry_of(const Program& program) {
  if (program.entry_label < 0) return program.entry_address;
  return static_cast<std::uint32_t>(program.labels[static_cast<std::size_t>(program.entry_label)].at);
}

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else if (c != '\r') {
      lines.back() += c;
    }
  }
  return lines;
}

/// The first word that has to wait for a multiplication under way, and how many words; 0: none.
std::pair<std::size_t, int> first_too_early(const Program& program, const std::vector<std::uint64_t>& words,
                                            int multiply_ticks) {
  const std::vector<int> under_way = products_under_way(words, multiply_ticks, true);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool early =
        starts_multiply(words[i]) || (reads_product(words[i]) && !program.micros[i].old_product);
    if (under_way[i] > 0 && early) return {i, under_way[i]};
  }
  return {0, 0};
}

/// Labels of the word that waits stay before the waiting, because every way to it may come too early.
void insert_waiting(Program& program, std::size_t at, int count) {
  const auto moves = [&](const Micro& m) { return m.numeric_target || m.verbatim; };
  if (std::any_of(program.micros.begin(), program.micros.end(), moves))
    throw SourceError(program.file, program.micros[at].line, program.micros[at].column,
                      "the product comes too late here, and words cannot be inserted into a program with "
                      "branches to numbers or literal words");
  Micro nothing;
  nothing.line = program.micros[at].line;
  nothing.column = program.micros[at].column;
  program.micros.insert(program.micros.begin() + static_cast<std::ptrdiff_t>(at),
                        static_cast<std::size_t>(count), nothing);
  for (Label& label : program.labels)
    if (label.at > static_cast<int>(at)) label.at += count;
  if (program.entry_label < 0 && program.entry_address > at)
    program.entry_address += static_cast<std::uint32_t>(count);
}

void fill_products(Program& program, const std::vector<std::uint32_t>& pool, const AssembleOptions& options) {
  for (;;) {
    const auto [at, count] = first_too_early(program, resolve(program, pool), options.multiply_ticks);
    if (count == 0) return;
    insert_waiting(program, at, count);
    check_size(program, kPageWords);
  }
}

void check_entry(const Program& program) {
  if (entry_of(program) < program.micros.size()) return;
  throw UserError(program.file, 0, "",
                  fmt::format("the entry {} lies behind the last word", entry_of(program)));
}

Assembly assemble_expanded(const std::string& source, const std::string& file_name,
                           const AssembleOptions& options) {
  Program program = parse_program(source, file_name, options.scratch_words);
  check_entry(program);
  const std::vector<std::uint32_t> pool = place_pool(program, options.scratch_words);
  Assembly a;
  a.file = file_name;
  a.source = split_lines(source);
  const bool full = options.pack == "full" && !program.literal;
  // A program that packing would make fit has to fit a page unpacked, because its branches are followed there
  // first.
  check_size(program, full ? kPageWords : options.control_words);
  if (options.fill_products && !program.literal) fill_products(program, pool, options);
  check_size(program, full ? kPageWords : options.control_words);
  a.ucode.words = resolve(program, pool);
  if (!program.literal) check_program(program, a.ucode.words, entry_of(program), options.multiply_ticks);
  if (full) {
    Packed packed = pack_program(program, a.ucode.words, options.multiply_ticks);
    program = std::move(packed.program);
    a.lines = std::move(packed.lines);
    check_size(program, options.control_words);
    a.ucode.words = resolve(program, pool);
  } else {
    for (const Micro& m : program.micros) a.lines.push_back({m.line});
  }
  a.ucode.isa_version = kIsaVersion;
  a.ucode.pack = program.literal ? program.literal_pack : options.pack;
  a.ucode.multiply_ticks = program.literal ? program.literal_multiply_ticks : options.multiply_ticks;
  a.ucode.entry = entry_of(program);
  for (const Label& label : program.labels) {
    if (!label.name.empty()) a.ucode.symbols[label.name] = static_cast<std::uint32_t>(label.at);
  }
  a.ucode.scratch = program.scratch;
  a.ucode.scratch_data = program.scratch_data;
  return a;
}

}  // namespace

Assembly assemble(std::string_view source, const std::string& file_name, const AssembleOptions& options) {
  check_options(options);
  const ExpandedSource expanded = expand_includes(source, file_name, options.include);
  try {
    return assemble_expanded(expanded.text, file_name, options);
  } catch (const SourceError& error) {
    const auto [file, line] = expanded.origin(error.line());
    throw SourceError(file, line, error.column(), error.message());
  }
}

}  // namespace dendro::tools
