#include <gtest/gtest.h>

#include <cstdio>

#include "tests/hygiene/expect_none.h"
#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

std::string lines(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "int a;\n";
  return text;
}

TEST(Repository, IsThereAtAll) {
  EXPECT_GT(repository().files.size(), 100u);
  EXPECT_TRUE(repository().has("README.md"));
  EXPECT_TRUE(repository().has_path("models/machines"));
  EXPECT_FALSE(repository().has_path("models/machine"));
}

TEST(Sources, StayBelowTheHardLimit) {
  const std::string warnings = joined(long_sources(repository()));
  if (!warnings.empty()) std::printf("above the soft limit:\n%s", warnings.c_str());
  expect_none(oversized_sources(repository()));
}

TEST(Sources, ALineAboveALimitIsFound) {
  EXPECT_EQ(0u, oversized_sources({{{"sim/a.cpp", lines(800)}}}).size());
  EXPECT_EQ(1u, oversized_sources({{{"sim/a.cpp", lines(801)}}}).size());
  EXPECT_EQ(1u, long_sources({{{"sim/a.cpp", lines(401)}}}).size());
}

TEST(Data, IsSmallOrHasAReason) { expect_none(oversized_data(repository())); }

TEST(Data, AByteAboveTheLimitOrAStaleReasonIsFound) {
  const std::string list = "tests/hygiene/large_files.toml";
  const std::string reason = "\"a.bin\" = \"it is so\"\n";
  EXPECT_EQ(0u, oversized_data({{{"a.bin", std::string(200'000, 'x')}}}).size());
  EXPECT_EQ(1u, oversized_data({{{"a.bin", std::string(200'001, 'x')}}}).size());
  EXPECT_EQ(0u, oversized_data({{{"a.bin", std::string(200'001, 'x')}, {list, reason}}}).size());
  EXPECT_EQ(1u, oversized_data({{{"a.bin", "x"}, {list, reason}}}).size());
}

TEST(Files, BelongToNoOneMachine) { expect_none(machine_traces(repository())); }

TEST(Files, ThatNameAMachineAreFound) {
  for (const char* text : {"see /work/main", "cd /tmp/a", "/home/me/x", "(/root/x)", "http://localhost:3000/",
                           "https://10.0.0.1/x", "https://host:8443/x", "pip --index pypi.org"})
    EXPECT_EQ(1u, machine_traces({{{"docs/a.md", text}}}).size()) << text;
  EXPECT_EQ(0u, machine_traces({{{"docs/a.md", "build/tmp/a, https://example.org/a and/or b"}}}).size());
}

TEST(Headers, AreIncludedOnce) { expect_none(headers_without_pragma_once(repository())); }

TEST(Headers, WithoutPragmaOnceAreFound) {
  EXPECT_EQ(1u, headers_without_pragma_once({{{"sim/a.h", "int a;\n"}}}).size());
  EXPECT_EQ(0u, headers_without_pragma_once({{{"sim/a.h", "#pragma once\nint a;\n"}}}).size());
}

}  // namespace
}  // namespace dendro::hygiene
