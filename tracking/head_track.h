// SPDX-License-Identifier: Apache-2.0
// What tracking knows of a clip: camera, personal face mesh, and the head's pose in every frame.
//
// Head space: +x toward the wearer's left, +y up, +z out of the face, origin midway between the
// pupils, mm (scale from the prescription's PD). Camera space: OpenCV axes (base/camera.h).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "base/camera.h"
#include "base/mesh.h"
#include "base/result.h"
#include "tracking/lens_distortion.h"

namespace lorgnette {

struct TrackedFrame {
  double time_s = 0;   // presentation time
  bool found = false;  // false: no face; the frame passes through unchanged
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  // The face in this frame, head space, one point a vertex of `face` (expression included); empty
  // when the neutral mesh serves.
  std::vector<Eigen::Vector3f> vertices;
  float residual_px = 0;  // RMS distance of the landmarks from the rigid face
  // Centres of the irises, px; none when closed, turned away, or not looked for.
  std::optional<Eigen::Vector2f> iris_right, iris_left;
};

struct HeadTrack {
  Camera camera;
  // Of the real lens. Poses and pixels here are those of the pinhole picture, freed from it.
  LensDistortion distortion;
  TriangleMesh face;  // personal neutral mesh, 468 vertices of the canonical topology, head space
  double pd_mm = 64;  // the scale in use
  Eigen::Vector3d pupil_right{-32, 0, 0}, pupil_left{32, 0, 0};  // corneal apices, head space
  // The same distance if the irises are of the usual 11.7 mm, with its standard error; 0: unknown.
  // A check on pd_mm, which it does not change.
  double iris_pd_mm = 0, iris_pd_sigma_mm = 0;
  std::vector<TrackedFrame> frames;

  int frames_without_face() const;
};

// Reads and writes a track file (JSON, docs/tracking.md); `name` is for messages.
Result<HeadTrack> ParseHeadTrack(const std::string& text, const std::string& name);
Result<HeadTrack> ReadHeadTrack(const std::string& path);
Status WriteHeadTrack(const HeadTrack& track, const std::string& path);

}  // namespace lorgnette
