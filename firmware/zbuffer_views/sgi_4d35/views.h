#pragma once

#include "firmware/zbuffer_views/sgi_4d35/support.h"

/* A file of views, of which those in memory that were needed last. */
struct views {
  struct zbv_views facts;
  struct zbv_colour* colours;
  struct zbv_view* views;
  struct input file;
  uint8_t** planes;   /* of each view; NULL while it is only in the file */
  uint32_t* last_use; /* of each view, growing */
  uint32_t uses;
};

enum { kMostChosen = 4 };

/* Views in order of their number (V5). */
struct chosen {
  uint32_t count, view[kMostChosen];
};

void open_views(const char* path, const struct zbv_job* job, struct views* views);

/* The views around a direction from the tree to the viewer, which is not zero. */
struct chosen choose_views(const struct zbv_views* facts, const double direction[3]);

/* A view's planes, read from the file if need be; what was got before may then be gone, if memory is short.
 */
const uint8_t* view_planes(struct views* views, uint32_t view);
