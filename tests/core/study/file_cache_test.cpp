#include "sim/study/file_cache.h"

#include <sys/resource.h>

#include <csignal>
#include <cstdlib>

#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

using base::ScratchFile;
using Bytes = std::vector<std::uint8_t>;

ScratchFile file_of(const Bytes& bytes) {
  ScratchFile file;
  file.write(0, bytes.data(), bytes.size());
  return file;
}

/// Seeded noise, which no compression makes smaller.
Bytes noise(std::size_t size, std::uint32_t seed) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>((seed = seed * 1664525 + 1013904223) >> 24);
  return bytes;
}

class ScratchFileTest : public fake::TestFolder {};

TEST_F(ScratchFileTest, HoldsWhatWasWrittenAndZerosBetween) {
  ScratchFile file;
  const Bytes a = noise(3'000'000, 1);
  file.write(10, a.data(), a.size());
  EXPECT_EQ(a.size() + 10, file.size());
  EXPECT_EQ(Bytes(10, 0), file.start(10));
  const Bytes all = file.start(file.size() + 5);
  ASSERT_EQ(file.size(), all.size());
  EXPECT_TRUE(std::equal(a.begin(), a.end(), all.begin() + 10));
  Bytes end(20, 7);
  EXPECT_EQ(4u, file.read(file.size() - 4, end.data(), 20));
  EXPECT_EQ(0u, file.read(file.size() + 4, end.data(), 20));
  file.clear();
  EXPECT_EQ(0u, file.size());
  EXPECT_EQ(Bytes(), file.start(5));
}

TEST_F(ScratchFileTest, ComesFromAFileAndGoesToOne) {
  const Bytes bytes = noise(2'500'000, 2);
  ASSERT_TRUE(file_of(bytes).write_to(path("a")));
  ScratchFile file;
  ASSERT_TRUE(file.read_from(path("a")));
  EXPECT_EQ(bytes, file.start(file.size()));
  EXPECT_FALSE(file.read_from(path("missing")));
  EXPECT_FALSE(file.write_to(path("missing/b")));
}

TEST_F(ScratchFileTest, StaysInMemoryWhereNoFileCanGrow) {
  const Bytes bytes = noise(200'000, 3);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(0, getrlimit(RLIMIT_FSIZE, &before));
  const rlimit small{100'000, before.rlim_max};
  ASSERT_EQ(0, setrlimit(RLIMIT_FSIZE, &small));
  ScratchFile file;
  for (std::size_t at = 0; at < bytes.size(); at += 50'000) file.write(at, bytes.data() + at, 50'000);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(bytes, file.start(file.size()));
}

class FileCacheTest : public fake::TestFolder {
 protected:
  FileCacheTest() { ::setenv("XDG_CACHE_HOME", path("").c_str(), 1); }
};

TEST_F(FileCacheTest, GivesBackWhatItKeeps) {
  const FileCache cache;
  ScratchFile file;
  EXPECT_FALSE(cache.find("a", file));
  for (const std::size_t size : {0, 1, 5'000'000}) {
    const Bytes bytes = noise(size, 4);
    cache.store("a", file_of(bytes));
    ASSERT_TRUE(cache.find("a", file)) << size;
    EXPECT_EQ(bytes, file.start(size + 1)) << size;
  }
  EXPECT_FALSE(cache.find("b", file));
  EXPECT_EQ(0u, file.size());
}

TEST_F(FileCacheTest, WhatWasNotUsedForLongestGoesFirst) {
  const FileCache cache(250'000);
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path("dendro")) / "files";
  const auto age = [&](const char* key, int hours) {
    fs::last_write_time(folder / key, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  cache.store("a", file_of(noise(100'000, 5)));
  cache.store("b", file_of(noise(100'000, 6)));
  age("a", 3), age("b", 2);
  ScratchFile file;
  EXPECT_TRUE(cache.find("a", file));
  cache.store("c", file_of(noise(100'000, 7)));
  EXPECT_TRUE(cache.find("a", file));
  EXPECT_FALSE(cache.find("b", file));
  EXPECT_TRUE(cache.find("c", file));
}

TEST_F(FileCacheTest, WithoutAFolderNothingIsKeptAndNothingFails) {
  write("dendro", "a file, not a folder");
  const FileCache cache;
  cache.store("a", file_of(noise(10, 8)));
  ScratchFile file;
  EXPECT_FALSE(cache.find("a", file));
}

}  // namespace
}  // namespace dendro::study
