#include "sim/study/elf.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "models/parts/r3000/r3000_disasm.h"
#include "sim/base/error.h"
#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

std::string complaint(const std::string& bytes) {
  try {
    study::read_elf(bytes, "a.elf");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(MipsElf, EveryProgramIsFlaggedMipsIAndHoldsNoOtherWord) {
  int programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MIPS_FOLDER)) {
    if (entry.path().extension() != ".elf") continue;
    ++programs;
    const std::string bytes = read_file(entry.path().string());
    EXPECT_EQ(0u, word(bytes, 36) & 0xF0000000) << entry.path();
    EXPECT_EQ(0x1000u, word(bytes, 36) & 0xF000) << entry.path() << ": o32";
    unsigned code = 0;
    const std::uint32_t sections = word(bytes, 32), count = word(bytes, 48) >> 16;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t s = sections + i * 40;
      if (word(bytes, s + 4) != 1 || !(word(bytes, s + 8) & 4)) continue;
      // .rodata shares no section with code, so every word of these is an instruction.
      for (std::uint32_t at = 0; at < word(bytes, s + 20); at += 4, ++code) {
        const std::uint32_t w = word(bytes, word(bytes, s + 16) + at);
        if (entry.path().stem().string().find("fault") != std::string::npos && w == 0x7000003F)
          continue;  // meant to be wrong
        EXPECT_TRUE(r3000::is_mips1(w))
            << entry.path() << std::hex << " " << word(bytes, s + 12) + at << " " << w;
      }
    }
    EXPECT_GT(code, 100u) << entry.path();
  }
  EXPECT_GE(programs, 12 + 18);
}

TEST(MipsElf, WordsOfLaterLevelsAreNoMipsI) {
  for (const std::uint32_t w : {0x50000001u,   // beql
                                0x7C000000u,   // ext
                                0x46200004u,   // sqrt.d
                                0x4600000Du,   // trunc.w.s
                                0x0000000Fu,   // sync
                                0xC0000000u,   // ll
                                0xD4000000u,   // ldc1
                                0x00000034u,   // teq
                                0x70000002u})  // mul
    EXPECT_FALSE(r3000::is_mips1(w)) << std::hex << w;
}

TEST(MipsElf, WrongFilesAreRefusedWithTheReason) {
  const std::string good = read_file(elf("hello"));
  ASSERT_EQ("", complaint(good));
  const auto with = [&](std::size_t at, char byte) {
    std::string bytes = good;
    bytes[at] = byte;
    return complaint(bytes);
  };
  EXPECT_NE(std::string::npos, complaint("text").find("is no ELF file"));
  EXPECT_NE(std::string::npos, with(4, 2).find("64-bit"));
  EXPECT_NE(std::string::npos, with(5, 1).find("little-endian"));
  EXPECT_NE(std::string::npos, with(19, 3).find("machine 3"));
  EXPECT_NE(std::string::npos, with(17, 3).find("not an executable"));
  EXPECT_NE(std::string::npos, with(36, 0x70).find("MIPS 32r2"));
}

TEST(MipsElf, EveryTruncationIsAnErrorOrHarmless) {
  const std::string good = read_file(elf("hello"));
  for (std::size_t size = 0; size < good.size(); size += 97) {
    const std::string text = complaint(good.substr(0, size));
    EXPECT_NE("", text) << size;  // the section table stands last
  }
}

}  // namespace
}  // namespace dendro::mips
