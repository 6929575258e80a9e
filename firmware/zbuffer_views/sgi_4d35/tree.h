#pragma once

#include "firmware/zbuffer_views/sgi_4d35/support.h"

/* A tree in memory; vertices are relative to its centre. */
struct tree {
  struct zbv_tree facts;
  struct zbv_colour* colours;
  float (*vertices)[3];
  struct zbv_triangle* triangles;
  float radius, half_height; /* of an upright cylinder around the centre */
};

/* Reads and checks a tree; the digest is that of `job`. */
void load_tree(const char* path, const struct zbv_job* job, const char* job_path, struct tree* tree);

/* (v1 - v0) x (v2 - v0), in double, since thin triangles cancel. */
void triangle_normal(const struct tree* tree, const struct zbv_triangle* triangle, double normal[3]);
