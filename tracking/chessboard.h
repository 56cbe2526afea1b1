// SPDX-License-Identifier: Apache-2.0
// Calibration of a camera from views of a printed chessboard.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "tracking/camera_file.h"

namespace lorgnette {

struct Chessboard {
  int columns = 9, rows = 6;  // inner corners, where four squares meet
  double square_mm = 25;      // scales only the poses, not the camera
};

using BoardCorners = std::vector<Eigen::Vector2d>;  // px, row by row

// All inner corners of the board, or nullopt where it is not wholly visible.
std::optional<BoardCorners> FindChessboard(const ImageRgb8& picture, const Chessboard& board);

// Whether two views show the board in practically the same place: the second would add weight and
// no knowledge.
bool SameView(const BoardCorners& a, const BoardCorners& b, int width);

struct Calibration {
  CalibratedCamera camera;
  std::vector<double> view_rms_px;  // of the views in use
  int views_left_out = 0;           // with an error far above that of the others
  double most_tilted_deg = 0;       // of the board against the picture plane
  double reach = 0;                 // the outermost corner, as a share of half the diagonal
  std::vector<std::string> notes;   // what would make it better
};

inline constexpr int kFewestViews = 4;

// Focal lengths, principal point, k1, k2, p1, p2, and k3 where the views tell it (three standard
// errors from zero). Fails with one sentence when the views are too few or too much alike to fix
// the focal length to 3 per cent. Source: Zhang 2000, by OpenCV's calibrateCamera.
// Tested: recovers the camera of rendered boards, distortion included.
Result<Calibration> Calibrate(const Chessboard& board, int width, int height,
                              const std::vector<BoardCorners>& views);

}  // namespace lorgnette
