// SPDX-License-Identifier: Apache-2.0
#include "tracking/texture_anchors.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lorgnette {
namespace {

constexpr double kSpacing = 8;  // crop px between candidate anchors
constexpr double kMinRigidWeight = 0.45;
constexpr double kMinFacing = 0.35;  // cosine between normal and line of sight
constexpr std::size_t kMostAnchors = 110;
constexpr std::size_t kFewest = 12;  // sightings that make a match
constexpr double kMinCorrelation = 0.7;
// Reach of the search and scale of the robust pose fit, crop px, coarse and fine level.
constexpr double kReach[] = {5, 12};
constexpr double kPoseScale[] = {0.5, 2};

// Position in a level of the crop.
Eigen::Vector2d ToLevel(const FaceRegion& region, const Image<float, 1>& level,
                        const Eigen::Vector2d& pixel) {
  return double(level.width) * region.FromImage(pixel);
}

// How a small step along the surface (two tangents) moves the point in the level.
Eigen::Matrix2d LevelFromTangents(const Camera& camera, const Eigen::Isometry3d& camera_from_head,
                                  const FaceRegion& region, int level_width,
                                  const TextureAnchor& anchor,
                                  const Eigen::Matrix<double, 3, 2>& t) {
  const Eigen::Vector3d p = camera_from_head * anchor.head;
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()),  //
      0, camera.fy / p.z(), -camera.fy * p.y() / (p.z() * p.z());
  const Eigen::Rotation2Dd upright(-region.angle);
  return (level_width / region.side) * upright.toRotationMatrix() * by_point *
         camera_from_head.linear() * t;
}

Eigen::Matrix<double, 3, 2> Tangents(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> t;
  t.col(0) = normal.unitOrthogonal();
  t.col(1) = normal.cross(t.col(0));
  return t;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// The mesh as the reference camera sees it.
struct ProjectedFace {
  const TriangleMesh& face;
  std::vector<Eigen::Vector3d> camera_points;
  std::vector<Eigen::Vector2d> pixels;

  struct Hit {
    Eigen::Vector3i triangle;
    Eigen::Vector3d weights;  // barycentric, in space
  };
  // The nearest front side under `pixel`.
  std::optional<Hit> At(const Eigen::Vector2d& pixel) const {
    std::optional<Hit> best;
    double nearest = 1e300;
    for (const Eigen::Vector3i& t : face.triangles) {
      const Eigen::Vector2d& a = pixels[std::size_t(t[0])];
      const Eigen::Vector2d& b = pixels[std::size_t(t[1])];
      const Eigen::Vector2d& c = pixels[std::size_t(t[2])];
      // Counter-clockwise from outside is clockwise, that is negative, with y down.
      const double area = Cross(b - a, c - a);
      if (!(area < 0)) continue;
      Eigen::Vector3d w(Cross(b - pixel, c - pixel), Cross(c - pixel, a - pixel),
                        Cross(a - pixel, b - pixel));
      w /= area;
      if (w.minCoeff() < 0) continue;
      for (int k = 0; k < 3; ++k) w[k] /= camera_points[std::size_t(t[k])].z();
      const double depth = 1 / w.sum();
      if (depth >= nearest) continue;
      nearest = depth;
      best = Hit{t, w * depth};
    }
    return best;
  }
};

}  // namespace

