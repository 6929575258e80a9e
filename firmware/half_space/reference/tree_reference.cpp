#include "firmware/half_space/reference/tree_reference.h"

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "firmware/half_space/reference/roughen_model.h"

namespace dendro::half_space {
namespace {

bool is_bark(const ColourSettings& colour, const std::uint8_t* rgb) {
  for (int c = 0; c < 3; ++c)
    if (rgb[c] < colour.trunk_base[c] || rgb[c] > colour.trunk_base[c] + colour.trunk_range[c]) return false;
  return true;
}

std::vector<std::vector<int>> fields_of(const PreparedTree& tree) {
  std::vector<std::vector<int>> fields;
  for (const Roughening& roughening : tree.roughenings) fields.push_back(roughen_tile(roughening));
  return fields;
}

}  // namespace

Rgb texel_at(const PreparedTree& tree, const CubeBytes& cube, int x, int y, double depth) {
  const std::int64_t side = std::int64_t{1} << tree.colouring.level.bits;
  const glm::dvec3 texel = tree.texels(glm::dvec3(x, y, depth));
  std::size_t at = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const auto index = static_cast<std::int64_t>(std::floor(texel[axis])) & (side - 1);
    at = at * static_cast<std::size_t>(side) + static_cast<std::size_t>(index);
  }
  const std::vector<std::uint8_t>& level = cube.at(tree.colour.level);
  return {level.at(4 * at), level.at(4 * at + 1), level.at(4 * at + 2)};
}

HullsReference render_tree_reference(const PreparedTree& tree, const CubeBytes& cube) {
  const auto fields = fields_of(tree);
  FrontMove move;
  if (tree.rough())
    move = [&](std::size_t hull, int x, int y) {
      return fields[hull][static_cast<std::size_t>(y % kTileSide) * kTileSide + x % kTileSide];
    };
  HullsReference picture = render_hulls_reference(tree.hulls, move);
  if (!tree.textured()) return picture;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * picture.width + x;
      // The map goes through the middle of a stored depth's step.
      const Rgb rgb = picture.hull[i] == -1 ? tree.colour.background
                      : picture.hull[i] == HullsReference::kTrunkHull
                          ? tree.hulls.shades[kTrunkMark]
                          : texel_at(tree, cube, x, y, picture.depth[i] - 0.5);
      std::copy(rgb.begin(), rgb.end(), picture.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(i));
    }
  return picture;
}

FixedPointPicture run_tree_fixed_point(const PreparedTree& tree) {
  const PreparedHulls& hulls = tree.hulls;
  BetweenPassesAndMerge roughen;
  if (tree.rough())
    roughen = [&](const Hull& hull, FixedPointPicture& picture) {
      const auto index = static_cast<std::size_t>(&hull - hulls.hulls.data());
      roughen_model(tree.roughenings[index], hulls.width, picture.pixels);
    };
  return run_hulls_fixed_point(hulls, 0, roughen);
}

ErrorReport compare(const PreparedTree& tree, const HullsReference& reference, const CubeBytes& cube,
                    const std::vector<std::uint8_t>& nearest, const std::uint8_t* rgb) {
  ErrorReport report = compare(reference, nearest, tree.hulls.maxdepth, rgb);
  std::int64_t trunk = 0, differ = 0, outside = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const std::uint8_t* shown = rgb + 3 * i;
    trunk += nearest[i] == kTrunkMark;
    if (!tree.textured() || nearest[i] == tree.hulls.maxdepth) continue;
    if (nearest[i] == kTrunkMark) {
      outside += !is_bark(tree.colour, shown);
      continue;
    }
    const auto at = static_cast<int>(i);
    const Rgb wanted = texel_at(tree, cube, at % reference.width, at / reference.width, nearest[i]);
    differ += !std::equal(wanted.begin(), wanted.end(), shown);
  }
  report.extra.emplace_back("trunk_pixels", static_cast<double>(trunk));
  if (tree.textured()) {
    report.extra.emplace_back("texels_differ", static_cast<double>(differ));
    report.extra.emplace_back("bark_outside", static_cast<double>(outside));
  }
  return report;
}

}  // namespace dendro::half_space
