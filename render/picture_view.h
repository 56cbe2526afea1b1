// SPDX-License-Identifier: Apache-2.0
// The input image as the colour of what rays meet: face and background read where the camera saw
// them, and plausible colours where it did not.
#pragma once

#include <Eigen/Geometry>
#include <mutex>
#include <vector>

#include "base/camera.h"
#include "base/image.h"
#include "base/mesh.h"
#include "render/embree_scene.h"
#include "render/input_picture.h"

namespace lorgnette {

// Value at a pixel position (centres at .5) of a picture whose pixels are box means: a cubic
// through point values, which come from the means by the first terms of the inverse of the box.
// Clamped at the border and at 0. Magnified eyes stay crisp.
Eigen::Vector3f SampleSharp(const InputPicture& image, float x, float y);
Eigen::Vector3f SampleBilinear(const InputPicture& image, float x, float y);
// Mean over a square about a position: SampleSharp where it is no larger than a pixel, so that what
// a minus lens makes small does not alias.
Eigen::Vector3f SampleMean(const InputPicture& image, float x, float y, float side_px);

// The input reduced to some 45 to 90 rows, with holes (and all around) filled from their borders.
class FilledPicture {
 public:
  // known: one byte a reduced pixel, 1 where the picture shows what is wanted.
  FilledPicture(const InputPicture& input, const std::vector<std::uint8_t>& known);
  Eigen::Vector3f Sample(float x, float y) const;  // in pixels of the input
  // Pixels of the input along a side of a reduced one, by the input's height.
  static int StepOf(int height);
  static int ReducedSide(int side, int step) { return (side + step - 1) / step; }

 private:
  int step_;
  ImageRgbF filled_;
};

// Colours of one frame. Thread safe; what is rarely needed is made at first use.
class PictureView {
 public:
  // background_depth_mm: of the plane behind the head, camera z.
  PictureView(const InputPicture& input, const Camera& camera,
              const Eigen::Isometry3d& camera_from_head, const EmbreeScene& scene,
              const std::vector<Eigen::Vector3f>& face_vertices,
              const std::vector<Eigen::Vector3f>& face_normals,
              const std::vector<Eigen::Vector3i>& face_triangles, double background_depth_mm);

  const Eigen::Vector3f& eye() const { return eye_; }
  Eigen::Vector2f Project(const Eigen::Vector3f& head_point) const;
  // Camera z.
  float Depth(const Eigen::Vector3f& head_point) const {
    return rotation_.row(2).dot(head_point) + translation_.z();
  }

  // Colour of the head where a refracted ray met it. `filled` counts what the camera never saw.
  Eigen::Vector3f Head(const SceneHit& hit, const Eigen::Vector3f& point, long& filled) const;
  // Colour of the background along a ray in head space; false when it does not meet the plane.
  //   footprint_px  side of the square of the picture that the sample stands for
  bool Background(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                  float footprint_px, Eigen::Vector3f& colour, long& filled) const;
  // Colour of the face's vertices: as seen, or spread from where it was.
  const std::vector<Eigen::Vector3f>& vertex_colours() const;
  float background_depth() const { return background_depth_; }
  // The brightest of the face's visible vertices by channel, and their mean colour.
  const Eigen::Vector3f& face_brightest() const;
  const Eigen::Vector3f& face_mean() const;

 private:
  bool InsidePicture(const Eigen::Vector2f& p) const {
    return p.x() >= 0 && p.y() >= 0 && p.x() <= float(input_.width()) &&
           p.y() <= float(input_.height());
  }
  bool Faces(const Eigen::Vector3i& triangle, const SceneHit& hit,
             const Eigen::Vector3f& point) const;
  bool CameraSees(const Eigen::Vector3f& point) const;
  void FillFace() const;
  void FillBackground() const;

  InputPicture input_;
  Camera camera_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_, eye_;
  const EmbreeScene& scene_;
  const std::vector<Eigen::Vector3f>& vertices_;
  const std::vector<Eigen::Vector3f>& normals_;
  const std::vector<Eigen::Vector3i>& triangles_;
  float background_depth_;

  mutable std::once_flag face_once_, background_once_;
  mutable std::vector<Eigen::Vector3f> vertex_colours_;
  mutable std::vector<std::uint8_t> vertex_seen_;
  mutable Eigen::Vector3f face_mean_{0, 0, 0}, face_brightest_{0, 0, 0};
  mutable std::vector<FilledPicture> background_;  // one, once made
};

}  // namespace lorgnette
