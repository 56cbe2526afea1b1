// SPDX-License-Identifier: Apache-2.0
#include "apps/camera_choice.h"

namespace lorgnette {

Result<std::optional<CalibratedCamera>> CameraForVideo(const std::string& path, int width,
                                                       int height) {
  if (path.empty()) return std::optional<CalibratedCamera>();
  LG_ASSIGN(const CalibratedCamera camera, ReadCameraFile(path));
  LG_ASSIGN(const CalibratedCamera scaled, ScaledTo(camera, width, height, path));
  return std::optional(scaled);
}

std::optional<PictureRectifier> RectifierFor(const Camera& camera,
                                             const LensDistortion& distortion) {
  if (distortion.IsNone()) return std::nullopt;
  return PictureRectifier(camera, distortion);
}

}  // namespace lorgnette
