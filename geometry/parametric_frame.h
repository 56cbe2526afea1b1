// SPDX-License-Identifier: Apache-2.0
// Builds an eyeglass frame from its parameters: closed meshes with the normals of the smooth solid.
#pragma once

#include "geometry/frame_model.h"
#include "geometry/frame_parameters.h"
#include "geometry/ring_grid.h"

namespace lorgnette {

// Fineness of the meshes and of the stored contour.
struct FrameTessellation {
  MeshFineness mesh;
  int contour_points = 720;
};

// Rims, bridges, pads, end pieces, hinges and temples, the right half the mirror image of the left.
// Parts overlap where they join; each is closed, oriented outward and free of self-intersection.
// Openings are the parameters' own curves, not measured from the meshes (geometry/contour.h is).
// Tested: boxing exact to 1e-3 mm of the polygon, mirror symmetry exact.
FrameModel BuildFrame(const FrameParameters& parameters, const FrameTessellation& fineness = {});

// The same frame with another bridge: DBL in mm, pads carried along with the rims, and their faces
// then moved outward by pad_shift_mm (acetate: filed back; negative: built up).
FrameParameters WithBridge(FrameParameters parameters, double dbl_mm, double pad_shift_mm);

}  // namespace lorgnette
