#include "sim/config/document.h"

#include <gtest/gtest.h>

#include "sim/base/error.h"
#include "sim/config/nearest.h"

namespace dendro::config {
namespace {

TEST(Document, EveryValueKnowsItsLine) {
  const Node root = parse_toml("a = 1\n[t]\nb = [1,\n 2]\n[[o]]\nc = \"x\"\n", "f");
  EXPECT_EQ(1, root.member("a")->where.line);
  EXPECT_EQ(3, root.member("t")->member("b")->where.line);
  EXPECT_EQ(4, root.member("t")->member("b")->items[1].where.line);
  EXPECT_EQ(6, root.member("o")->items[0].member("c")->where.line);
}

TEST(Document, MergingGoesIntoTablesAndReplacesTheRest) {
  Node under = parse_toml("[t]\na = 1\nb = 2\n[[o]]\nx = 1\n[[o]]\nx = 2\n", "u");
  merge(under, parse_toml("[t]\nb = 3\n[[o]]\nx = 9\n", "o"));
  EXPECT_EQ("{ t = { a = 1, b = 3 }, o = [{ x = 9 }] }", to_toml(under));
}

TEST(Setting, IsTomlWhereItIsTomlElseText) {
  EXPECT_EQ(Value(std::int64_t{3}), parse_setting("3").value);
  EXPECT_EQ(Value(3.5), parse_setting("3.5").value);
  EXPECT_EQ(Value(true), parse_setting("true").value);
  EXPECT_EQ(Value(std::string("full")), parse_setting("full").value);
  EXPECT_EQ(Value(std::string("a\nb = 2")), parse_setting("a\nb = 2").value);
  EXPECT_EQ(3u, parse_setting("[0, 1.5, 2]").items.size());
}

TEST(Setting, AddressesTablesAndItemsOfLists) {
  Node root = parse_toml("[[o]]\nx = 1\n[[o]]\nx = 2\n", "f");
  set_path(root, "o.1.x", parse_setting("7"));
  set_path(root, "new.table.y", parse_setting("8"));
  EXPECT_EQ("{ o = [{ x = 1 }, { x = 7 }], new = { table = { y = 8 } } }", to_toml(root));
  EXPECT_THROW(set_path(root, "o.2.x", parse_setting("7")), UserError);
  EXPECT_THROW(set_path(root, "o.x.y", parse_setting("7")), UserError);
  EXPECT_THROW(set_path(root, "new.table.y.z", parse_setting("7")), UserError);
  EXPECT_THROW(set_path(root, "new..y", parse_setting("7")), UserError);
}

TEST(Setting, WithoutAnEqualsSignIsAnError) {
  EXPECT_THROW(split_setting("image.width"), UserError);
  EXPECT_THROW(split_setting("=3"), UserError);
  EXPECT_EQ("a.b", split_setting("a.b = c=d").first);
  EXPECT_EQ("c=d", split_setting("a.b = c=d").second);
}

TEST(Nearest, IsTheSmallestEditDistance) {
  EXPECT_EQ("height", nearest("hight", {"width", "height", "fov_y"}));
  EXPECT_EQ("", nearest("x", {}));
}

}  // namespace
}  // namespace dendro::config
