#include "sim/scene/options.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/error.h"

namespace dendro::scene {
namespace {

OptionValue value(const std::variant<bool, std::int64_t, double, std::string, OptionValue::Array>& v,
                  int line = 12) {
  return {v, {"a.toml", line}};
}

Options table() { return Options("half_space", {"a.toml", 10}); }

template <typename F>
std::string refusal(F&& get) {
  try {
    get();
  } catch (const UserError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

TEST(Options, MissingKeysTakeTheDefault) {
  Options options = table();
  EXPECT_EQ(options.integer("n", 5, 0, 9), 5);
  EXPECT_EQ(options.real("r", 0.5, 0, 1), 0.5);
  EXPECT_TRUE(options.boolean("b", true));
  EXPECT_EQ(options.text("t", "x"), "x");
  EXPECT_EQ(options.choice("c", "p", {"p", "q"}), "p");
  EXPECT_TRUE(options.vectors("v", 3).empty());
  EXPECT_EQ(options.vector("w", {1, 2}, 0, 9), (std::vector<double>{1, 2}));
  options.finish();
}

TEST(Options, GivenKeysAreReadAndAnIntegerServesAsAReal) {
  Options options = table();
  options.set("n", value(std::int64_t{7}));
  options.set("c", value(std::string("q")));
  options.set("v", value(OptionValue::Array{value(OptionValue::Array{value(std::int64_t{1}), value(2.5)})}));
  EXPECT_EQ(options.integer("n", 5, 0, 9), 7);
  EXPECT_EQ(options.real("n", 0, 0, 9), 7.0);
  EXPECT_EQ(options.choice("c", "p", {"p", "q"}), "q");
  EXPECT_EQ(options.vectors("v", 2), (std::vector<std::vector<double>>{{1, 2.5}}));
  options.finish();
}

TEST(Options, AnErrorNamesFileLineAndKey) {
  Options options = table();
  options.set("n", value(std::int64_t{10}, 14));
  EXPECT_EQ(refusal([&] { options.integer("n", 5, 0, 9); }),
            "a.toml:14: half_space.n: 10 is outside the allowed 0..9");
  EXPECT_EQ(refusal([&] { options.fail("absent", "is needed"); }), "a.toml:10: half_space.absent: is needed");
}

TEST(Options, WrongTypesAndValuesAreRefused) {
  Options options = table();
  options.set("word", value(std::string("x")));
  options.set("real", value(1.5));
  options.set("nan", value(std::nan("")));
  options.set("ragged", value(OptionValue::Array{value(OptionValue::Array{value(1.0)})}));
  EXPECT_THROW(options.integer("word", 0, 0, 9), UserError);
  EXPECT_THROW(options.integer("real", 0, 0, 9), UserError);
  EXPECT_THROW(options.real("word", 0, 0, 9), UserError);
  EXPECT_THROW(options.real("nan", 0, 0, 9), UserError);
  EXPECT_THROW(options.boolean("real", false), UserError);
  EXPECT_THROW(options.text("real", ""), UserError);
  EXPECT_THROW(options.vectors("ragged", 3), UserError);
  EXPECT_THROW(options.vector("ragged", {0}, 0, 1), UserError);
  EXPECT_NE(refusal([&] { options.choice("word", "p", {"p", "q"}); }).find("one of p, q"), std::string::npos);
}

TEST(Options, AKeyNobodyReadsIsRefusedWithTheNearestKnownOne) {
  Options options = table();
  options.set("depht_bits", value(std::int64_t{8}, 21));
  options.integer("depth_bits", 12, 6, 12);
  options.boolean("boxing", true);
  EXPECT_EQ(refusal([&] { options.finish(); }),
            "a.toml:21: half_space.depht_bits: unknown key; did you mean depth_bits?");
}

}  // namespace
}  // namespace dendro::scene
