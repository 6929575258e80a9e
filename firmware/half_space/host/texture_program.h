#pragma once

#include "firmware/half_space/host/texture_settings.h"
#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::half_space {

/// Words of the scratch area `params` of texture.gia.
enum TextureParams : unsigned {
  kTextureFbm,        ///< 0 chunks, 1 fbm
  kTextureMipLevels,  ///< to be made beside the finest
  kTextureChunks,
  kTextureChunkEdge,
  kTextureSide,  ///< texels
  kTextureParamsWords
};

/// Makes the cube and all its MIP levels in the frame buffer: sends tables and seeds, starts texture.gia,
/// which must be loaded at `image.entry`, and waits for it. Bits of the pixels outside the cube's byte planes
/// stay. settings.kind is not kNone, layout.bits() is settings.bits.
void build(HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
           const TextureSettings& settings, const CubeLayout& layout);

/// Sends a cube that was made beforehand to where build() would put it: word accesses of 8 pixels x 4 bits,
/// which reach one byte plane only [format ASSUMED DEV-052]. `cube` has all levels of the layout.
void send(HostPort& host, const CubeBytes& cube, const CubeLayout& layout);

}  // namespace dendro::half_space
