#include "firmware/zbuffer_views/stability/turn.h"

#include <gtest/gtest.h>

#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/study/algorithms.h"
#include "sim/study/stability.h"

// What B15 and B16 count, on a small magnolia: pictures with faults at known places.

namespace dendro::zbuffer_views {
namespace {

const std::vector<std::string> kSmall = {"image.width=72",  "image.height=72", "zbuffer_views.view_width=72", "zbuffer_views.view_height=144",
                                         "object.0.triangles=3000"};
constexpr std::size_t kEvery = 7;

/// Pictures that show what the triangles do.
std::vector<DrawnPicture> copies_of(const std::vector<ReferencePicture>& polygons) {
  std::vector<DrawnPicture> drawn;
  for (const ReferencePicture& p : polygons) {
    DrawnPicture picture;
    picture.colour = p.colour;
    for (const double depth : p.depth) picture.depth.push_back(static_cast<float>(depth));
    for (const double value : p.rgb) picture.rgb.push_back(static_cast<std::uint8_t>(value + 0.5));
    drawn.push_back(std::move(picture));
  }
  return drawn;
}

/// Every so many of a picture's covered pixels, changed by `spoil`; how many.
template <class Spoil>
std::int64_t spoil_some(DrawnPicture& picture, const Spoil& spoil) {
  std::int64_t covered = 0, spoiled = 0;
  for (std::size_t i = 0; i < picture.colour.size(); ++i)
    if (picture.colour[i] != kNoColour && ++covered % kEvery == 0) spoil(picture, i), ++spoiled;
  return spoiled;
}

/// Runs `look` on the workstation's rig in a worker process; what it returns comes back as rows.
std::vector<stability::Row> rows_of(const std::function<std::vector<stability::Row>(const Turn&)>& look) {
  const std::vector<study::StabilitySuite> suites = {
      {"zbuffer_views", "sgi-4d35", {}, {{"T", "a turn", [&](const stability::Rig& rig, std::uint64_t) {
         return stability::Result{look(Turn(rig, "video-4", 2, kSmall)), {}, {}};
       }}}}};
  return study::run_stability({{sgi_4d35::sgi_4d35_type()}, study::algorithms(), ""}, suites, {}, nullptr).at(0).rows;
}

stability::Row same(const std::string& what, std::int64_t measured, std::int64_t wanted) {
  return {"T", what, static_cast<double>(std::abs(measured - wanted)), 0, "", "", stability::Bound::kAtMost, std::to_string(measured)};
}

void expect_pass(const std::vector<stability::Row>& rows) {
  EXPECT_FALSE(rows.empty());
  for (const stability::Row& row : rows) EXPECT_TRUE(row.pass()) << row.what << ": " << row.where << ", off by " << row.measured;
}

TEST(Turn, PlantedHolesAndDepthsBehindAreCountedAndFlickerInOnePictureOnly) {
  expect_pass(rows_of([](const Turn& turn) {
    const auto pairs = turn.pairs({0, 40}, 0);
    const auto polygons = turn.polygons(pairs);
    auto drawn = copies_of(polygons);
    std::vector<stability::Row> rows;
    for (const PairGlitches& g : turn.glitches(pairs, drawn, polygons)) {
      rows.push_back(same("no hole", g.holes + g.behind + g.beside + g.flicker, 0));
      rows.push_back(same("every point is seen twice", g.points, g.tree));
      rows.push_back({"T", "a tree is there", static_cast<double>(g.tree), 300, "", "", stability::Bound::kMoreThan, ""});
    }
    const std::int64_t holes = spoil_some(drawn[0], [](DrawnPicture& p, std::size_t i) { p.colour[i] = kNoColour; });
    const auto deeper = static_cast<float>(1.5 * turn.prepared().views.threshold);
    const std::int64_t behind = spoil_some(drawn[3], [&](DrawnPicture& p, std::size_t i) { p.depth[i] += deeper; });
    const auto glitches = turn.glitches(pairs, drawn, polygons);
    rows.push_back(same("holes", glitches[0].holes, holes));
    rows.push_back(same("holes flicker", glitches[0].flicker, holes));
    rows.push_back(same("nothing is behind in the first picture", glitches[1].holes + glitches[1].behind, 0));
    rows.push_back(same("what is behind in the second flickers", glitches[1].flicker, behind));
    return rows;
  }));
}

TEST(Turn, FewerLayersAreTheFirstOfManyAndMissMore) {
  expect_pass(rows_of([](const Turn& turn) {
    const auto pairs = turn.pairs({20}, 1);
    const auto polygons = turn.polygons(pairs);
    std::vector<double> missing;
    for (int layers = 1; layers <= 2; ++layers) {
      const PairGlitches g = turn.glitches(pairs, turn.draw(pairs, layers), polygons).at(0);
      missing.push_back(static_cast<double>(g.holes + g.behind));
    }
    return std::vector<stability::Row>{
        {"T", "one layer misses pixels", missing[0], 0, "", "", stability::Bound::kMoreThan, ""},
        {"T", "the second mends some", missing[0], missing[1], "", "", stability::Bound::kMoreThan, std::to_string(missing[1])}};
  }));
}

}  // namespace
}  // namespace dendro::zbuffer_views
