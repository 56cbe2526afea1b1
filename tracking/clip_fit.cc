// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "tracking/anchored_clip.h"
#include "tracking/face_model.h"
#include "tracking/focal_prior.h"
#include "tracking/iris.h"

namespace lorgnette {
namespace {

constexpr std::size_t kFramesForFocal = 48;
constexpr double kFocalLogSigma = 0.25;  // about the typical focal length
// How far the shape may leave its prior once the anchors have told the depth (mm).
const Eigen::Vector3d kClipSigma_mm(20, 20, 1);
constexpr double kFieldSigmaMm = 15;  // over which the anchors' depths are spread on the face
constexpr double kMinFrontal = 0.4;   // z of an anchor's normal
constexpr double kMostDepthMm = 12;
constexpr double kNetworkYawSigma = 0.03;  // radians, of one reading about the common gain
constexpr double kFrontalYaw = 0.14;       // radians, over which a reading's weight falls
constexpr double kIndependentFrames = 10;
// Standard errors of the yaw zero: of the network's readings, and of the mesh's symmetry for a clip
// whose most frontal frame is turned by some angle.
constexpr double kZeroYawSigma = RadiansFromDegrees(2);
constexpr double kMeshYawSigma = RadiansFromDegrees(0.7), kMeshYawSigmaByAngle = 0.5;
// Standard errors of the distance between the pupils, from the lids' corners and, beside their
// scatter, from the irises (edges of lids and lashes; eyes that converge).
constexpr double kLidsDistanceSigmaMm = 1.5, kIrisDistanceSigmaMm = 0.5;
constexpr double kFullConfidence = 15;  // weight of inliers
constexpr double kLeastConfidence = 0.03;
constexpr double kFieldDoubt = 1;  // weight of no change, in anchors

// Yaw of the face against the line from the camera to it: what the network sees.
double ApparentYaw(const Eigen::Isometry3d& camera_from_head) {
  const Eigen::Vector3d out = camera_from_head.linear().col(2);
  const Eigen::Vector3d& at = camera_from_head.translation();
  return std::atan2(out.x(), -out.z()) - std::atan2(-at.x(), at.z());
}

// Adds the depths that the anchors found to `points`, spread smoothly over the face.
void ApplyAnchorDepths(const std::vector<AnchorView>& views, std::vector<Eigen::Vector3d>& points) {
  struct Sample {
    Eigen::Vector2d at;
    double depth;
  };
  std::vector<Sample> samples;
  for (const AnchorView& view : views) {
    for (const TextureAnchor& a : view.anchors) {
      if (a.normal.z() < kMinFrontal) continue;
      // A slip along the surface does not change it; the rest is depth.
      const double depth = (a.head - a.mesh).dot(a.normal) / a.normal.z();
      samples.push_back({a.mesh.head<2>(), std::clamp(depth, -kMostDepthMm, kMostDepthMm)});
    }
  }
  for (Eigen::Vector3d& p : points) {
    double sum = 0, total = kFieldDoubt;
    for (const Sample& s : samples) {
      const double w =
          std::exp(-0.5 * (s.at - p.head<2>()).squaredNorm() / (kFieldSigmaMm * kFieldSigmaMm));
      sum += w * s.depth;
      total += w;
    }
    p.z() += sum / total;
  }
}

// Share of the network's reading in the yaw zero; the rest is the mesh's own plane of symmetry,
// which is good in a clip that shows the face head on and worthless in one that does not.
double TrustInNetworkYaw(const std::vector<double>& network_yaw) {
  double most_frontal = kPi;
  for (const double yaw : network_yaw) most_frontal = std::min(most_frontal, std::abs(yaw));
  const double mesh_sigma = kMeshYawSigma + kMeshYawSigmaByAngle * most_frontal;
  const double mesh = mesh_sigma * mesh_sigma, network = kZeroYawSigma * kZeroYawSigma;
  return mesh / (mesh + network);
}

// The pupils between the lids, corrected by the irises: their distance, as far as it is surer than
// the lids', and their height. Where the eyes look sideways both irises move alike, so that the
// middle stays that of the lids.
Pupils WithIrises(const Pupils& lids, const IrisSummary& irises) {
  const double lids_variance = kLidsDistanceSigmaMm * kLidsDistanceSigmaMm;
  const double iris_variance = irises.distance_sigma_mm * irises.distance_sigma_mm +
                               kIrisDistanceSigmaMm * kIrisDistanceSigmaMm;
  const double trust = lids_variance / (lids_variance + iris_variance);
  const double distance = trust * irises.pupils.distance() + (1 - trust) * lids.distance();
  const Eigen::Vector3d lids_middle = (lids.right + lids.left) / 2;
  const double iris_height = (irises.pupils.right.y() + irises.pupils.left.y()) / 2;
  const double height = trust * iris_height + (1 - trust) * lids_middle.y();
  const Eigen::Vector3d middle(lids_middle.x(), height, lids_middle.z());
  const Eigen::Vector3d half(distance / 2, 0, 0);
  return {middle - half, middle + half};
}

// Poses for frames that the anchors missed: the landmark pose, corrected as in the nearest frame
// that they did not miss.
std::vector<Eigen::Isometry3d> Completed(const std::vector<const FaceLandmarks*>& landmarks,
                                         const std::vector<Eigen::Isometry3d>& landmark_poses,
                                         const std::vector<std::optional<PoseFit>>& anchored) {
  std::vector<Eigen::Isometry3d> poses = landmark_poses;
  for (std::size_t f = 0; f < poses.size(); ++f) {
    if (landmarks[f] == nullptr) continue;
    if (anchored[f]) {
      poses[f] = anchored[f]->camera_from_head;
      continue;
    }
    for (std::size_t d = 1; d < poses.size(); ++d) {
      const std::size_t before = f >= d ? f - d : f, after = f + d < poses.size() ? f + d : f;
      const std::size_t n = anchored[before] ? before : after;
      if (!anchored[n]) continue;
      poses[f] =
          Moved(landmark_poses[f], MotionBetween(landmark_poses[n], anchored[n]->camera_from_head));
      break;
    }
  }
  return poses;
}

// The landmarks that shape the face: those of many looks, where there are any.
std::vector<const FaceLandmarks*> ShapingLandmarks(const std::vector<FollowedFrame>& frames) {
  std::vector<const FaceLandmarks*> steady, all;
  for (const FollowedFrame& frame : frames) {
    steady.push_back(frame.steady ? &*frame.steady : nullptr);
    all.push_back(frame.landmarks ? &*frame.landmarks : nullptr);
  }
  const bool any = std::any_of(steady.begin(), steady.end(), [](auto* s) { return s != nullptr; });
  return any ? steady : all;
}

// A first face, and a pose for each frame with landmarks.
std::vector<Eigen::Vector3d> FirstFace(const Camera& camera, const CanonicalMesh& canonical,
                                       const std::vector<FollowedFrame>& frames, double pd_mm,
                                       std::vector<Eigen::Isometry3d>& poses) {
  const std::vector<const FaceLandmarks*> shaping = ShapingLandmarks(frames);
  std::vector<Eigen::Vector3d> face = FitFace(camera, canonical, shaping, pd_mm, poses);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (shaping[f] != nullptr || !frames[f].landmarks) continue;
    poses[f] = FitLandmarkPose(camera, face, canonical.rigid_weight, *frames[f].landmarks)
                   .camera_from_head;
  }
  return face;
}

// The focal length from some frames of the clip, beforehand: a face shaped under a wrong one is
// bent, and its poses with it.
Camera CameraOfClip(const std::vector<FollowedFrame>& frames, const CanonicalMesh& canonical,
                    int width, int height, double pd_mm) {
  std::vector<FollowedFrame> some;
  const std::size_t stride = 1 + (frames.size() - 1) / kFramesForFocal;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const bool spread = f % stride == 0 || frames.size() - f <= stride;
    if (frames[f].landmarks && (spread || frames[f].steady)) {
      some.push_back(frames[f]);
    }
  }
  if (some.empty()) some = frames;
  std::vector<const FaceLandmarks*> landmarks;
  for (const FollowedFrame& frame : some) {
    landmarks.push_back(frame.landmarks ? &*frame.landmarks : nullptr);
  }
  const double focal = TypicalFocal(width, height, pd_mm, landmarks);
  Camera camera{width, height, focal, focal, width / 2.0, height / 2.0};
  TriangleMesh face = canonical.mesh;
  std::vector<Eigen::Isometry3d> poses;
  face.positions = FirstFace(camera, canonical, some, pd_mm, poses);
  ComputeVertexNormals(face);
  AnchorClip({some, poses, face, canonical.rigid_weight}, kFocalLogSigma, camera);
  return camera;
}

}  // namespace

