// SPDX-License-Identifier: Apache-2.0
// The known head of the shared ground truth, drawn at any pose: its mesh, coloured from the two
// path-traced stills (light baked in). A point of skin has one colour, whatever the pose.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/mesh.h"

namespace lorgnette::test {

class RenderedHead {
 public:
  static constexpr double kPdMm = 64;

  // nullopt where the folder ("../shared/data/groundtruth") is missing.
  static std::optional<RenderedHead> Read(const std::string& folder);

  // Four samples a pixel, hard edges averaged; an even background.
  ImageRgb8 Draw(const Camera& camera, const Eigen::Isometry3d& camera_from_head) const;

  // Where the ray through a pixel first meets the head, head space.
  std::optional<Eigen::Vector3d> Hit(const Camera& camera,
                                     const Eigen::Isometry3d& camera_from_head, double px,
                                     double py) const;

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Source {  // one still, seen as it is or in the mirror x = 0
    ImageRgb8 picture;
    Camera camera;
    Eigen::Isometry3d camera_from_head;
    double mirror = 1;
    std::vector<float> depth;  // of the head in the still, by pixel
  };
  Eigen::Vector3d ColourAt(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const;

  TriangleMesh mesh_;
  std::vector<Source> sources_;
};

}  // namespace lorgnette::test
