#include <fmt/format.h>

#include <set>

#include "firmware/tools/assembler.h"
#include "firmware/tools/gia_check.h"
#include "firmware/tools/gia_program.h"

namespace dendro::tools {
namespace {

/// Addresses at which a straight-line stretch starts: labels, branch targets, words behind a branch.
std::set<std::size_t> stretch_starts(const Ucode& u) {
  std::set<std::size_t> starts{0};
  for (const auto& [name, at] : u.symbols) starts.insert(at);
  for (std::size_t i = 0; i < u.words.size(); ++i) {
    const Successors next = successors(u.words[i]);
    if (next.target >= 0) starts.insert(static_cast<std::size_t>(next.target));
    if (ends_block(u.words[i])) starts.insert(i + 1);
  }
  return starts;
}

std::string source_text(const Assembly& a, int line) {
  const auto index = static_cast<std::size_t>(line - 1);
  if (line < 1 || index >= a.source.size()) return "";
  const std::string& text = a.source[index];
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first);
}

void append_word(const Assembly& a, std::size_t at, std::string& text) {
  text += fmt::format("{:03x}  {:016x}", at, a.ucode.words[at]);
  bool first = true;
  for (const int line : a.lines[at]) {
    text += fmt::format("{}{:5}  {}\n", first ? "  " : std::string(23, ' '), line, source_text(a, line));
    first = false;
  }
  if (first) text += "\n";
}

}  // namespace

std::string listing(const Assembly& a) {
  const Ucode& u = a.ucode;
  std::string text =
      fmt::format("// {}: {} words, pack {}, entry {:03x}\n", a.file, u.words.size(), u.pack, u.entry);
  const std::set<std::size_t> starts = stretch_starts(u);
  std::size_t start = 0;
  for (std::size_t at = 0; at < u.words.size(); ++at) {
    for (const auto& [name, address] : u.symbols) {
      if (address == at) text += name + ":\n";
    }
    append_word(a, at, text);
    if (!starts.count(at + 1) && at + 1 < u.words.size()) continue;
    const std::size_t ticks = at + 1 - start;
    text += fmt::format("     -- {:03x} to {:03x}: {} tick{}\n", start, at, ticks, ticks == 1 ? "" : "s");
    start = at + 1;
  }
  for (const auto& [name, s] : u.scratch) {
    text += fmt::format("scratch {:04x}  {} [{}]\n", s.address, name, s.size);
  }
  for (const auto& [address, value] : u.scratch_data)
    text += fmt::format("data    {:04x}  {:08x}\n", address, value);
  return text;
}

}  // namespace dendro::tools