double YawOffset(const std::vector<double>& texture, const std::vector<double>& network) {
  LG_CHECK_EQ(texture.size(), network.size());
  LG_CHECK(!texture.empty());
  // network = gain * texture + shift, with a prior on the gain. Frames near zero count most: there
  // the gain matters little. Neighbouring frames err alike, so that together they count as few.
  double most_frontal = kPi;
  for (const double yaw : network) most_frontal = std::min(most_frontal, std::abs(yaw));
  std::vector<double> weights;
  double total = 0, mean_t = 0, mean_n = 0;
  for (std::size_t i = 0; i < texture.size(); ++i) {
    const double off = (std::abs(network[i]) - most_frontal) / kFrontalYaw;
    const double w = weights.emplace_back(std::exp(-0.5 * off * off));
    total += w;
    mean_t += w * texture[i];
    mean_n += w * network[i];
  }
  mean_t /= total;
  mean_n /= total;
  double tt = 0, tn = 0;
  for (std::size_t i = 0; i < texture.size(); ++i) {
    tt += weights[i] * (texture[i] - mean_t) * (texture[i] - mean_t) / total;
    tn += weights[i] * (texture[i] - mean_t) * (network[i] - mean_n) / total;
  }
  const double data = kIndependentFrames / (kNetworkYawSigma * kNetworkYawSigma);
  const double prior = 1 / (kNetworkYawGainSigma * kNetworkYawGainSigma);
  const double gain = (data * tn + prior * kNetworkYawGain) / (data * tt + prior);
  return mean_n / gain - mean_t;
}

