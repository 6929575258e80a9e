#include <gtest/gtest.h>

#include "tests/hygiene/expect_none.h"
#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

// Split, so that this file itself names no deviation that does not exist.
const std::string kDev999 = std::string("DEV") + "-999";

Repository with_sources(const std::string& path, const std::string& text) {
  return {{{"docs/sources.md", "| key | source |\n| --- | --- |\n| FG86 | a paper |\n| DER | derived |\n"}, {path, text}}};
}

std::string section(const std::string& deviation, const std::string& test) {
  return "### " + deviation + "\n\nx `bus.a_ticks`\n\n- Why: y\n- Range: z\n- Effect: e\n- Settled by: s\n- Pinned by: " + test +
         "\n";
}

TEST(Presets, EveryNumberHasASource) { expect_none(presets_without_source(repository())); }

TEST(Presets, ANumberWithoutSourceIsFound) {
  const auto problems = [](const std::string& entry) {
    return presets_without_source(with_sources("models/machines/m/a.toml", "[bus]\na_ticks = " + entry + "\n")).size();
  };
  EXPECT_EQ(0u, problems("{ value = 1, source = \"FG86 6.1\" }"));
  EXPECT_EQ(0u, problems("{ value = 1, range = [0, 2], source = \"ASSUMED " + kDev999 + "\" }"));
  EXPECT_EQ(1u, problems("1"));
  EXPECT_EQ(1u, problems("{ value = 1 }"));
  EXPECT_EQ(1u, problems("{ value = 1, source = \"\" }"));
  EXPECT_EQ(1u, problems("{ value = 1, source = \"somebody said\" }"));
  EXPECT_EQ(1u, problems("{ value = 1, source = \"FG87 6.1\" }"));
  EXPECT_EQ(1u, problems("{ value = 1, source = \"ASSUMED " + kDev999 + "\" }"));
  EXPECT_EQ(1u, problems("{ value = 1, range = [0, 2], source = \"ASSUMED\" }"));
}

TEST(Citations, EveryKeyIsInTheListOfSources) { expect_none(unresolved_keys(repository())); }

TEST(Citations, AnUnknownKeyIsFoundInPagesAndComments) {
  EXPECT_EQ(1u, unresolved_keys(with_sources("docs/a.md", "so it is [XY-12 3]\n")).size());
  EXPECT_EQ(1u, unresolved_keys(with_sources("docs/a.md", "so it is [FG86 2.2, 6; XY-12]\n")).size());
  EXPECT_EQ(1u, unresolved_keys(with_sources("sim/a.h", "int a = 2;  // [XY12 3]\n")).size());
  EXPECT_EQ(0u, unresolved_keys(with_sources("docs/a.md", "so it is [FG86 2.2, 6; DER], [FG86-K9], [a link](XY-12), t[XY12]\n")).size());
  EXPECT_EQ(0u, unresolved_keys(with_sources("sim/a.h", "int a = b[XY12];\n")).size());
}

TEST(Deviations, AreListedExactlyWhenUsed) { expect_none(unlisted_or_unused_deviations(repository())); }

TEST(Deviations, OneThatIsNotListedOrNotUsedIsFound) {
  const Repository unlisted = {{{"models/a.h", "int a = 1;  // ASSUMED " + kDev999 + "\n"}}};
  EXPECT_EQ(1u, unlisted_or_unused_deviations(unlisted).size());
  const Repository unused = {{{"docs/deviations.md", section(kDev999, "`A.B`")}, {"docs/a.md", kDev999}}};
  EXPECT_EQ(1u, unlisted_or_unused_deviations(unused).size());
}

TEST(Deviations, AnswerEveryQuestionAndNameTestsThatExist) {
  expect_none(incomplete_deviations(repository()));
}

TEST(Deviations, AMissingAnswerTestOrParameterIsFound) {
  const std::string preset =
      "[bus]\na_ticks = { value = 1, range = [0, 2], source = \"ASSUMED " + kDev999 + "\" }\n";
  Repository r = {{{"docs/deviations.md", section(kDev999, "`A.B`")},
                   {"tests/a_test.cpp", "TEST(A, B) {\n"},
                   {"models/machines/m/a.toml", preset}}};
  expect_none(incomplete_deviations(r));
  r.files["docs/deviations.md"] = section(kDev999, "`A.C`");
  EXPECT_EQ(1u, incomplete_deviations(r).size());
  r.files["docs/deviations.md"] = "### " + kDev999 + "\n`bus.a_ticks`\n- Pinned by: `A.B`\n";
  EXPECT_EQ(4u, incomplete_deviations(r).size());
  r.files["docs/deviations.md"] = section(kDev999, "`A.B`");
  r.files["models/machines/m/a.toml"] =
      "[bus]\nb_ticks = { value = 1, range = [0, 2], source = \"ASSUMED " + kDev999 + "\" }\n";
  EXPECT_EQ(1u, incomplete_deviations(r).size());
}

}  // namespace
}  // namespace dendro::hygiene
