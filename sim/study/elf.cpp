#include "sim/study/elf.h"

#include <fmt/format.h>

#include <algorithm>

#include "models/parts/r3000/r3000_disasm.h"
#include "sim/base/error.h"

namespace dendro::study {
namespace {

constexpr unsigned kExecutable = 2, kMips = 8, kLoad = 1, kDynamic = 2, kInterpreter = 3, kSymbols = 2;
constexpr std::uint32_t kArchitecture = 0xF0000000, kCode = 4;
constexpr std::size_t kHeaderBytes = 52, kSegmentBytes = 32, kSectionBytes = 40, kSymbolBytes = 16;
constexpr std::uint64_t kLargest = 512u << 20;

/// Big-endian fields with their bounds checked.
class Reader {
 public:
  Reader(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::uint32_t number(std::size_t at, unsigned size) const {
    need(at, size);
    std::uint32_t value = 0;
    for (unsigned i = 0; i < size; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes_[at + i]);
    return value;
  }
  std::uint32_t word(std::size_t at) const { return number(at, 4); }
  std::uint32_t half(std::size_t at) const { return number(at, 2); }
  std::string text(std::size_t at) const {
    need(at, 1);
    return bytes_.substr(at, bytes_.find('\0', at) - at);
  }
  void need(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) wrong("the file is cut off");
  }
  [[noreturn]] void wrong(const std::string& message) const { throw UserError(path_, 0, "", message); }

 private:
  const std::string& bytes_;
  const std::string& path_;
};

void check_header(const Reader& in, const std::string& bytes) {
  if (bytes.compare(0, 4,
                    "\x7F"
                    "ELF") != 0)
    in.wrong("is no ELF file");
  in.need(0, kHeaderBytes);
  if (bytes[4] != 1) in.wrong("is a 64-bit ELF file; the R3000 has 32 bits");
  if (bytes[5] != 2) in.wrong("is little-endian; the machine is big-endian (mips-linux-gnu, not mipsel)");
  if (in.half(18) != kMips) in.wrong(fmt::format("is for ELF machine {}, not MIPS (8)", in.half(18)));
  if (in.half(16) != kExecutable)
    in.wrong("is not an executable at fixed addresses; link with -static -no-pie");
}

/// The first word that is no MIPS I instruction, or that none was found.
std::string first_stranger(const Reader& in) {
  const std::uint32_t sections = in.word(32);
  for (unsigned i = 0; sections != 0 && i < in.half(48); ++i) {
    const std::size_t s = sections + i * kSectionBytes;
    if (in.word(s + 4) != 1 || !(in.word(s + 8) & kCode)) continue;
    for (std::uint32_t at = 0; at + 4 <= in.word(s + 20); at += 4) {
      const std::uint32_t word = in.word(in.word(s + 16) + at);
      if (!r3000::is_mips1(word))
        return fmt::format("the first such word is 0x{:08x} at 0x{:08x}", word, in.word(s + 12) + at);
    }
  }
  return "though none of its words is";
}

void check_level(const Reader& in) {
  static const char* const kLevels[] = {"I",  "II",   "III",  "IV",   "V",   "32",
                                        "64", "32r2", "64r2", "32r6", "64r6"};
  const std::uint32_t level = in.word(36) >> 28;
  if ((in.word(36) & kArchitecture) == 0) return;
  in.wrong(fmt::format("is for MIPS {}, the R3000 is MIPS I (-march=r3000, without libgcc and libc): {}",
                       level < sizeof kLevels / sizeof *kLevels ? kLevels[level] : "of an unknown level",
                       first_stranger(in)));
}

void read_segments(const Reader& in, const std::string& bytes, ElfProgram& program) {
  const std::uint32_t table = in.word(28);
  std::uint64_t total = 0;
  for (unsigned i = 0; i < in.half(44); ++i) {
    const std::size_t p = table + i * kSegmentBytes;
    const std::uint32_t type = in.word(p), offset = in.word(p + 4), address = in.word(p + 8),
                        file = in.word(p + 16), memory = in.word(p + 20);
    if (type == kDynamic || type == kInterpreter) in.wrong("is linked dynamically; link with -static");
    if (type != kLoad || memory == 0) continue;
    in.need(offset, file);
    total += memory;
    if (file > memory || total > kLargest || memory > UINT32_MAX - address)
      in.wrong("a segment's sizes make no sense");
    ElfProgram::Segment segment;
    segment.address = address;
    segment.bytes.assign(bytes.begin() + offset, bytes.begin() + offset + file);
    segment.bytes.resize(memory);
    program.segments.push_back(std::move(segment));
  }
  if (program.segments.empty()) in.wrong("has nothing to load");
}

void read_symbols(const Reader& in, ElfProgram& program) {
  const std::uint32_t sections = in.word(32);
  for (unsigned i = 0; sections != 0 && i < in.half(48); ++i) {
    const std::size_t s = sections + i * kSectionBytes;
    if (in.word(s + 4) != kSymbols) continue;
    if (in.word(s + 24) >= in.half(48)) in.wrong("its symbol table names a section that is not there");
    const std::size_t names = in.word(sections + in.word(s + 24) * kSectionBytes + 16);
    for (std::uint32_t at = 0; at + kSymbolBytes <= in.word(s + 20); at += kSymbolBytes) {
      const std::size_t symbol = in.word(s + 16) + at;
      if ((in.number(symbol + 12, 1) & 15) == 2)
        program.functions.push_back(
            {in.word(symbol + 4), in.word(symbol + 8), in.text(names + in.word(symbol))});
    }
  }
  std::sort(program.functions.begin(), program.functions.end(),
            [](const auto& a, const auto& b) { return a.address < b.address; });
}

}  // namespace

const ElfProgram::Symbol* ElfProgram::function_of(std::uint32_t address) const {
  const auto next =
      std::upper_bound(functions.begin(), functions.end(), address,
                       [](std::uint32_t a, const Symbol& symbol) { return a < symbol.address; });
  if (next == functions.begin()) return nullptr;
  const Symbol& symbol = *(next - 1);
  return address - symbol.address < std::max(symbol.size, 4u) ? &symbol : nullptr;
}

std::string ElfProgram::place(std::uint32_t address) const {
  const Symbol* function = function_of(address);
  if (function == nullptr) return fmt::format("0x{:08x}", address);
  return fmt::format("0x{:08x} ({}+0x{:x})", address, function->name, address - function->address);
}

ElfProgram read_elf(const std::string& bytes, const std::string& path) {
  const Reader in(bytes, path);
  check_header(in, bytes);
  check_level(in);
  ElfProgram program;
  program.entry = in.word(24);
  read_segments(in, bytes, program);
  read_symbols(in, program);
  return program;
}

}  // namespace dendro::study
