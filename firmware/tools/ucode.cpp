#include "firmware/tools/ucode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::tools {
namespace {

constexpr int kFormat = 1;
constexpr std::uint32_t kScratchLimit = 8192;  // what the 13 bits of the scratch address register reach
constexpr std::string_view kReserved[] = {"const",       "reg",
                                          "scratch",     "entry",
                                          "data",        "literal",
                                          "if",          "else",
                                          "while",       "do",
                                          "for",         "loop",
                                          "forever",     "break",
                                          "continue",    "goto",
                                          "call",        "return",
                                          "read",        "write",
                                          "mul",         "halt",
                                          "nop",         "flags",
                                          "word",        "old",
                                          "q",           "none",
                                          "bus",         "product",
                                          "product_hi",  "product_lo",
                                          "counter",     "status",
                                          "bus_address", "sar",
                                          "spad",        "seq",
                                          "bus_x",       "bus_y",
                                          "bus_data",    "mul_x",
                                          "mul_x_hi",    "mul_y",
                                          "ror8",        "ror16",
                                          "ror24",       "carry",
                                          "borrow",      "spread",
                                          "sizeof",      "umul_step",
                                          "smul_step",   "smul_last",
                                          "increment",   "sign_magnitude",
                                          "normalize",   "double_normalize",
                                          "div_step",    "div_correct",
                                          "keep"};

std::string hex(std::uint64_t value) { return fmt::format("0x{:x}", value); }

/// A file that went through an editor or a mail may end its lines with CR LF; the checksum is over LF.
std::string with_plain_line_ends(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] != '\r' || i + 1 == text.size() || text[i + 1] != '\n') plain += text[i];
  return plain;
}

/// Reads one line after the other, with errors that name it.
class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  [[noreturn]] void fail(const std::string& message) const {
    std::string shown;
    for (const char c : message) {
      const auto byte = static_cast<unsigned char>(c);
      shown += byte < 0x20 || byte == 0x7F ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
    }
    throw UserError(file_, line_, "", shown);
  }
  std::size_t position() const { return at_; }

  /// The fields of the next line, split at single spaces.
  std::vector<std::string> next(const char* wanted) {
    ++line_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail(fmt::format("the file is truncated: {} expected here", wanted));
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ' ') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    return fields;
  }

  /// The single value of a header line `name value`.
  std::string value(const char* name) {
    const auto fields = next(name);
    if (fields.size() != 2 || fields[0] != name) fail(fmt::format("'{} VALUE' expected here", name));
    return fields[1];
  }

  std::uint64_t number(const std::string& text, std::uint64_t limit, const char* what) const {
    const bool is_hex = text.size() > 2 && text.compare(0, 2, "0x") == 0;
    std::uint64_t value = 0;
    const std::size_t first = is_hex ? 2 : 0;
    if (text.size() == first || text.size() > first + 16)
      fail(fmt::format("{} '{}' is not a number", what, text));
    for (std::size_t i = first; i < text.size(); ++i) {
      const char c = text[i];
      const bool decimal = c >= '0' && c <= '9';
      if (!decimal && !(is_hex && c >= 'a' && c <= 'f'))
        fail(fmt::format("{} '{}' is not a number", what, text));
      value = value * (is_hex ? 16 : 10) + static_cast<unsigned>(decimal ? c - '0' : c - 'a' + 10);
    }
    if (value > limit) fail(fmt::format("{} {} is above {}", what, text, limit));
    return value;
  }

 private:
  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 0;
};

void read_header(Reader& reader, Ucode& ucode) {
  const auto first = reader.next("'dendro-ucode 1'");
  if (first.size() != 2 || first[0] != "dendro-ucode") reader.fail("this is not a .ucode file");
  if (reader.number(first[1], 1u << 30, "format") > kFormat) {
    reader.fail(fmt::format("format {} is newer than this program, which reads up to {}", first[1], kFormat));
  }
  ucode.machine = reader.value("machine");
  if (ucode.machine != "rds3000" && ucode.machine != "pixel-planes")
    reader.fail("machine '" + ucode.machine + "' is unknown: rds3000 and pixel-planes are allowed");
  ucode.isa_version = static_cast<int>(reader.number(reader.value("isa"), 1u << 30, "isa"));
  if (ucode.isa_version != bps32::kIsaVersion) {
    reader.fail(fmt::format("control word layout {} is not the {} of this program", ucode.isa_version,
                            bps32::kIsaVersion));
  }
  ucode.pack = reader.value("pack");
  if (ucode.pack != "none" && ucode.pack != "full")
    reader.fail("pack is none or full, not '" + ucode.pack + "'");
  ucode.multiply_ticks =
      static_cast<int>(reader.number(reader.value("multiply_ticks"), 64, "multiply_ticks"));
  if (ucode.multiply_ticks < 1) reader.fail("multiply_ticks is 1 to 64");
  ucode.entry =
      static_cast<std::uint32_t>(reader.number(reader.value("entry"), bps32::kPageWords - 1, "entry"));
}

std::string checked_name(const Reader& reader, const std::string& name) {
  if (!is_free_name(name)) reader.fail("'" + name + "' cannot be a symbol");
  return name;
}

