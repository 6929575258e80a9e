#pragma once

/* The files that pass between host and programs, as ../README.md describes them; C11 and C++17. Every
 * structure is a sequence of 32-bit words, big-endian in a file: unsigned integers and IEEE singles. On the
 * R3000 a structure is read as it stands; a little-endian host swaps the bytes of every word. */

#include <stdint.h>

#ifdef __cplusplus
#define ZBV_SIZE(type, words) static_assert(sizeof(struct type) == 4 * (words), #type)
#else
#define ZBV_SIZE(type, words) _Static_assert(sizeof(struct type) == 4 * (words), #type)
#endif

enum zbv_constants {
  kZbvVersion = 1,
  kZbvTreeMagic = 0x5A425452,     /* "ZBTR" */
  kZbvViewsMagic = 0x5A425653,    /* "ZBVS" */
  kZbvJobMagic = 0x5A424A4F,      /* "ZBJO" */
  kZbvPicturesMagic = 0x5A425049, /* "ZBPI" */
  kZbvDigestWords = 4,
  kZbvEmptyColour = 255, /* colour index of an empty sample or pixel */
  kZbvSampleBytes = 7    /* of one layer [MO95 7, 8] */
};

/* Limits: what is outside is refused. */
enum zbv_limits {
  kZbvLeastBands = 2,
  kZbvMostBands = 32,
  kZbvMostLayers = 4,
  kZbvLeastSide = 8, /* of a stored view, whose width is a multiple of 4 */
  kZbvMostSide = 1024,
  kZbvMostLightSide = 2048,
  kZbvMostColours = 254,
  kZbvMostTrees = 64,
  kZbvMostFrames = 4096,
  kZbvMostDistance = 1 << 17, /* world units from the origin, and coordinates from a tree's centre, are below */
  kZbvTurns = 256 /* steps of a tree's rotation in a full turn */
};

/* z of an empty sample, and of a pixel or light pixel without a sample: powers of two, so far apart that no
 * stored z reaches them, and with reciprocals that are no denormals. ASSUMED DEV-151. */
#define kZbvEmptyDepth 1073741824.0f /* 2^30 */
#define kZbvFarDepth 1048576.0f      /* 2^20 */

enum zbv_part { kZbvTrunk = 0, kZbvBranch = 1, kZbvLeaf = 2 };
enum zbv_rule { kZbvInsert = 0, kZbvPeel = 1 };
enum zbv_leaf_side { kZbvLate = 0, kZbvEarly = 1 };
enum zbv_projection { kZbvParallel = 0, kZbvPerspective = 1 };
enum zbv_options {
  kZbvSkipEmpty = 1,   /* test samples for emptiness before they are transformed */
  kZbvFullProduct = 2, /* nine multiplications a sample instead of increments along a row */
  kZbvReuseLight = 4   /* keep the light buffer while the direction of the light stays */
};

/* Labels of marks (0x7002): the phase that begins. */
#define ZBV_PHASES(phase)                                                                            \
  phase(kZbvRead, 1, "read") phase(kZbvDirections, 2, "directions") phase(kZbvNormals, 3, "normals") \
      phase(kZbvProject, 4, "project") phase(kZbvScan, 5, "scan") phase(kZbvChoose, 6, "choose")     \
          phase(kZbvCamera, 7, "reproject_camera") phase(kZbvLight, 8, "reproject_light")            \
              phase(kZbvShade, 9, "shade") phase(kZbvWrite, 10, "write") phase(kZbvClear, 11, "clear")
#define ZBV_PHASE_NUMBER(name, number, text) name = number,
enum zbv_phase { ZBV_PHASES(ZBV_PHASE_NUMBER) };
#undef ZBV_PHASE_NUMBER

/* Every file begins with it. */
struct zbv_head {
  uint32_t magic, version;
  uint32_t bytes;                   /* of the whole file */
  uint32_t digest[kZbvDigestWords]; /* of the tree, see ../README.md */
};
ZBV_SIZE(zbv_head, 7);

/* A tree: this, then `colours` of zbv_colour, `vertices` of three floats, `triangles` of zbv_triangle. World
 * units, y up. */
