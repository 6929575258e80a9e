#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "tests/lockstep/scene_run.h"

namespace dendro::study {
namespace {

using Settings = std::vector<std::string>;

/// A small picture from small views: a few million clocks.
const Settings kSmall{"image.width=64", "image.height=96", "zbuffer_views.view_width=64", "zbuffer_views.view_height=128"};

void expect_levels_equal(const std::string& scene, Settings settings, const Settings& more = {}) {
  settings.insert(settings.end(), more.begin(), more.end());
  const Catalogue all{{sgi_4d35::sgi_4d35_type()}, algorithms(), SHARE};
  const RunOutput cycle = run_scene(all, scene, "cycle", settings), clocked = run_scene(all, scene, "clocked", settings),
                  function = run_scene(all, scene, "function", settings);
  expect_same_time(cycle.object, clocked.object);
  EXPECT_EQ(cycle.rgb, clocked.rgb);
  EXPECT_EQ(cycle.rgb, function.rgb);
  EXPECT_EQ(cycle.object.instructions, function.object.instructions);
  EXPECT_GT(cycle.object.error.covered_pixels, 20);
}

class Sgi4d35Scene : public testing::TestWithParam<std::string> {};

TEST_P(Sgi4d35Scene, HasTheSameClocksCountersAndPictureAtCycleAndClockedAndThePictureAtFunction) {
  expect_levels_equal(GetParam(), std::getenv("DENDRO_SCENES") == nullptr ? kSmall : Settings{});
}

INSTANTIATE_TEST_SUITE_P(Shipped, Sgi4d35Scene,
                         testing::ValuesIn(scenes_or({"magnolia", "magnolia-plain", "magnolia-sun", "magnolia-grove",
                                                      "abies-10", "abies-10-top"})),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(Sgi4d35Programs, EveryVariantTakesTheSameClocksByBothRoutes) {
  for (const Settings& variant :
       std::vector<Settings>{{"zbuffer_views.compiler=\"O1\""},
                             {"zbuffer_views.compiler=\"fcr31\""},
                             {"zbuffer_views.mapped=false"},
                             {"zbuffer_views.skip_empty=true", "zbuffer_views.layers=3"},
                             {"zbuffer_views.full_product=true", "zbuffer_views.layers=1"}}) {
    SCOPED_TRACE(variant.front());
    expect_levels_equal("magnolia", kSmall, variant);
  }
}

TEST(Sgi4d35Programs, PrecomputingAndPolygonsTakeTheSameClocksByBothRoutes) {
  const Settings tree{"image.width=48", "image.height=64", "zbuffer_views.view_width=24", "zbuffer_views.view_height=48",
                      "object.0.age=6", "object.0.leaf_rows=3"};
  expect_levels_equal("magnolia", tree, {"zbuffer_views.precompute=\"timed\""});
  expect_levels_equal("magnolia-plain", tree, {"zbuffer_views.draw=\"polygons\""});
}

TEST(Sgi4d35Programs, TheEndsOfTheParametersTakeTheSameClocksByBothRoutes) {
  const Settings slow{"parameters.processor.exception_cycles=4",      "parameters.fpu.single_to_double_cycles=2",
                      "parameters.fpu.word_to_float_cycles=4",        "parameters.fpu.float_to_word_cycles=3",
                      "parameters.instruction_cache.refill_words=16", "parameters.instruction_cache.streaming=false",
                      "parameters.data_cache.refill_words=16",        "parameters.data_cache.partial_store_cycles=2",
                      "parameters.write_buffer.entries=2",            "parameters.write_buffer.read_bypass=false",
                      "parameters.memory.first_word_cycles=21",       "parameters.memory.word_cycles=2",
                      "parameters.memory.write_cycles=8",             "parameters.memory.page_write_cycles=4",
                      "parameters.memory.page_bytes=1024"};
  const Settings fast{"parameters.processor.exception_cycles=2",     "parameters.fpu.double_to_single_cycles=1",
                      "parameters.fpu.rounding_cycles=0",            "parameters.instruction_cache.refill_words=4",
                      "parameters.data_cache.refill_words=8",        "parameters.data_cache.store_partial=false",
                      "parameters.data_cache.partial_store_cycles=0", "parameters.write_buffer.entries=6",
                      "parameters.memory.first_word_cycles=6",       "parameters.memory.write_cycles=5",
                      "parameters.memory.page_write_cycles=2",       "parameters.memory.page_bytes=4096"};
  expect_levels_equal("magnolia", kSmall, slow);
  expect_levels_equal("magnolia", kSmall, fast);
}

}  // namespace
}  // namespace dendro::study
