#include "firmware/half_space/host/prepare_tree.h"

#include <algorithm>

#include "firmware/half_space/host/hulls_layout.h"

namespace dendro::half_space {
namespace {

// Random streams of the scene's seed: of the bark, and of the first crown's roughness.
constexpr std::uint64_t kBarkStream = 10;
constexpr std::uint64_t kCrownStream = 1000;

/// Trunks mark no more pixels than their first boxes hold.
std::size_t most_trunk_pixels(const PreparedHulls& hulls) {
  std::size_t pixels = 0;
  for (const Trunk& trunk : hulls.trunks) {
    if (!trunk.visible()) continue;
    const Box& box = trunk.painter ? trunk.trapezium.box : trunk.hull.program.box;
    pixels += static_cast<std::size_t>(box.width()) * box.height();
  }
  return std::min(pixels, static_cast<std::size_t>(hulls.width) * hulls.height);
}

Rgb mean_bark(const ColourSettings& colour) {
  Rgb rgb;
  for (std::size_t c = 0; c < rgb.size(); ++c)
    rgb[c] = static_cast<std::uint8_t>(colour.trunk_base[c] + colour.trunk_range[c] / 2);
  return rgb;
}

}  // namespace

PreparedTree prepare_tree(const scene::Scene& scene, unsigned pixel_bits) {
  scene::Options options = scene.options;
  PreparedTree tree;
  tree.texture = read_texture(options, scene.image, pixel_bits, scene.seed);
  tree.roughen = read_roughen(options);
  tree.hulls = prepare_crowns(scene, options);
  PreparedHulls& hulls = tree.hulls;
  tree.colour = read_colour(options, tree.texture.bits, scene.camera.height, scene.image.height);
  hulls.shades = read_depth_shades(options, hulls.maxdepth);
  if (!hulls.trunks.empty()) hulls.shades[kTrunkMark] = mean_bark(tree.colour);
  options.finish();

  if (tree.rough())
    for (const Hull& hull : hulls.hulls) {
      tree.roughenings.push_back(make_roughening(tree.roughen, hull.depth_extent, hull.program.box,
                                                 hulls.maxdepth, scene.seed,
                                                 kCrownStream + tree.roughenings.size()));
      hulls.setup_flops += kFlopsRoughening;
    }
  if (tree.textured()) {
    tree.layout = cube_layout(tree.texture.bits, tree.texture.wide);
    tree.texels = texel_map(hulls.view, hulls.depth, tree.colour.texels_per_metre, tree.colour.level);
    tree.colouring = make_colouring(tree.colour, tree.texels, tree.layout, hulls.width, hulls.height,
                                    most_trunk_pixels(hulls), scene.seed, kBarkStream);
    hulls.setup_flops += kFlopsTexelMap;
  }
  return tree;
}

}  // namespace dendro::half_space