void read_scratch(Reader& reader, const std::vector<std::string>& fields, Ucode& ucode) {
  ScratchSymbol s;
  s.address = static_cast<std::uint32_t>(reader.number(fields[2], kScratchLimit - 1, "scratch address"));
  s.size = static_cast<std::uint32_t>(reader.number(fields[3], kScratchLimit - s.address, "scratch size"));
  if (s.size == 0) reader.fail("scratch size 0: at least one word");
  const std::string name = checked_name(reader, fields[1]);
  if (ucode.symbols.count(name) || !ucode.scratch.emplace(name, s).second) {
    reader.fail("'" + name + "' is there twice");
  }
}

/// Symbols, scratch areas and data up to `words N`; returns N.
std::size_t read_tables(Reader& reader, Ucode& ucode) {
  for (;;) {
    const auto fields = reader.next("'words N'");
    if (fields[0] == "symbol" && fields.size() == 3) {
      const std::string name = checked_name(reader, fields[1]);
      const auto address = static_cast<std::uint32_t>(reader.number(fields[2], bps32::kPageWords, "symbol"));
      if (!ucode.symbols.emplace(name, address).second) reader.fail("'" + name + "' is there twice");
    } else if (fields[0] == "scratch" && fields.size() == 4) {
      read_scratch(reader, fields, ucode);
    } else if (fields[0] == "data" && fields.size() == 3) {
      const auto address =
          static_cast<std::uint32_t>(reader.number(fields[1], kScratchLimit - 1, "data address"));
      const auto value = static_cast<std::uint32_t>(reader.number(fields[2], 0xFFFFFFFFu, "data"));
      if (!ucode.scratch_data.emplace(address, value).second)
        reader.fail("data " + fields[1] + " is there twice");
    } else if (fields[0] == "words" && fields.size() == 2) {
      const auto words = reader.number(fields[1], bps32::kPageWords, "words");
      if (words == 0) reader.fail("a program has at least one word");
      return words;
    } else {
      reader.fail("a line of symbol, scratch, data or words is expected here, not '" + fields[0] + "'");
    }
  }
}

}  // namespace

bool Ucode::operator==(const Ucode& o) const {
  return machine == o.machine && isa_version == o.isa_version && pack == o.pack &&
         multiply_ticks == o.multiply_ticks && entry == o.entry && symbols == o.symbols &&
         scratch == o.scratch && scratch_data == o.scratch_data && words == o.words;
}

bool is_free_name(std::string_view name) {
  if (name.empty() || (!std::isalpha(static_cast<unsigned char>(name[0])) && name[0] != '_')) return false;
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return false;
  }
  if (std::find(std::begin(kReserved), std::end(kReserved), name) != std::end(kReserved)) return false;
  for (const char* op : am2910::kOpNames) {
    if (name == op) return false;
  }
  for (unsigned r = 0; r < bps32::kRegisters; ++r) {
    if (name == fmt::format("r{}", r)) return false;
  }
  return true;
}

std::string write_ucode(const Ucode& u) {
  std::string text =
      fmt::format("dendro-ucode {}\nmachine {}\nisa {}\npack {}\nmultiply_ticks {}\nentry {}\n", kFormat,
                  u.machine, u.isa_version, u.pack, u.multiply_ticks, hex(u.entry));
  for (const auto& [name, address] : u.symbols) text += fmt::format("symbol {} {}\n", name, hex(address));
  for (const auto& [name, s] : u.scratch)
    text += fmt::format("scratch {} {} {}\n", name, hex(s.address), s.size);
  for (const auto& [address, value] : u.scratch_data)
    text += fmt::format("data {} {}\n", hex(address), hex(value));
  text += fmt::format("words {}\n", u.words.size());
  for (const std::uint64_t word : u.words) text += fmt::format("{:016x}\n", word);
  return text + "sha256 " + base::sha256(text) + "\n";
}

Ucode read_ucode(std::string_view given, const std::string& file) {
  const std::string text = with_plain_line_ends(given);
  Reader reader(text, file);
  Ucode ucode;
  read_header(reader, ucode);
  const std::size_t words = read_tables(reader, ucode);
  for (std::size_t i = 0; i < words; ++i) {
    const auto fields = reader.next("a word of 16 hex digits");
    if (fields.size() != 1 || fields[0].size() != 16) reader.fail("a word is 16 hex digits");
    ucode.words.push_back(reader.number("0x" + fields[0], UINT64_MAX, "word"));
  }
  const std::size_t end = reader.position();
  const std::string sum = reader.value("sha256");
  if (sum != base::sha256(std::string_view(text).substr(0, end)))
    reader.fail("the checksum does not match: the file is damaged");
  if (reader.position() != text.size()) reader.fail("text after the checksum");
  if (ucode.entry >= words) reader.fail("the entry lies behind the last word");
  for (const auto& [name, address] : ucode.symbols) {
    if (address > words) reader.fail("symbol '" + name + "' lies behind the last word");
  }
  return ucode;
}

}  // namespace dendro::tools
