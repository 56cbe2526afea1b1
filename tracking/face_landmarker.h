// SPDX-License-Identifier: Apache-2.0
// The landmark network: 468 points in a region of the image, and whether a face is there at all.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "tracking/face_region.h"

namespace lorgnette {

struct FaceLandmarks {
  // Image position in px, and depth relative to the face in px of the same scale, away from the
  // camera positive. 468 of them.
  std::vector<Eigen::Vector3d> points;
  double face_probability = 0;

  FaceRegion Region() const;  // for the next look
};

class FaceLandmarker {
 public:
  // `mirror`: partner of each vertex, from the canonical mesh.
  static Result<FaceLandmarker> Load(const std::string& onnx_path, std::vector<int> mirror);
  FaceLandmarker(FaceLandmarker&&) noexcept;
  ~FaceLandmarker();

  FaceLandmarks Find(const ImageRgb8& frame, const FaceRegion& region);
  // The mean of the network's answers for the region and for its mirror image, so that left and
  // right err alike. Twice the time. Keeps what the mirror changed, as a running mean over the
  // calls since Forget().
  FaceLandmarks FindSymmetric(const ImageRgb8& frame, const FaceRegion& region);
  // The network's answer with the kept change added: the same face, a few frames later.
  FaceLandmarks FindCorrected(const ImageRgb8& frame, const FaceRegion& region);
  void Forget();

 private:
  struct Network;
  explicit FaceLandmarker(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace lorgnette
