#include "firmware/adaptive_equalisation/host/prepare.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/adaptive_equalisation/host/radiograph.h"
#include "sim/base/error.h"

namespace dendro::adaptive_equalisation {
namespace {

constexpr int kLeastRegion = 16, kMostRegion = 256;

unsigned log2_of(int side) {
  unsigned log = 0;
  while (1 << log < side) ++log;
  return log;
}

int read_region(scene::Options& options) {
  const auto region = static_cast<int>(options.integer("region", 64, kLeastRegion, kMostRegion));
  if ((region & (region - 1)) != 0) options.fail("region", "must be a power of two: ranks are cut to their upper 8 bits");
  return region;
}

}  // namespace

std::map<std::string, unsigned> Layout::registers() const {
  return {{"grey", grey()}, {"grey_bits", grey_bits}, {"rank", rank()}, {"rank_bits", rank_bits},
          {"flag", flag()}, {"row", row()},           {"colour", colour()}, {"top", rank() + rank_bits - 8}};
}

int region_start(int at, int region, int side) { return std::clamp(at - region / 2, 0, side - region); }

Span pixels_that_see(int at, int region, int side) {
  Span span;
  span.first = at < region ? 0 : at - region / 2 + 1;
  span.last = at >= side - region ? side - 1 : at + region / 2;
  return span;
}

Layout choose_layout(const scene::Scene& scene, const lib::ArraySite& site) {
  scene::Options options = scene.options;
  Layout layout;
  const int region = read_region(options);
  if (region > std::min(scene.image.width, scene.image.height))
    options.fail("region", fmt::format("{} pixels do not fit a picture of {} x {}", region, scene.image.width, scene.image.height));
  layout.grey_bits = static_cast<unsigned>(options.integer("grey_bits", 12, 8, 16));
  layout.rank_bits = 2 * log2_of(region);
  if (layout.used() > static_cast<unsigned>(site.memory_bits))
    options.fail("grey_bits", fmt::format("the picture takes {} bits of a pixel; its memory has {}", layout.used(), site.memory_bits));
  return layout;
}

Prepared prepare(const scene::Scene& scene, const lib::ArraySite& site) {
  lib::ArraySite array = site;
  array.frame_width = array.frame_height = 0;  // a region may not be cut by tiles
  lib::check_picture_fits(scene.image, array);
  Prepared prepared;
  prepared.width = scene.image.width, prepared.height = scene.image.height;
  prepared.layout = choose_layout(scene, site);
  scene::Options options = scene.options;
  prepared.region = read_region(options);
  options.integer("grey_bits", 12, 8, 16);
  prepared.method = options.choice("method", "polygon", {"polygon", "rows"}) == "rows" ? Method::kRows : Method::kPolygon;
  options.finish();
  if (!scene.objects.empty())
    throw UserError(scene.objects[0].where.file, scene.objects[0].where.line, "object",
                    "adaptive_equalisation works on a picture; it takes no object");
  prepared.grey = radiograph(prepared.width, prepared.height, prepared.layout.grey_bits, scene.seed);
  return prepared;
}

}  // namespace dendro::adaptive_equalisation
