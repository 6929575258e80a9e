#include "firmware/tools/disassembler.h"

#include <fmt/format.h>

#include <map>

#include "firmware/tools/assembler.h"
#include "firmware/tools/gia_statement.h"
#include "models/parts/bps32/bps32_disasm.h"
#include "sim/base/error.h"

namespace dendro::tools {
namespace {

/// What a line of literal text encodes to, or nothing when it is not the language's.
class Encoder {
 public:
  explicit Encoder(const Ucode& ucode) : ucode_(ucode) {
    names_.assign(bps32::kPageWords, "");
    for (const auto& [name, at] : ucode.symbols) {
      if (at < names_.size() && names_[at].empty()) names_[at] = name;
    }
  }

  const std::string& name(unsigned address) const { return names_[address]; }

  bool encodes(const std::string& text, std::uint64_t word) const {
    try {
      Program program;
      program.file = "disassembly";
      const std::vector<Token> tokens = tokenize(text + ";", program.file);
      const Symbols symbols(tokens, program, 8192);
      TokenCursor cursor(tokens, program.file);
      std::vector<std::string> labels;
      const LabelLookup lookup = [&](const Token& t) {
        labels.push_back(t.text);
        return static_cast<int>(labels.size()) - 1;
      };
      const Micro m = parse_statement(cursor, symbols, program, lookup);
      std::uint64_t encoded = m.word;
      if (m.imm.kind == Fixup::kLabel) {
        const auto at = ucode_.symbols.find(labels[static_cast<std::size_t>(m.imm.index)]);
        if (at == ucode_.symbols.end()) return false;
        encoded = bps32::put(encoded, bps32::kImm, at->second);
      }
      return m.imm.kind != Fixup::kPool && encoded == word;
    } catch (const UserError&) {
      return false;
    }
  }

 private:
  const Ucode& ucode_;
  std::vector<std::string> names_;
};

std::string declarations(const Ucode& u) {
  std::string text = fmt::format("literal {}, {};\n", u.pack, u.multiply_ticks);
  for (const auto& [name, s] : u.scratch)
    text += fmt::format("scratch {}[{}] @ 0x{:04x};\n", name, s.size, s.address);
  for (const auto& [at, value] : u.scratch_data)
    text += fmt::format("data 0x{:04x} = {{0x{:08x}}};\n", at, value);
  std::string entry;
  for (const auto& [name, at] : u.symbols) {
    if (at == u.entry && entry.empty()) entry = name;
  }
  return text + "entry " + (entry.empty() ? fmt::format("0x{:03x}", u.entry) : entry) + ";\n\n";
}

}  // namespace

std::string disassemble(const Ucode& u) {
  const Encoder encoder(u);
  const bps32::AddressName name = [&](unsigned at) { return encoder.name(at); };
  std::multimap<std::uint32_t, std::string> labels;
  for (const auto& [label, at] : u.symbols) labels.emplace(at, label);
  std::string text = declarations(u);
  for (std::uint32_t at = 0; at <= u.words.size(); ++at) {
    const auto [first, last] = labels.equal_range(at);
    for (auto it = first; it != last; ++it) text += it->second + ":\n";
    if (at == u.words.size()) break;
    std::string line = bps32::disassemble_word(u.words[at], name);
    if (!encoder.encodes(line, u.words[at])) line = fmt::format("word 0x{:016x}", u.words[at]);
    text += fmt::format("  {};  // {:03x}\n", line, at);
  }
  return text;
}

}  // namespace dendro::tools
