// SPDX-License-Identifier: Apache-2.0
// A sensible focal length before anything is known of the camera.
#pragma once

#include <vector>

#include "tracking/face_landmarker.h"

namespace lorgnette {

// Two habits of film-makers, each with its spread, multiplied: pictures are about 62 degrees wide
// along their longer side (a factor of 1.57 either way), and faces are about 550 mm from the camera
// (1.35 either way). The second counts more, since clips are often cropped from larger pictures.
//   landmarks  one a frame, null where there is no face; at least one face
// Returns the focal length in px. Tested: a picture whose two habits agree gets exactly that; twice
// the face gives a longer focal length, by less than two.
double TypicalFocal(int width, int height, double pd_mm,
                    const std::vector<const FaceLandmarks*>& landmarks);

inline constexpr double kTypicalFieldDeg = 62;
inline constexpr double kTypicalDistanceMm = 550;

}  // namespace lorgnette
