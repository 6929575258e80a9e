#include "sim/trace/chrome_trace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace dendro::trace {
namespace {

using nlohmann::json;

TEST(ChromeTrace, TracksAreNamedInTheOrderOfTheirFirstUse) {
  ChromeTrace trace("p");
  trace.span("b", "one", 1, 2);
  trace.instant("a", "dot", 3);
  trace.span("b", "two", 4, 0.5, {{"ticks", 7}});
  const json events = json::parse(trace.json())["traceEvents"];
  ASSERT_EQ(6u, events.size());
  EXPECT_EQ("p", events[0]["args"]["name"]);
  EXPECT_EQ("b", events[1]["args"]["name"]);
  EXPECT_EQ("a", events[2]["args"]["name"]);
  EXPECT_EQ(events[1]["tid"], events[3]["tid"]);
  EXPECT_EQ(events[1]["tid"], events[5]["tid"]);
  EXPECT_EQ(events[2]["tid"], events[4]["tid"]);
  EXPECT_EQ(0.5, events[5]["dur"]);
  EXPECT_EQ(7, events[5]["args"]["ticks"]);
}

TEST(ChromeTrace, AnyNameIsValidJson) {
  ChromeTrace trace("quote \" backslash \\ newline \n");
  trace.counter("c\t", 1, {{"v\"", 2}});
  EXPECT_EQ("quote \" backslash \\ newline \n", json::parse(trace.json())["traceEvents"][0]["args"]["name"]);
}

}  // namespace
}  // namespace dendro::trace