ClipFit FitClip(const std::vector<FollowedFrame>& frames, const CanonicalMesh& canonical, int width,
                int height, double pd_mm, const std::optional<Camera>& known) {
  std::vector<const FaceLandmarks*> landmarks;
  for (const FollowedFrame& frame : frames) {
    landmarks.push_back(frame.landmarks ? &*frame.landmarks : nullptr);
  }
  ClipFit fit;
  HeadTrack& track = fit.track;
  track.pd_mm = pd_mm;
  track.camera = known ? *known : CameraOfClip(frames, canonical, width, height, pd_mm);
  track.face = canonical.mesh;

  std::vector<Eigen::Isometry3d> landmark_poses;
  std::vector<Eigen::Vector3d>& points = track.face.positions;
  points = FirstFace(track.camera, canonical, frames, pd_mm, landmark_poses);
  ComputeVertexNormals(track.face);

  const AnchoredClip anchored =
      AnchorClip({frames, landmark_poses, track.face, canonical.rigid_weight}, 0, track.camera);
  std::vector<Eigen::Isometry3d> poses = Completed(landmarks, landmark_poses, anchored.poses);

  ApplyAnchorDepths(anchored.views, points);
  const std::vector<const FaceLandmarks*> shaping = ShapingLandmarks(frames);
  points = ShapeFromLandmarks(track.camera, points, kClipSigma_mm, shaping, poses);
  const Similarity head = HeadFromPoints(points, canonical, pd_mm);
  for (Eigen::Vector3d& p : points) p = head(p);
  for (Eigen::Isometry3d& pose : poses) pose = head.Rebased(pose);

  const std::vector<Eigen::Vector3d> generic = CanonicalHead(canonical, pd_mm);
  std::vector<double> texture_yaw, network_yaw;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (shaping[f] == nullptr) continue;
    const PoseFit read =
        FitLandmarkPose(track.camera, generic, canonical.rigid_weight, *shaping[f]);
    network_yaw.push_back(ApparentYaw(read.camera_from_head));
    texture_yaw.push_back(ApparentYaw(poses[f]));
  }
  Similarity turn;
  turn.rotation =
      Eigen::AngleAxisd(-TrustInNetworkYaw(network_yaw) * YawOffset(texture_yaw, network_yaw),
                        Eigen::Vector3d::UnitY())
          .toRotationMatrix();
  for (Eigen::Vector3d& p : points) p = turn(p);
  for (Eigen::Isometry3d& pose : poses) pose = turn.Rebased(pose);
  Pupils pupils = PupilsOf(points);
  std::vector<IrisReading> irises(frames.size());
  tbb::parallel_for(std::size_t(0), frames.size(), [&](std::size_t f) {
    if (landmarks[f] == nullptr) return;
    irises[f].right =
        FindIris(frames[f].right_eye.Load(), track.camera, poses[f], pupils.right, pd_mm);
    irises[f].left =
        FindIris(frames[f].left_eye.Load(), track.camera, poses[f], pupils.left, pd_mm);
  });
  if (const auto seen = SummariseIrises(irises, track.camera, poses, pupils)) {
    track.iris_pd_mm = seen->pd_mm;
    track.iris_pd_sigma_mm = seen->pd_sigma_mm;
    pupils = WithIrises(pupils, *seen);
  }
  const Similarity size = HeadFromPupils(pupils, pd_mm);
  for (Eigen::Vector3d& p : points) p = size(p);
  for (Eigen::Isometry3d& pose : poses) pose = size.Rebased(pose);
  track.pupil_right = size(pupils.right);
  track.pupil_left = size(pupils.left);
  ComputeVertexNormals(track.face);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    TrackedFrame& out = track.frames.emplace_back();
    out.time_s = frames[f].time_s;
    out.found = landmarks[f] != nullptr;
    out.camera_from_head = poses[f];
    if (irises[f].right) out.iris_right = irises[f].right->pixel.cast<float>();
    if (irises[f].left) out.iris_left = irises[f].left->pixel.cast<float>();
  }
  for (const std::optional<PoseFit>& pose : anchored.poses) {
    const double weight = pose ? pose->inlier_weight / kFullConfidence : 0;
    fit.confidence.push_back(std::clamp(weight, kLeastConfidence, 1.0));
  }
  return fit;
}

}  // namespace lorgnette
