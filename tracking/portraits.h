// SPDX-License-Identifier: Apache-2.0
// Pictures of the face kept while a clip goes by, for longer looks afterwards.
//
// One answer of the landmark network scatters by 0.7 degrees of yaw and pitch and 0.3 of roll when
// its square is turned, moved or sized a little differently; what it makes of left and right
// differs by a degree of roll, and that changes from frame to frame. A head space made from single
// answers is as uncertain. The mean over several squares and their mirror images is not
// (docs/tracking.md).
#pragma once

#include <cstddef>
#include <vector>

#include "base/image.h"
#include "tracking/canonical_mesh.h"
#include "tracking/face_landmarker.h"
#include "tracking/face_region.h"

namespace lorgnette {

struct Portrait {
  std::size_t frame = 0;
  double turn = 0;  // ApparentTurn of its landmarks
  FaceRegion kept;  // of the frame, that `picture` shows: more than the network's square
  ImageRgb8 picture;
};

// Angle (radians) between the way the face looks and the line of sight, as one answer of the
// network has it.
double ApparentTurn(const FaceLandmarks& landmarks, const CanonicalMesh& canonical);

// The most frontal frames, spread over the whole clip whatever its length: the most frontal of
// every stretch of time, of which there are 64 at most.
class Portraits {
 public:
  // Frames come in order; those without a face are left out.
  void Offer(std::size_t frame, const ImageRgb8& image, const FaceLandmarks& landmarks,
             const CanonicalMesh& canonical);
  // The `most` most frontal ones, in order of time.
  std::vector<const Portrait*> MostFrontal(std::size_t most) const;

 private:
  std::size_t stretch_ = 1;     // frames
  std::vector<Portrait> kept_;  // in order of time, at most one a stretch
};

// Mean of the network's answers for squares turned, moved and sized a little differently, and for
// their mirror images: 2 * looks runs of the network. `start` picks another part of the sequence of
// squares, so that portraits alike are not looked at alike. In pixels of the frame.
FaceLandmarks LookAgain(const Portrait& portrait, int looks, std::size_t start,
                        FaceLandmarker& landmarker);

}  // namespace lorgnette
