// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_detector.h"

#include <algorithm>
#include <cmath>

#include "tracking/network.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr double kMinScore = 0.5;
constexpr double kSameFaceOverlap = 0.3;  // intersection over union
constexpr int kValuesPerAnchor = 16;
// The input is 2 v - 1 of a pixel value v in 0..1.
constexpr double kInputScale = 2.0 / 255, kInputMean = 127.5;

double Overlap(const FaceDetection& a, const FaceDetection& b) {
  const Eigen::Array2d low = a.low.array().max(b.low.array());
  const Eigen::Array2d high = a.high.array().min(b.high.array());
  const double shared = (high - low).max(0.0).prod();
  const double both = (a.high - a.low).prod() + (b.high - b.low).prod() - shared;
  return both > 0 ? shared / both : 0;
}

FaceDetection WeightedMean(const std::vector<const FaceDetection*>& group) {
  FaceDetection mean;
  mean.low.setZero();
  mean.high.setZero();
  for (Eigen::Vector2d& key : mean.keys) key.setZero();
  double total = 0;
  for (const FaceDetection* d : group) total += d->score;
  for (const FaceDetection* d : group) {
    const double w = d->score / total;
    mean.low += w * d->low;
    mean.high += w * d->high;
    for (std::size_t k = 0; k < mean.keys.size(); ++k) mean.keys[k] += w * d->keys[k];
    mean.score = std::max(mean.score, d->score);
  }
  return mean;
}

}  // namespace

FaceRegion FaceDetection::Region() const {
  FaceRegion region = RegionAround({low, high}, keys[0], keys[1]);
  region.centre = (low + high) / 2;
  region.side = 1.5 * (high - low).maxCoeff();
  return region;
}

std::vector<Eigen::Vector2d> DetectorAnchors() {
  std::vector<Eigen::Vector2d> anchors;
  anchors.reserve(kAnchors);
  const auto add_grid = [&](int cells, int per_cell) {
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        anchors.insert(anchors.end(), std::size_t(per_cell),
                       Eigen::Vector2d((x + 0.5) / cells, (y + 0.5) / cells));
      }
    }
  };
  add_grid(16, 2);
  add_grid(8, 6);
  return anchors;
}

std::vector<FaceDetection> DecodeDetections(const float* boxes, const float* scores,
                                            double min_score) {
  static const std::vector<Eigen::Vector2d> anchors = DetectorAnchors();
  std::vector<FaceDetection> found;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const double score = 1 / (1 + std::exp(-double(scores[i])));
    if (!(score >= min_score)) continue;
    const float* v = boxes + i * kValuesPerAnchor;
    const auto at = [&](int k) -> Eigen::Vector2d {
      return Eigen::Vector2d(v[k], v[k + 1]) + kDetectorPixels * anchors[i];
    };
    FaceDetection& d = found.emplace_back();
    d.score = score;
    const Eigen::Vector2d half(v[2] / 2, v[3] / 2);
    d.low = at(0) - half;
    d.high = at(0) + half;
    for (int k = 0; k < 6; ++k) d.keys[std::size_t(k)] = at(4 + 2 * k);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<FaceDetection> merged;
  std::vector<bool> used(found.size(), false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (used[i]) continue;
    std::vector<const FaceDetection*> group;
    for (std::size_t j = i; j < found.size(); ++j) {
      if (used[j] || (j != i && Overlap(found[i], found[j]) <= kSameFaceOverlap)) continue;
      used[j] = true;
      group.push_back(&found[j]);
    }
    merged.push_back(WeightedMean(group));
  }
  return merged;
}

struct FaceDetector::Network {
  OnnxNetwork onnx;
};

FaceDetector::FaceDetector(std::unique_ptr<Network> network) : network_(std::move(network)) {}
FaceDetector::FaceDetector(FaceDetector&&) noexcept = default;
FaceDetector::~FaceDetector() = default;

Result<FaceDetector> FaceDetector::Load(const std::string& onnx_path) {
  LG_ASSIGN(OnnxNetwork onnx,
            OnnxNetwork::Load(onnx_path, kDetectorPixels, {kAnchors * kValuesPerAnchor, kAnchors}));
  return FaceDetector(std::make_unique<Network>(Network{std::move(onnx)}));
}

std::vector<FaceDetection> FaceDetector::FindIn(const ImageRgb8& frame, const FaceRegion& square) {
  const ImageRgb8 input = SampleRegion(frame, square, kDetectorPixels);
  const std::vector<cv::Mat> out = network_->onnx.Run(MatOf(input), kInputScale, kInputMean);
  std::vector<FaceDetection> found =
      DecodeDetections(out[0].ptr<float>(), out[1].ptr<float>(), kMinScore);
  for (FaceDetection& d : found) {
    const auto to_image = [&](Eigen::Vector2d& p) { p = square.ToImage(p / kDetectorPixels); };
    to_image(d.low);
    to_image(d.high);
    for (Eigen::Vector2d& key : d.keys) to_image(key);
  }
  return found;
}

std::optional<FaceDetection> FaceDetector::Find(const ImageRgb8& frame) {
  const double w = frame.width, h = frame.height;
  const Eigen::Vector2d middle(w / 2, h / 2);
  const double longer = std::max(w, h), shorter = std::min(w, h);
  std::vector<FaceRegion> squares{{middle, longer, 0}};
  if (longer > 1.2 * shorter) {
    const Eigen::Vector2d along = w > h ? Eigen::Vector2d(1, 0) : Eigen::Vector2d(0, 1);
    for (const double shift : {0.0, -0.5, 0.5}) {
      squares.push_back({middle + shift * (longer - shorter) * along, shorter, 0});
    }
  }
  const auto size = [](const FaceDetection& d) { return (d.high - d.low).prod(); };
  for (const FaceRegion& square : squares) {
    const std::vector<FaceDetection> found = FindIn(frame, square);
    const auto largest = std::max_element(
        found.begin(), found.end(),
        [&](const FaceDetection& a, const FaceDetection& b) { return size(a) < size(b); });
    if (largest != found.end()) return *largest;
  }
  return std::nullopt;
}

}  // namespace lorgnette