struct zbv_tree {
  struct zbv_head head;
  uint32_t vertices, triangles, colours;
  float centre[3]; /* on the trunk's axis, which is vertical */
};
ZBV_SIZE(zbv_tree, 13);

struct zbv_colour {
  uint32_t part;  /* zbv_part */
  uint32_t rgb;   /* 0x00RRGGBB */
  uint32_t below; /* index of the colour on the other side; its own where there is none */
  uint32_t checksum; /* 0; in the first colour of views that the host kept: see ../README.md */
};
ZBV_SIZE(zbv_colour, 4);

/* (v1 - v0) x (v2 - v0) points out of the upper side. */
struct zbv_triangle {
  uint32_t corner[3], colour;
};
ZBV_SIZE(zbv_triangle, 4);

/* A set of views: this, then `colours` of zbv_colour, `views` of zbv_view, then the views' planes: per view,
 * per layer z (floats), latitude, longitude, colour (bytes), each of width * height, row-major, the lowest
 * row first. ASSUMED DEV-155. */
struct zbv_views {
  struct zbv_head head;
  uint32_t bands, views, layers, width, height, colours;
  uint32_t rule, leaf_side;
  float pitch;               /* world units from sample to sample */
  float threshold;           /* world units */
  float radius, half_height; /* of an upright cylinder around the centre that holds the tree */
};
ZBV_SIZE(zbv_views, 19);

/* Frames are rows: right, up, forward (away from the viewer). Coordinates of p, relative to the tree's
 * centre: x = right.p, y = up.p, z = forward.p. Sample (i, j) stands for x = x0 + i * pitch, y = y0 + j *
 * pitch. */
struct zbv_view {
  uint32_t circle, number, circle_views; /* k, j and m_k of V1 */
  float theta, phi;                      /* radians */
  float x0, y0;
  float frame[9];
};
ZBV_SIZE(zbv_view, 16);

/* One job for all programs: this, then `trees` of zbv_placement, `frames` of zbv_frame. `precompute` looks at
 * the first group only, the others at the rest. */
struct zbv_job {
  struct zbv_head head; /* digest: of the tree that is wanted */
  uint32_t bands, layers, view_width, view_height;
  uint32_t rule, leaf_side;
  float pitch; /* 0: from the tree, V3, with a margin of 2 %. ASSUMED DEV-154 */
  float threshold;

  uint32_t width, height, projection;
  float scale;              /* pixels per world unit; perspective: per world unit at distance 1 */
  float centre_x, centre_y; /* pixel coordinates of the line of sight, y from the lowest row */
  float near;               /* perspective: what is not farther is left out; above 0 */
  float ambient, diffuse;   /* together at most 1 */
  uint32_t background;      /* 0x00RRGGBB */
  uint32_t shadows;         /* 0 or 1 */
  uint32_t light_width, light_height;
  float light_scale; /* light pixels per world unit; 0: so that all trees' cylinders fit with a margin of 2 %.
                        ASSUMED DEV-152 */
  float epsilon;     /* light pixels */
  uint32_t options;  /* zbv_options */
  uint32_t trees, frames;
};
ZBV_SIZE(zbv_job, 33);

struct zbv_placement {
  float at[3];   /* where the tree's centre goes */
  uint32_t turn; /* about the vertical, 1/256 turns, from z towards x; below 256 */
};
ZBV_SIZE(zbv_placement, 4);

struct zbv_frame {
  float eye[3];
  float frame[9]; /* rows right, up, forward, orthonormal */
  float light[3]; /* unit vector to the light */
  float zero;
};
ZBV_SIZE(zbv_frame, 16);

/* Pictures: this, then per frame a zbv_picture and its planes, row-major, the highest row first: depth
 * (floats; kZbvFarDepth where nothing is), red, green, blue, colour index (bytes; kZbvEmptyColour where
 * nothing is). */
struct zbv_pictures {
  struct zbv_head head;
  uint32_t width, height, frames;
};
ZBV_SIZE(zbv_pictures, 10);

struct zbv_picture {
  uint32_t covered, shadowed;         /* pixels */
  uint32_t camera_views, light_views; /* reprojected, over all trees */
  float light_scale;                  /* as used; 0 without shadows */
  uint32_t zero[3];
};
ZBV_SIZE(zbv_picture, 8);
