// SPDX-License-Identifier: Apache-2.0
#include "tracking/portraits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracking/face_model.h"

namespace lorgnette {
namespace {

constexpr std::size_t kMostStretches = 64;
constexpr int kPicturePixels = 256;
// How far the squares differ: radians, share of the side, share of the side.
constexpr double kTurn = 0.08, kSize = 0.08, kShift = 0.03;
// Room for all of them about the network's own square.
constexpr double kRoom = (1 + kSize) * (1 + kTurn) + 2 * kShift;

// Points of an even sequence in [-1, 1]^4 (Roberts 2018: powers of the root of x^5 = x + 1).
std::array<double, 4> EvenPoint(std::size_t i) {
  constexpr double kRoot = 1.1673039782614187;
  std::array<double, 4> point{};
  double step = 1;
  for (double& p : point) {
    step /= kRoot;
    p = 2 * std::fmod(0.5 + step * double(i + 1), 1.0) - 1;
  }
  return point;
}

}  // namespace

double ApparentTurn(const FaceLandmarks& landmarks, const CanonicalMesh& canonical) {
  std::vector<Eigen::Vector3d> seen;  // in head axes
  seen.reserve(landmarks.points.size());
  for (const Eigen::Vector3d& p : landmarks.points) seen.emplace_back(p.x(), -p.y(), -p.z());
  const Eigen::Matrix3d turn = BestRotation(canonical.mesh.positions, seen, canonical.rigid_weight);
  return std::acos(std::clamp(turn(2, 2), -1.0, 1.0));
}

void Portraits::Offer(std::size_t frame, const ImageRgb8& image, const FaceLandmarks& landmarks,
                      const CanonicalMesh& canonical) {
  const double turn = ApparentTurn(landmarks, canonical);
  const auto stretch = [this](const Portrait& p) { return p.frame / stretch_; };
  const bool same = !kept_.empty() && stretch(kept_.back()) == frame / stretch_;
  if (same && kept_.back().turn <= turn) return;
  if (same) kept_.pop_back();
  Portrait portrait{frame, turn, landmarks.Region(), {}};
  portrait.kept.side *= kRoom;
  portrait.picture = SampleRegion(image, portrait.kept, kPicturePixels);
  kept_.push_back(std::move(portrait));
  if (kept_.size() <= kMostStretches) return;
  stretch_ *= 2;
  std::vector<Portrait> fewer;
  for (Portrait& p : kept_) {
    if (fewer.empty() || stretch(fewer.back()) != stretch(p)) {
      fewer.push_back(std::move(p));
    } else if (p.turn < fewer.back().turn) {
      fewer.back() = std::move(p);
    }
  }
  kept_ = std::move(fewer);
}

std::vector<const Portrait*> Portraits::MostFrontal(std::size_t most) const {
  std::vector<const Portrait*> chosen;
  for (const Portrait& p : kept_) chosen.push_back(&p);
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const Portrait* a, const Portrait* b) { return a->turn < b->turn; });
  if (chosen.size() > most) chosen.resize(most);
  std::sort(chosen.begin(), chosen.end(),
            [](const Portrait* a, const Portrait* b) { return a->frame < b->frame; });
  return chosen;
}

FaceLandmarks LookAgain(const Portrait& portrait, int looks, std::size_t start,
                        FaceLandmarker& landmarker) {
  const double pixels = portrait.picture.width;
  FaceLandmarks mean;
  for (int look = 0; look < looks; ++look) {
    const auto [turn, size, right, down] = EvenPoint(start + std::size_t(look));
    FaceRegion square;  // in the picture, which is upright as the network's own square
    square.side = pixels / kRoom * (1 + kSize * size);
    square.centre =
        pixels * Eigen::Vector2d(0.5, 0.5) + kShift * square.side * Eigen::Vector2d(right, down);
    square.angle = kTurn * turn;
    landmarker.Forget();
    const FaceLandmarks seen = landmarker.FindSymmetric(portrait.picture, square);
    mean.face_probability += seen.face_probability / looks;
    mean.points.resize(seen.points.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < seen.points.size(); ++i) mean.points[i] += seen.points[i] / looks;
  }
  landmarker.Forget();
  for (Eigen::Vector3d& p : mean.points) {
    p.head<2>() = portrait.kept.ToImage(p.head<2>() / pixels);
    p.z() *= portrait.kept.side / pixels;
  }
  return mean;
}

}  // namespace lorgnette
