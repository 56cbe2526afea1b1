// SPDX-License-Identifier: Apache-2.0
// Measured or computed surfaces as labs exchange them: the SDF grid of sags.
//
//   SURFMT=1;R;B;rows;cols;width_mm;height_mm;0
//   ZZ=z;z;z;...            one line a row, sags in mm
//
// R or L is the eye, B or F the face. Nodes lie width / (cols - 1) apart, the grid is centred on
// the vertex. Which row comes first varies by vendor, and so does the sign of the sag. A file may
// hold several surfaces; other lines are ignored. Source: docs/optics.md, "Measured surfaces".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "optics/front_form.h"
#include "optics/surface.h"

namespace lorgnette {

enum class SdfFace { kFront, kBack };
struct SdfOptions {
  bool first_row_is_top = true;
  bool columns_run_to_viewers_right = true;  // seen by somebody who faces the wearer
  bool sag_toward_eye = true;                // positive sags lie toward the eye, as ours do
};
struct SdfSurface {
  Eye eye = Eye::kRight;
  SdfFace face = SdfFace::kBack;
  Surface surface;  // a C2 spline through the sags, which are moved to 0 at the vertex
  int rows = 0, cols = 0;
  double width_mm = 0, height_mm = 0;
};
Result<std::vector<SdfSurface>> ParseSdf(const std::string& text, const std::string& name,
                                         const SdfOptions& options = {});

// Sags of any surface over a grid, as such a file; fails where the surface ends inside the grid.
Result<std::string> WriteSdf(const Surface& surface, Eye eye, SdfFace face, int rows, int cols,
                             double width_mm, double height_mm, const SdfOptions& options = {});

inline constexpr int kMaxSdfNodes = 401;  // each way

}  // namespace lorgnette
