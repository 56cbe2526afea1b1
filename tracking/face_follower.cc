// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_follower.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/check.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr double kMinFaceProbability = 0.5;
// The mirror image, by which left and right are made to err alike, is looked at in every so many
// frames; between them its effect is carried on.
constexpr int kMirrorEvery = 4;
constexpr int kLooksAfterDetection = 2;  // to settle the region before the first landmarks
constexpr int kThumbnailWidth = 48, kThumbnailHeight = 36;
// A cut changes the thumbnail by more than this (grey levels), and far more than usual.
constexpr double kCutLevel = 18, kCutOverUsual = 5;
constexpr int kCropPixels = 256;
constexpr double kCropSide = 1.2 / 1.5;  // of the landmark region's side: the face and little more

constexpr int kEyePixels = 96;
constexpr double kEyeSide = 1.6;  // of the distance between the lids' corners

// Longer looks: frames, looks at all of them together (two runs of the network each), and the most
// at one.
constexpr std::size_t kPortraits = 24;
constexpr int kLooks = 72, kMostLooks = 12;

constexpr double kSmallestSide = 12;  // px; nothing can be told from less

bool Usable(const FaceRegion& region) {
  return region.centre.allFinite() && std::isfinite(region.angle) && region.side > kSmallestSide &&
         region.side < 1e5;
}

Image<std::uint8_t, 1> GreyOf(const ImageRgb8& rgb) {
  Image<std::uint8_t, 1> grey(rgb.width, rgb.height);
  cv::Mat target = MatOf(grey);
  cv::cvtColor(MatOf(rgb), target, cv::COLOR_RGB2GRAY);
  return grey;
}

FaceCrop EyeCrop(const ImageRgb8& frame, const FaceLandmarks& face, const EyeLandmarks& eye,
                 double angle) {
  const auto at = [&](int i) -> Eigen::Vector2d { return face.points[std::size_t(i)].head<2>(); };
  // A turned eye looks narrow, its iris is as high as ever.
  const double width =
      (face.points[std::size_t(eye.inner)] - face.points[std::size_t(eye.outer)]).norm();
  FaceCrop crop;
  crop.region = {(at(eye.outer) + at(eye.inner)) / 2, kEyeSide * width, angle};
  if (Usable(crop.region)) crop.grey = SampleGrey(frame, crop.region, kEyePixels);
  return crop;
}

}  // namespace

FaceFollower::FaceFollower(FaceDetector detector, FaceLandmarker landmarker,
                           CanonicalMesh canonical)
    : canonical_(std::move(canonical)),
      detector_(std::move(detector)),
      landmarker_(std::move(landmarker)) {}

Result<FaceFollower> FaceFollower::Load(const std::string& model_dir,
                                        const CanonicalMesh& canonical) {
  LG_ASSIGN(FaceDetector detector, FaceDetector::Load(model_dir + "/face_detection.onnx"));
  LG_ASSIGN(FaceLandmarker landmarker,
            FaceLandmarker::Load(model_dir + "/face_landmark.onnx", canonical.mirror));
  return FaceFollower(std::move(detector), std::move(landmarker), canonical);
}

bool FaceFollower::IsCut(const ImageRgb8& frame) {
  ImageRgb8 small(kThumbnailWidth, kThumbnailHeight);
  cv::Mat target = MatOf(small);
  // Every fourth row tells enough.
  const cv::Mat all = MatOf(frame);
  const int skip = frame.height >= 4 * kThumbnailHeight ? 4 : 1;
  const cv::Mat rows(frame.height / skip, frame.width, CV_8UC3, all.data,
                     all.step * std::size_t(skip));
  cv::resize(rows, target, target.size(), 0, 0, cv::INTER_AREA);
  Image<std::uint8_t, 1> thumbnail = GreyOf(small);
  const bool first = thumbnail_.empty();
  std::swap(thumbnail, thumbnail_);
  if (first) return false;
  const double pixels = double(thumbnail_.data.size());
  const double change = cv::norm(MatOf(thumbnail_), MatOf(thumbnail), cv::NORM_L1) / pixels;
  const bool cut = change > kCutLevel && change > kCutOverUsual * usual_change_;
  if (!cut) usual_change_ = 0.8 * usual_change_ + 0.2 * change;
  return cut;
}

FollowedFrame FaceFollower::Next(const ImageRgb8& frame, double time_s) {
  FollowedFrame out;
  ++frame_;
  out.time_s = time_s;
  out.cut_before = IsCut(frame);
  if (out.cut_before) region_.reset();
  // A region from the frame before may have lost its face: then the whole frame is searched.
  for (const bool followed : {true, false}) {
    if (followed && !region_) continue;
    if (!followed) {
      const std::optional<FaceDetection> face = detector_.Find(frame);
      if (!face) break;
      region_ = face->Region();
      for (int look = 0; look < kLooksAfterDetection && Usable(*region_); ++look) {
        region_ = landmarker_.Find(frame, *region_).Region();
      }
    }
    if (!Usable(*region_)) continue;
    const bool mirror = !followed || ++since_mirror_ >= kMirrorEvery;
    if (!followed) landmarker_.Forget();
    if (mirror) since_mirror_ = 0;
    FaceLandmarks found = mirror ? landmarker_.FindSymmetric(frame, *region_)
                                 : landmarker_.FindCorrected(frame, *region_);
    if (found.face_probability < kMinFaceProbability || !Usable(found.Region())) continue;
    region_ = found.Region();
    out.landmarks = std::move(found);
    return out;
  }
  region_.reset();
  return out;
}

void FaceFollower::KeepPictures(std::size_t number, const ImageRgb8& frame, FollowedFrame& found) {
  if (!found.landmarks) return;
  const FaceRegion region = found.landmarks->Region();
  FaceRegion around = region;
  around.side *= kCropSide;
  found.crop = {{around, SampleGrey(frame, around, kCropPixels)}, crops_};
  found.right_eye = {EyeCrop(frame, *found.landmarks, kRightEye, region.angle), crops_};
  found.left_eye = {EyeCrop(frame, *found.landmarks, kLeftEye, region.angle), crops_};
  portraits_.Offer(number, frame, *found.landmarks, canonical_);
}

void FaceFollower::LookAgain(std::vector<FollowedFrame>& frames) {
  LG_CHECK_EQ(frames.size(), frame_);
  std::size_t start = 0;
  const std::vector<const Portrait*> chosen = portraits_.MostFrontal(kPortraits);
  const int looks = chosen.empty() ? 0 : std::min(kMostLooks, kLooks / int(chosen.size()));
  for (const Portrait* portrait : chosen) {
    frames[portrait->frame].steady = lorgnette::LookAgain(*portrait, looks, start, landmarker_);
    start += std::size_t(looks);
  }
}

}  // namespace lorgnette
