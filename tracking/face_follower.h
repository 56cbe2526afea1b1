// SPDX-License-Identifier: Apache-2.0
// Landmarks frame after frame: one detection, then regions driven by the landmarks of the frame
// before; a cut in the film or a lost face leads to a new detection in the same frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"
#include "tracking/canonical_mesh.h"
#include "tracking/crop_store.h"
#include "tracking/face_detector.h"
#include "tracking/face_landmarker.h"
#include "tracking/portraits.h"

namespace lorgnette {

struct FollowedFrame {
  double time_s = 0;
  bool cut_before = false;                 // the film was cut between the frame before and this one
  std::optional<FaceLandmarks> landmarks;  // none: no face
  std::optional<FaceLandmarks> steady;     // of many looks, in a few frames (LookAgain)
  StoredCrop crop;                         // empty without landmarks
  StoredCrop right_eye, left_eye;          // finer, of the lids and little more
};

class FaceFollower {
 public:
  // model_dir: face_detection.onnx and face_landmark.onnx.
  static Result<FaceFollower> Load(const std::string& model_dir, const CanonicalMesh& canonical);

  // The next frame, its pictures apart.
  FollowedFrame Next(const ImageRgb8& frame, double time_s);
  // The pictures of frame `number`, for `found`, which Next() returned for it; frames in their
  // order. May run beside the Next() of the frame after.
  void KeepPictures(std::size_t number, const ImageRgb8& frame, FollowedFrame& found);

  // After the last frame: gives the most frontal of `frames`, all that Next() returned, their
  // steady landmarks.
  void LookAgain(std::vector<FollowedFrame>& frames);

 private:
  FaceFollower(FaceDetector detector, FaceLandmarker landmarker, CanonicalMesh canonical);
  bool IsCut(const ImageRgb8& frame);

  // Of KeepPictures() alone.
  CanonicalMesh canonical_;
  Portraits portraits_;
  std::shared_ptr<CropStore> crops_ = std::make_shared<CropStore>();

  // Of Next() alone.
  FaceDetector detector_;
  FaceLandmarker landmarker_;
  std::size_t frame_ = 0;  // number of the next frame
  std::optional<FaceRegion> region_;
  int since_mirror_ = 0;              // frames since the network last saw the mirror image
  Image<std::uint8_t, 1> thumbnail_;  // of the frame before
  double usual_change_ = 0;           // running mean of the thumbnails' change
};

}  // namespace lorgnette
