#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/hygiene/expect_none.h"
#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

TEST(Links, Resolve) { expect_none(broken_links(repository())); }

TEST(Links, ThatLeadNowhereAreFound) {
  const auto problems = [](const std::string& link) {
    return broken_links({{{"docs/a.md", "# A page\nsee [it](" + link + ")\n"}, {"docs/b/c.md", "## One, two\n"}}}).size();
  };
  EXPECT_EQ(0u, problems("b/c.md"));
  EXPECT_EQ(0u, problems("b/c.md#one-two"));
  EXPECT_EQ(0u, problems("../docs/b"));
  EXPECT_EQ(0u, problems("#a-page"));
  EXPECT_EQ(0u, problems("https://example.org/x"));
  EXPECT_EQ(1u, problems("c.md"));
  EXPECT_EQ(1u, problems("b/c.md#three"));
  EXPECT_EQ(1u, problems("#b-page"));
}

TEST(Pages, AreAllReachedFromTheReadme) { expect_none(unreachable_pages(repository())); }

TEST(Pages, ThatNobodyLinksAreFound) {
  Repository r = {{{"README.md", "[a](docs/a.md)"}, {"docs/a.md", "[b](b.md)"}, {"docs/b.md", "b"}}};
  expect_none(unreachable_pages(r));
  r.files["docs/a.md"] = "b.md";
  EXPECT_EQ(1u, unreachable_pages(r).size());
}

TEST(Pages, NameOnlyPathsThatExist) { expect_none(named_paths_that_do_not_exist(repository())); }

TEST(Pages, ThatNameMissingPathsAreFound) {
  EXPECT_EQ(1u, named_paths_that_do_not_exist({{{"docs/a.md", "in `docs/b.md`\n"}}}).size());
  EXPECT_EQ(0u, named_paths_that_do_not_exist({{{"docs/a.md", "in `docs/a.md` and `docs/<x>.md`\n"}}}).size());
}

TEST(ParameterTables, EqualThePresets) {
  for (const std::string& page : machine_pages(repository())) {
    ASSERT_TRUE(repository().has(page)) << page;
    const std::string expected = with_parameter_table(repository(), page);
    ASSERT_NE("", expected) << page << " has no marks of a generated table";
    if (std::getenv("DENDRO_UPDATE_DOCS") != nullptr) {
      std::ofstream(std::string(REPOSITORY) + "/" + page, std::ios::binary) << expected;
      continue;
    }
    EXPECT_EQ(expected, repository().files.at(page)) << "DENDRO_UPDATE_DOCS=1 writes the tables anew";
  }
}

TEST(ParameterTables, FollowAChangedPreset) {
  Repository r = {{{"docs/machines/m.md",
                    "# M\n<!-- parameters: generated from the presets, see docs/how-to/change-a-parameter.md -->\n"
                    "<!-- end of parameters -->\n"},
                   {"models/machines/m/a.toml", "[bus]\na_ticks = { value = 1, source = \"FG86 6.1\" }\n"}}};
  ASSERT_EQ(std::vector<std::string>{"docs/machines/m.md"}, machine_pages(r));
  const std::string page = with_parameter_table(r, "docs/machines/m.md");
  EXPECT_NE(std::string::npos, page.find("| `bus.a_ticks` | 1 | ticks |  | FG86 6.1 |"));
  r.files["docs/machines/m.md"] = page;
  EXPECT_EQ(page, with_parameter_table(r, "docs/machines/m.md"));
  r.files["models/machines/m/a.toml"] = "[bus]\na_ticks = { value = 2, source = \"FG86 6.1\" }\n";
  EXPECT_NE(page, with_parameter_table(r, "docs/machines/m.md"));
}

}  // namespace
}  // namespace dendro::hygiene
