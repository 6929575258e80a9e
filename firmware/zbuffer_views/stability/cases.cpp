#include "firmware/zbuffer_views/stability/cases.h"

namespace dendro::zbuffer_views {

std::vector<stability::Case> stability_cases() {
  return {
      {"N-B1", "view counts where an arc is exactly a band", view_counts},
      {"N-B2", "directions at poles, on circles and at the wrap of longitudes", view_borders},
      {"N-B3", "layers: all orders of fragments, distances of exactly the threshold", layer_threshold},
      {"N-B4", "samples of several views at the same depth", view_ties},
      {"N-B5", "bytes of normals: poles, wrap, equator", normal_bytes},
      {"N-B6", "samples exactly on half pixels", half_pixels},
      {"N-B7", "perspective: distances at the eye, behind it and at `near`", near_eye},
      {"N-B8", "threshold of shadows on planes tilted to the light, and under another one", shadow_threshold},
  };
}

}  // namespace dendro::zbuffer_views
