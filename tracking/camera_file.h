// SPDX-License-Identifier: Apache-2.0
// A calibrated camera, and its file (JSON, docs/tracking.md).
#pragma once

#include <string>

#include "base/camera.h"
#include "base/result.h"
#include "tracking/lens_distortion.h"

namespace lorgnette {

struct CalibratedCamera {
  Camera camera;
  LensDistortion distortion;
  // How good it is; 0: not known.
  double rms_px = 0;          // between the chessboard's corners and where they were found
  double focal_sigma_px = 0;  // standard error of fx
  int views = 0;              // pictures of the chessboard in use
};

Result<CalibratedCamera> ParseCameraFile(const std::string& text, const std::string& name);
Result<CalibratedCamera> ReadCameraFile(const std::string& path);
Status WriteCameraFile(const CalibratedCamera& camera, const std::string& path);

// The same camera for pictures of another size and the same shape (a film taken at a lower
// resolution); fails, naming `name`, where the shapes differ by more than half a per cent.
Result<CalibratedCamera> ScaledTo(const CalibratedCamera& camera, int width, int height,
                                  const std::string& name);

}  // namespace lorgnette
