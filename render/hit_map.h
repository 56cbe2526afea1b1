// SPDX-License-Identifier: Apache-2.0
// What the ray through each pixel's centre meets, exactly, for comparison with other renderers.
#pragma once

#include "base/camera.h"
#include "base/image.h"
#include "render/head_scene.h"

namespace lorgnette {

// As Compositor::HitMap: the point met in head space, mm, and a HitCode in the fourth channel.
ImageRgbaF TraceHitMap(const HeadScene& head, const Camera& camera,
                       const Eigen::Isometry3d& camera_from_head);

}  // namespace lorgnette
