// SPDX-License-Identifier: Apache-2.0
#include "tracking/face_landmarker.h"

#include <tbb/parallel_invoke.h>

#include <cmath>

#include "tracking/canonical_mesh.h"
#include "tracking/network.h"
#include "tracking/opencv_view.h"

namespace lorgnette {
namespace {

constexpr int kInputPixels = 192;
constexpr double kRenewal = 0.5;  // of the kept change, by each new one

}  // namespace

struct FaceLandmarker::Network {
  OnnxNetwork onnx, mirrored;  // the same twice: a picture and its mirror image at once
  std::vector<int> mirror;
  std::vector<Eigen::Vector3d> change;  // by the mirror, pixels of the input; empty: not known

  // Points in pixels of the input.
  static FaceLandmarks Run(OnnxNetwork& network, const cv::Mat& input) {
    const std::vector<cv::Mat> out = network.Run(input, 1.0 / 255, 0);
    const float* v = out[0].ptr<float>();
    FaceLandmarks found;
    found.points.reserve(kLandmarks);
    for (int i = 0; i < kLandmarks; ++i, v += 3) found.points.emplace_back(v[0], v[1], v[2]);
    found.face_probability = 1 / (1 + std::exp(-double(*out[1].ptr<float>())));
    return found;
  }
};

FaceLandmarker::FaceLandmarker(std::unique_ptr<Network> network) : network_(std::move(network)) {}
FaceLandmarker::FaceLandmarker(FaceLandmarker&&) noexcept = default;
FaceLandmarker::~FaceLandmarker() = default;

Result<FaceLandmarker> FaceLandmarker::Load(const std::string& onnx_path, std::vector<int> mirror) {
  const auto load = [&] { return OnnxNetwork::Load(onnx_path, kInputPixels, {3 * kLandmarks, 1}); };
  LG_ASSIGN(OnnxNetwork onnx, load());
  LG_ASSIGN(OnnxNetwork mirrored, load());
  return FaceLandmarker(std::make_unique<Network>(
      Network{std::move(onnx), std::move(mirrored), std::move(mirror), {}}));
}

namespace {

void MoveToImage(const FaceRegion& region, FaceLandmarks& landmarks) {
  for (Eigen::Vector3d& p : landmarks.points) {
    p.head<2>() = region.ToImage(p.head<2>() / kInputPixels);
    p.z() *= region.side / kInputPixels;
  }
}

}  // namespace

FaceLandmarks FaceLandmarker::Find(const ImageRgb8& frame, const FaceRegion& region) {
  const ImageRgb8 input = SampleRegion(frame, region, kInputPixels);
  FaceLandmarks found = Network::Run(network_->onnx, MatOf(input));
  MoveToImage(region, found);
  return found;
}

FaceLandmarks FaceLandmarker::FindSymmetric(const ImageRgb8& frame, const FaceRegion& region) {
  const ImageRgb8 input = SampleRegion(frame, region, kInputPixels);
  FaceLandmarks found, mirrored;
  tbb::parallel_invoke([&] { found = Network::Run(network_->onnx, MatOf(input)); },
                       [&] {
                         cv::Mat flipped;
                         cv::flip(MatOf(input), flipped, 1);
                         mirrored = Network::Run(network_->mirrored, flipped);
                       });
  std::vector<Eigen::Vector3d>& change = network_->change;
  const bool first = change.empty();
  change.resize(found.points.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < found.points.size(); ++i) {
    Eigen::Vector3d other = mirrored.points[std::size_t(network_->mirror[i])];
    other.x() = kInputPixels - other.x();
    const Eigen::Vector3d half = (other - found.points[i]) / 2;
    change[i] += (first ? 1 : kRenewal) * (half - change[i]);
    found.points[i] += half;
  }
  found.face_probability = (found.face_probability + mirrored.face_probability) / 2;
  MoveToImage(region, found);
  return found;
}

FaceLandmarks FaceLandmarker::FindCorrected(const ImageRgb8& frame, const FaceRegion& region) {
  const ImageRgb8 input = SampleRegion(frame, region, kInputPixels);
  FaceLandmarks found = Network::Run(network_->onnx, MatOf(input));
  for (std::size_t i = 0; i < network_->change.size(); ++i) found.points[i] += network_->change[i];
  MoveToImage(region, found);
  return found;
}

void FaceLandmarker::Forget() { network_->change.clear(); }

FaceRegion FaceLandmarks::Region() const {
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Eigen::Vector3d& p : points) flat.emplace_back(p.head<2>());
  return RegionAround(flat, flat[std::size_t(kRightEye.outer)], flat[std::size_t(kLeftEye.outer)]);
}

}  // namespace lorgnette
