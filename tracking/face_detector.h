// SPDX-License-Identifier: Apache-2.0
// Finds a face in a whole image: the short-range detector of MediaPipe (128 x 128, 896 anchors).
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "tracking/face_region.h"

namespace lorgnette {

struct FaceDetection {
  double score = 0;                     // 0..1
  Eigen::Vector2d low, high;            // box, px
  std::array<Eigen::Vector2d, 6> keys;  // right eye, left eye, nose, mouth, right ear, left ear

  FaceRegion Region() const;  // for the landmark network
};

inline constexpr int kDetectorPixels = 128;
inline constexpr int kAnchors = 896;

// Centres of the anchors in [0, 1]^2: 2 a cell on the 16 x 16 grid, then 6 a cell on the 8 x 8
// grid.
std::vector<Eigen::Vector2d> DetectorAnchors();

// Turns the network's outputs into detections in the network's input pixels, best first, at least
// `min_score`. boxes: 896 x 16 (centre, size, 6 key points, all in input pixels from the anchor);
// scores: 896 logits. Overlapping ones are merged by a mean weighted by score (Bazarevsky et al.
// 2019, BlazeFace).
std::vector<FaceDetection> DecodeDetections(const float* boxes, const float* scores,
                                            double min_score);

class FaceDetector {
 public:
  static Result<FaceDetector> Load(const std::string& onnx_path);
  FaceDetector(FaceDetector&&) noexcept;
  ~FaceDetector();

  // The largest face; nullopt when there is none. A wide image is searched as a whole first, then
  // in overlapping squares, in which small faces are twice as large.
  std::optional<FaceDetection> Find(const ImageRgb8& frame);

 private:
  struct Network;
  explicit FaceDetector(std::unique_ptr<Network> network);
  std::vector<FaceDetection> FindIn(const ImageRgb8& frame, const FaceRegion& square);
  std::unique_ptr<Network> network_;
};

}  // namespace lorgnette
