// SPDX-License-Identifier: Apache-2.0
#include "page_face.h"

#include <algorithm>
#include <cmath>

namespace lorgnette::page {
namespace {

// After a scanned mean head, in round figures and before the plane of the irises: bridge of the
// nose 13 mm, its flank 8 mm aside 8, its tip 33, the brows' ridge 9, the cheeks below the eyes 2;
// the temples fall back from 44 mm off the middle on.
constexpr double kFlat = 44, kRecede = 0.04;
constexpr double kBridge = 13, kTip = 20, kNoseTop = 4, kNoseLength = 30;
constexpr double kBridgeWidth = 10.3, kTipWidth = 3;
constexpr double kBrow = 9, kBrowHeight = 23, kBrowWidth = 7;
constexpr double kCheek = 5, kCheekHeight = -33, kCheekAside = 34, kCheekWidth = 13;
constexpr double kNoseReach = 48;  // beyond it the nose is less than 1e-4 mm

// A point within this of the face is on it.
constexpr double kClose_mm = 1e-6;
constexpr int kMaxSteps = 30;

}  // namespace

FaceDepth FaceAt(double x, double y) {
  FaceDepth face;
  const double aside = std::abs(x), side = x < 0 ? -1 : 1;
  if (aside > kFlat) {
    face.depth += kRecede * (aside - kFlat) * (aside - kFlat);
    face.by_x += side * 2 * kRecede * (aside - kFlat);
  }
  if (aside < kNoseReach) {
    const double s = std::clamp((kNoseTop - y) / kNoseLength, 0.0, 1.0);
    const double rise = s * s * (3 - 2 * s), slope = -6 * s * (1 - s) / kNoseLength;
    const double high = kBridge + kTip * rise, wide = kBridgeWidth + kTipWidth * rise;
    const double u = x / wide, bump = high * std::exp(-u * u);
    face.depth -= bump;
    face.by_x += bump * 2 * u / wide;
    face.by_y -= bump * (kTip / high + 2 * u * u * kTipWidth / wide) * slope;
  }
  const double b = (y - kBrowHeight) / kBrowWidth, brow = kBrow * std::exp(-b * b);
  face.depth -= brow;
  face.by_y += brow * 2 * b / kBrowWidth;
  const double cx = (aside - kCheekAside) / kCheekWidth, cy = (y - kCheekHeight) / kCheekWidth;
  const double cheek = kCheek * std::exp(-cx * cx - cy * cy);
  face.depth -= cheek;
  face.by_x += side * cheek * 2 * cx / kCheekWidth;
  face.by_y += cheek * 2 * cy / kCheekWidth;
  return face;
}

std::optional<Eigen::Vector3d> MeetFace(const Ray& ray, double iris_z, double face_x) {
  if (!(ray.direction.z() > 0)) return std::nullopt;
  // Newton's steps from the plane of the irises; the face's slopes along a camera's rays stay well
  // below 1, so that each step squares the error.
  double along = (iris_z - ray.origin.z()) / ray.direction.z();
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Vector3d p = ray.origin + along * ray.direction;
    const FaceDepth face = FaceAt(p.x() + face_x, p.y());
    const double gap = iris_z + face.depth - p.z();
    if (std::abs(gap) < kClose_mm) return p;
    const double closing =
        ray.direction.z() - face.by_x * ray.direction.x() - face.by_y * ray.direction.y();
    along += gap / std::max(closing, 0.25);
  }
  return std::nullopt;
}

}  // namespace lorgnette::page