AnchorView MakeAnchorView(std::size_t frame, const FaceCrop& crop, const TexturePyramid& texture,
                          const Camera& camera, const Eigen::Isometry3d& camera_from_head,
                          const TriangleMesh& face, const std::vector<double>& rigid_weight) {
  AnchorView view;
  view.frame = frame;
  view.region = crop.region;
  view.camera_from_head = camera_from_head;
  ProjectedFace projected{face, {}, {}};
  for (const Eigen::Vector3d& p : face.positions) {
    projected.camera_points.push_back(camera_from_head * p);
    projected.pixels.push_back(camera.Project(projected.camera_points.back()));
  }
  const Eigen::Vector3d eye = camera_from_head.inverse().translation();
  const int width = crop.grey.width;
  for (double y = kSpacing; y < width; y += kSpacing) {
    for (double x = kSpacing; x < width; x += kSpacing) {
      const Eigen::Vector2d pixel = crop.region.ToImage(Eigen::Vector2d(x, y) / width);
      const auto hit = projected.At(pixel);
      if (!hit) continue;
      TextureAnchor anchor;
      anchor.head.setZero();
      anchor.normal.setZero();
      double rigid = 0;
      for (int k = 0; k < 3; ++k) {
        const auto v = std::size_t(hit->triangle[k]);
        anchor.head += hit->weights[k] * face.positions[v];
        anchor.normal += hit->weights[k] * face.normals[v];
        rigid += hit->weights[k] * rigid_weight[v];
      }
      anchor.mesh = anchor.head;
      anchor.normal.normalize();
      anchor.ray = (anchor.head - eye).normalized();
      if (rigid < kMinRigidWeight || -anchor.ray.dot(anchor.normal) < kMinFacing) continue;
      for (std::size_t level = 0; level < anchor.patches.size(); ++level) {
        const Image<float, 1>& picture = texture.levels[level];
        anchor.patches[level] = PatchTemplate::Cut(picture, ToLevel(crop.region, picture, pixel));
      }
      if (anchor.patches[0]) view.anchors.push_back(std::move(anchor));
    }
  }
  std::sort(view.anchors.begin(), view.anchors.end(),
            [](const TextureAnchor& a, const TextureAnchor& b) {
              return a.patches[0]->strength() > b.patches[0]->strength();
            });
  if (view.anchors.size() > kMostAnchors) view.anchors.resize(kMostAnchors);
  return view;
}

std::optional<AnchorMatch> MatchAnchors(const AnchorView& view, const FaceCrop& crop,
                                        const TexturePyramid& texture, const Camera& camera,
                                        const Eigen::Isometry3d& guess, PoseGuess quality) {
  AnchorMatch match;
  match.pose.camera_from_head = guess;
  for (std::size_t level = quality == PoseGuess::kRough ? 2 : 1; level-- > 0;) {
    const Image<float, 1>& picture = texture.levels[level];
    const double image_px = crop.region.side / picture.width;  // a level's pixel in image pixels
    const Eigen::Isometry3d pose = match.pose.camera_from_head;
    const Eigen::Vector3d eye = pose.inverse().translation();
    match.sightings.clear();
    std::vector<PointSighting> points;
    for (std::size_t a = 0; a < view.anchors.size(); ++a) {
      const TextureAnchor& anchor = view.anchors[a];
      if (!anchor.patches[level]) continue;
      const double facing = anchor.normal.dot((eye - anchor.head).normalized());
      if (facing < kMinFacing) continue;
      const Eigen::Matrix<double, 3, 2> tangents = Tangents(anchor.normal);
      const Eigen::Matrix2d here =
          LevelFromTangents(camera, pose, crop.region, picture.width, anchor, tangents);
      const Eigen::Matrix2d there = LevelFromTangents(camera, view.camera_from_head, view.region,
                                                      picture.width, anchor, tangents);
      const Eigen::Vector2d expected =
          ToLevel(crop.region, picture, camera.Project(pose * anchor.head));
      const auto found =
          anchor.patches[level]->Find(picture, expected, here * there.inverse(), kReach[level]);
      if (!found || found->correlation < kMinCorrelation) continue;
      AnchorSighting s;
      s.anchor = a;
      s.pixel = crop.region.ToImage(found->position / picture.width);
      s.weight = (found->correlation - kMinCorrelation) / (1 - kMinCorrelation) * facing;
      match.sightings.push_back(s);
      points.push_back({anchor.head, s.pixel, s.weight});
    }
    if (match.sightings.size() < kFewest) {
      if (level > 0) continue;  // the fine level may still find them
      return std::nullopt;
    }
    match.pose = FitPose(camera, points, pose, kPoseScale[level] * image_px);
  }
  return match;
}

}  // namespace lorgnette
