#pragma once

#include "firmware/zbuffer_views/sgi_4d35/support.h"

/* V1: views on circle k of 0..bands: one at the poles, else the smallest number above 2 * bands * sin(k * pi
 * / bands). */
uint32_t circle_views(uint32_t bands, uint32_t k);
uint32_t all_views(uint32_t bands);

/* V2: all views in their order, without x0 and y0. */
void make_views(uint32_t bands, struct zbv_view* views);
