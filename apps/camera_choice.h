// SPDX-License-Identifier: Apache-2.0
// The calibrated camera of a video (--camera), and frames as its pinhole would see them.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "tracking/camera_file.h"

namespace lorgnette {

// The camera file, scaled to the video; nullopt for an empty path.
Result<std::optional<CalibratedCamera>> CameraForVideo(const std::string& path, int width,
                                                       int height);

// nullopt where there is nothing to put right.
std::optional<PictureRectifier> RectifierFor(const Camera& camera,
                                             const LensDistortion& distortion);

}  // namespace lorgnette
