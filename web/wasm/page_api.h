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

inline constexpr int kPageSlots = 5;  // right, left, a comparison, practice, and one to spare

// Designs and certifies the order of one eye into `slot`:
//   {"eye": "right", "sphere": -4, "cylinder": -0.5, "axis": 90, "medium": {"name", "index_d",
//    "abbe", "density_g_cm3"}, "base_curve_D", "center_thickness_mm", "min_center_thickness_mm",
//    "min_edge_thickness_mm", "diameter_mm", "contour_mm": [x0, y0, ...], "vertex_distance_mm",
//    "pantoscopic_deg", "face_form_deg", "refraction_vertex_mm", "compensate", "camera_mm",
//    "depth_mm", "feature_height_mm", "feature_meridian_deg", "design" (single, round, flat28,
//    flat35, executive, progressive, soft), "corridor_mm", "coat" (none, single, v, broadband),
//    "tint" (0..0.96)}. A design other than single takes effect with an addition. With "compensate"
// the lens is made so that as worn it gives the eye what the prescription asks.
// Returns {"ok": true, ...the names of `lorgnette lens --json`..., "made": {"sphere", "cylinder",
// "axis"} as ground, "target" (the same keys) and "worn" (with "prism_in" and "prism_up"): what the
// eye is to meet and what it meets as worn, "certificate": [...]}
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

// Points and rays from here on are in the worn lens's straight frame: the lens frame while nothing
// leans; a lens that leans turns about its back vertex, which keeps its place.

// A fan of n rays in a TABO meridian, parallel to the axis turned by field_deg (object at infinity,
// object_mm = 0) or from a point object_mm before the front vertex and object_height_mm off the
// axis; ray i meets the front at about height -half..half. For each ray 9 numbers: status
// (0 ok), start (h, z), front (h, z), back (h, z), exit direction (h, z), projected onto the
// meridian.
LG_PAGE_API const double* lg_fan(int slot, double meridian_deg, double half_mm, int n,
                                 double field_deg, double object_mm, double object_height_mm);

// From the lens frame to the straight frame: a rotation, row by row, and where the front vertex
// goes. 12 numbers.
LG_PAGE_API const double* lg_worn(int slot);

// What a pinhole camera sees through the lens. Camera at (cx, cy) off the lens axis, camera_mm
// before the front vertex. Pixel (i, j), rows downwards, of a w x h grid over the rectangle
// [x0, x1] x [y0, y1] of the plane z = 0. The face is that of page_face.h, its irises depth_mm
// behind the back vertex and its middle at x = -face_x_mm. For each pixel 4 numbers: status (0 ok),
// where in that plane the camera sees the same point of the face without the lens (x from the
// middle of the face, y), and the share of light that the coated, tinted lens lets through.
// 4 w h numbers.
struct PageView {
  double camera_mm, cx, cy, x0, y0, x1, y1, depth_mm, face_x_mm;
  double rings;     // not 0: lg_rings is wanted besides
  double mirrored;  // not 0: lg_mirrored is wanted besides
};
LG_PAGE_API const float* lg_view(int slot, const PageView* view, int w, int h);

// Beside the last lg_view that asked for them, the power rings of its w x h pixels: the share of
// light with which the cut edge's wall shows at each after reflections inside the lens. w h
// numbers.
LG_PAGE_API const float* lg_rings();

// Beside the last lg_view that asked for them, what the front surface and, through it, the back one
// mirror at each pixel: direction (x, y of a unit vector that points back toward the camera's side)
// and share of that light in linear red, green and blue; zeros where nothing is mirrored. Two times
// 5 numbers a pixel.
inline constexpr int kMirroredRow = 10;
LG_PAGE_API const float* lg_mirrored();

// A focimeter's reading at (x, y) of the lens, by rays: mean, J0, J45 (D), prism toward +x and +y
// (prism D), and what no sphere and cylinder explains (D); NaN where nothing can be read. `turned`
// not 0: the lens lies with its front on the stop (front vertex power). 6 numbers.
LG_PAGE_API const double* lg_focimeter(int slot, double x_mm, double y_mm, int turned);

// What the turning eye meets over the lens: an n x m grid (rows downwards) of gazes from a centre
// of rotation stop_mm behind the back vertex toward the points (x, y) of the lens's plane through
// the back vertex, |x| <= half_x_mm, |y| <= half_y_mm. For each 10 numbers: status (0 ok), error
// against the target as mean, J0 and J45 (D), prism of the gaze, base toward x and y (prism D), and
// the tangents of the object's direction and of the gaze (x, y each), in the eye's straight axes.
LG_PAGE_API const double* lg_gaze_map(int slot, double stop_mm, double half_x_mm, double half_y_mm,
                                      int n, int m);

// Gazes -max_deg..max_deg in n steps along a TABO meridian, each (degrees, sagittal and tangential
// error against the target in that meridian's own directions, NaN when lost). 3 (n + 1) numbers.
LG_PAGE_API const double* lg_gaze_line(int slot, double stop_mm, double meridian_deg,
                                       double max_deg, int n);

// The front surface of a progressive lens by itself, hard (ProgressiveSurface of
// optics/surface_shapes.h) or soft (optics/soft_progressive.h): over |x| <= half_mm, |y| <= half_mm
// an n x n grid (rows downwards) of (mean power, astigmatism), NaN where it ends. 2 n n numbers.
LG_PAGE_API const double* lg_progressive_map(double far_D, double add_D, double corridor_mm,
                                             double index, int soft, double half_mm, int n);
