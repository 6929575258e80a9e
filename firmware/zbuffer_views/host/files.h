#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/zbuffer_views/host/prepared.h"
#include "sim/base/scratch_file.h"

namespace dendro::zbuffer_views {

using Bytes = std::vector<std::uint8_t>;
using Digest = std::array<std::uint32_t, 4>;

/// The tree as the programs read it, and its digest.
Bytes tree_file(const Tree& tree);
Digest digest_of(const Bytes& tree_file);

/// The job of the frames [first, first + count). A pitch of 0 leaves V3 to the program.
Bytes job_file(const Prepared& prepared, const Digest& digest, std::size_t first, std::size_t count);

/// Tells apart all that the views of a tree are made from.
std::string views_made_from(const Bytes& tree_file, const ViewSettings& views);

/// What of a file of views the scene needs.
struct ViewsFacts {
  std::uint32_t views = 0;
  double pitch = 0;
};

/// Checks that saved views are whole, of this version, of this tree and made as the scene wants them. Throws UserError naming
/// `path`.
ViewsFacts check_views(const base::ScratchFile& file, const Prepared& prepared, const Digest& digest, const std::string& path);
ViewsFacts check_views(const Bytes& file, const Prepared& prepared, const Digest& digest, const std::string& path);

/// One drawn frame, row-major, the highest row first.
struct DrawnPicture {
  std::vector<float> depth;  ///< kZbvFarDepth where nothing is
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> colour;  ///< kZbvEmptyColour where nothing is
  std::uint32_t covered = 0, shadowed = 0, camera_views = 0, light_views = 0;
};

/// The pictures of a finished file. It comes from our own program: what is wrong with it is a bug.
std::vector<DrawnPicture> read_pictures(const Bytes& file, const Prepared& prepared, const Digest& digest);

}  // namespace dendro::zbuffer_views
