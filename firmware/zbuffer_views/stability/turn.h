#pragma once

#include <vector>

#include "firmware/lib/stability.h"
#include "firmware/zbuffer_views/host/files.h"
#include "firmware/zbuffer_views/reference/reference.h"

namespace dendro::zbuffer_views {

/// Two pictures of a turn, one step apart; `degrees` is half-way between them.
struct Pair {
  double degrees = 0;
  Frame frames[2];
};

/// One pair reconstructed with so many layers, against the polygons of both frames. Pixels are the first picture's.
struct PairGlitches {
  std::int64_t tree = 0;    ///< pixels that the polygons cover
  std::int64_t holes = 0;   ///< of these: left empty
  std::int64_t behind = 0;  ///< of these: show what lies more than the threshold behind
  std::int64_t beside = 0;  ///< pixels beyond these that are covered all the same
  std::int64_t points = 0;  ///< surface points that the polygons show in both pictures
  std::int64_t flicker = 0;  ///< of these: a hole or something behind in one of the reconstructed pictures only
  double change = 0, polygon_change = 0;  ///< of a point's brightness from picture to picture, mean of all points, levels of 255

  double wrong_percent() const { return 100 * static_cast<double>(holes + behind) / static_cast<double>(tree); }
  double flicker_percent() const { return 100 * static_cast<double>(flicker) / static_cast<double>(points); }
};

/// A turn around the scene's tree, as the shipped programs draw it.
class Turn {
 public:
  /// A built-in scene of one tree in parallel projection, with `key=value` settings. Views of `most_layers` are made at once: fewer layers are the first of
  /// these. The rig has to be that of a workstation.
  Turn(const stability::Rig& rig, const std::string& scene, int most_layers, const std::vector<std::string>& settings = {});

  const Prepared& prepared() const { return prepared_; }

  /// Steps of `step` degrees around each of `degrees`, which count from where the scene's camera stands.
  std::vector<Pair> pairs(const std::vector<double>& degrees, double step) const;

  /// Both pictures of every pair from views of the first `layers` layers.
  std::vector<DrawnPicture> draw(const std::vector<Pair>& pairs, int layers) const;
  /// The same from the triangles, in double precision.
  std::vector<ReferencePicture> polygons(const std::vector<Pair>& pairs) const;

  /// `drawn` and `polygons` as draw() and polygons() return them.
  std::vector<PairGlitches> glitches(const std::vector<Pair>& pairs, const std::vector<DrawnPicture>& drawn,
                                     const std::vector<ReferencePicture>& polygons) const;

 private:
  PairGlitches compare(const Pair& pair, const DrawnPicture* drawn, const ReferencePicture* polygons) const;

  const stability::Rig& rig_;
  Prepared prepared_;
  Bytes tree_, views_;
  Digest digest_{};
};

}  // namespace dendro::zbuffer_views
