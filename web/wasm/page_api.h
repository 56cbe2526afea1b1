// SPDX-License-Identifier: Apache-2.0
// What the optician's page calls: plain C functions, JSON text in, JSON text or arrays of numbers
// out. A designed lens stays in a numbered slot until that slot is designed anew with success, so
// that a bad order leaves the last good lens in place.
//
// Points are in the lens frame (optics/ray.h): +x to the wearer's right, +y up, +z toward the eye,
// origin at the front vertex. Functions that return a pointer own what it points to until the next
// call of the same function.
#pragma once

#include <cstddef>

#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#define LG_PAGE_API extern "C" EMSCRIPTEN_KEEPALIVE
#else
#define LG_PAGE_API extern "C"
#endif

inline constexpr int kPageSlots = 4;  // right, left, and two for comparisons

// Designs and certifies the order of one eye into `slot`:
//   {"eye": "right", "sphere": -4, "cylinder": -0.5, "axis": 90, "medium": {"name", "index_d",
//    "abbe", "density_g_cm3"}, "base_curve_D", "center_thickness_mm", "min_center_thickness_mm",
//    "min_edge_thickness_mm", "diameter_mm", "contour_mm": [x0, y0, ...], "vertex_distance_mm",
//    "camera_mm", "depth_mm", "feature_height_mm", "feature_meridian_deg", "design" (single, round,
//    flat28, flat35, executive, progressive), "corridor_mm", "coat" (none, single, v, broadband),
//    "tint" (0..0.96)}. A design other than single takes effect with an addition.
// Returns {"ok": true, ...the names of `lorgnette lens --json`..., "certificate": [...]}
// or {"ok": false, "error": sentence}.
LG_PAGE_API const char* lg_design(int slot, const char* order_json);

// The materials that the optics knows: [{"name", "index_d", "abbe", "density_g_cm3",
// "min_center_mm", "min_edge_mm"}, ...]
LG_PAGE_API const char* lg_media();

// A prescription for both eyes in our JSON or FHIR, checked: {"ok": true, "OD": {"sphere",
// "cylinder", "axis", "add", "prism_in", "prism_up"}, "OS": {...}, "PD": {"right", "left"},
// "vertex_distance"}; PD and vertex distance are null where a FHIR resource does not say them.
LG_PAGE_API const char* lg_read_prescription(const char* text, const char* name);

// A prescription in our JSON as FHIR; `date` as FHIR writes it. {"ok": true, "fhir": text}
LG_PAGE_API const char* lg_write_fhir(const char* text, const char* date);

// Both surfaces at n points (x, y): front z, back z (parallel to the axis); NaN where a surface
// ends. 2 n numbers.
LG_PAGE_API const double* lg_surfaces(int slot, const double* points, int n);

// A fan of n rays in a TABO meridian, parallel to the axis turned by field_deg (object at infinity,
// object_mm = 0) or from a point object_mm before the front vertex and object_height_mm off the
// axis; ray i meets the front at about height -half..half. For each ray 9 numbers: status
// (0 ok), start (h, z), front (h, z), back (h, z), exit direction (h, z).
LG_PAGE_API const double* lg_fan(int slot, double meridian_deg, double half_mm, int n,
                                 double field_deg, double object_mm, double object_height_mm);

// What a pinhole camera sees through the lens. Camera at (cx, cy) off the lens axis, camera_mm
// before the front vertex. Pixel (i, j), rows downwards, of a w x h grid over the rectangle
// [x0, x1] x [y0, y1] of the plane through the front vertex. The face lies behind the back vertex
// at depth_mm + curve * max(0, |x + face_x_mm| - flat_mm)^2 / 100, with x + face_x_mm counted from
// the middle of the face. For each pixel 4 numbers: status (0 ok), the point of the face (x, y),
// and the share of light that both surfaces let through. 4 w h numbers.
struct PageView {
  double camera_mm, cx, cy, x0, y0, x1, y1, depth_mm, face_x_mm, flat_mm, curve;
  double rings;  // not 0: lg_rings is wanted besides
};
LG_PAGE_API const float* lg_view(int slot, const PageView* view, int w, int h);

// Beside the last lg_view that asked for them, the power rings of its w x h pixels: the share of
// light with which the cut edge's wall shows at each after reflections inside the bare lens. w h
// numbers.
LG_PAGE_API const float* lg_rings();

// What the turning eye meets over the lens: an n x m grid (rows downwards) of gazes from a centre
// of rotation stop_mm behind the back vertex toward (x, y) of the plane through the back vertex,
// |x| <= half_x_mm, |y| <= half_y_mm. For each 8 numbers: status (0 ok), error against the axis'
// back vertex power as mean, J0 and J45 (D), prism of the gaze, base toward x and y (prism D), and
// the tangents of the object's direction (x, y).
LG_PAGE_API const double* lg_gaze_map(int slot, double stop_mm, double half_x_mm, double half_y_mm,
                                      int n, int m);

// Gazes 0..max_deg in n steps along a TABO meridian (the half of positive height), each (degrees,
// sagittal and tangential error against the back vertex power in that meridian's own directions,
// NaN when lost). 3 (n + 1) numbers.
LG_PAGE_API const double* lg_gaze_line(int slot, double stop_mm, double meridian_deg,
                                       double max_deg, int n);

// The front surface of a progressive lens (ProgressiveSurface of optics/surface_shapes.h) by
// itself: over |x| <= half_mm, |y| <= half_mm an n x n grid (rows downwards) of (mean power,
// astigmatism). 2 n n numbers.
LG_PAGE_API const double* lg_progressive_map(double far_D, double add_D, double corridor_mm,
                                             double index, double half_mm, int n);
