// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace lorgnette {
namespace {

constexpr std::size_t kRestStride = 7;  // of the vertices of temples and pads, 1 to 2 mm apart

// What lies on the skin, head space.
std::vector<Eigen::Vector3f> RestingPoints(const FrameModel& frame,
                                           const Eigen::Isometry3d& head_from_frame) {
  std::vector<Eigen::Vector3f> points;
  const auto add = [&](const Eigen::Vector3d& p) {
    points.push_back((head_from_frame * p).cast<float>());
  };
  for (const Eigen::Vector3d& p : frame.nose_contacts) add(p);
  for (const FramePart& part : frame.parts) {
    if (part.kind != FramePartKind::kTemple && part.kind != FramePartKind::kNosePad) continue;
    for (std::size_t i = 0; i < part.mesh.positions.size(); i += kRestStride) {
      add(part.mesh.positions[i]);
    }
  }
  return points;
}

}  // namespace

FaceMotion::FaceMotion(const TriangleMesh& face, const FrameModel& frame,
                       const Eigen::Isometry3d& head_from_frame) {
  const std::vector<Eigen::Vector3f> resting = RestingPoints(frame, head_from_frame);
  for (const Eigen::Vector3d& position : face.positions) {
    const Eigen::Vector3f p = position.cast<float>();
    float nearest = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector3f& q : resting) nearest = std::min(nearest, (q - p).squaredNorm());
    const double s =
        std::clamp((std::sqrt(double(nearest)) - kHeld_mm) / (kFree_mm - kHeld_mm), 0.0, 1.0);
    rest_.push_back(p);
    free_.push_back(float(s * s * (3 - 2 * s)));
  }
}

std::vector<Eigen::Vector3f> FaceMotion::Held(const std::vector<Eigen::Vector3f>& vertices) const {
  LG_CHECK_EQ(vertices.size(), rest_.size());
  std::vector<Eigen::Vector3f> held(vertices.size());
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i] = rest_[i] + free_[i] * (vertices[i] - rest_[i]);
  }
  return held;
}

}  // namespace lorgnette
