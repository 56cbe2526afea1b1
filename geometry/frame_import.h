// SPDX-License-Identifier: Apache-2.0
// A frame from a model that nobody prepared: finds which way is up and front, the scale, the rims,
// temples, pads and demo lenses, and measures what an optician would.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "geometry/frame_model.h"
#include "geometry/model_file.h"

namespace lorgnette {

// The model's axes are taken to be parallel to the glasses' own, in any order and sign. Left and
// right: the axis of mirror symmetry. Front: the axis along which two openings are seen, on the
// side away from the temples. Up: away from the way the temples bend. Scale: unit_mm, else the
// file's own, else the one of mm, cm, m and inch that makes the frame 118 to 165 mm wide, else 140
// mm; a guess is told in FrameModel::notes. Demo lenses (transparent, so named, or shaped like one)
// are taken out. The front is turned upright, and the temples' slope becomes the pantoscopic tilt.
// Fails where there are no two closed rims, and says what was seen instead.
Result<FrameModel> ImportFrame(const ModelFile& model, const std::string& name,
                               std::optional<double> unit_mm = std::nullopt);

}  // namespace lorgnette
