// SPDX-License-Identifier: Apache-2.0
// Light from all around, as a latitude-longitude map of linear radiance.
//
// World axes: +x right, +y up, +z toward the camera (out of the picture). Column-to-direction rule:
//   u = (column + .5) / width, v = (row + .5) / height, lon = 2 pi (u - .5), lat = pi (.5 - v)
//   direction = (-sin lon cos lat, sin lat, cos lon cos lat)
// so the image centre looks along +z, columns increase toward -x, row 0 is up. Tested with one
// bright texel.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/result.h"

namespace lorgnette {

class Environment {
 public:
  // EXR or Radiance HDR. Negative texels are clamped to 0 with a note in `warning`; NaN and
  // infinite ones are an error.
  static Result<Environment> Read(const std::string& path, std::string* warning = nullptr);
  static Environment Constant(const Eigen::Vector3f& radiance);
  explicit Environment(ImageRgbF map);

  const ImageRgbF& map() const { return map_; }
  // Bilinear radiance along a world direction (need not be unit).
  Eigen::Vector3f Radiance(const Eigen::Vector3f& direction) const;
  // Mean over all directions.
  Eigen::Vector3f Mean() const;

  // World direction of a position in the map, in texels (texel centres at .5).
  Eigen::Vector3f Direction(double column, double row) const;

 private:
  ImageRgbF map_;
};

// The brightest of an environment about a direction, by channel: an upper bound of what a mirror
// can show within about 6 degrees of it.
class BrightestLight {
 public:
  explicit BrightestLight(const Environment& environment);
  const Eigen::Vector3f& Near(const Eigen::Vector3f& direction) const;
  const Eigen::Vector3f& greatest() const { return greatest_; }

 private:
  static constexpr int kColumns = 64, kRows = 32;
  std::vector<Eigen::Vector3f> cells_;
  Eigen::Vector3f greatest_{0, 0, 0};
};

// An environment blurred once with a rotationally symmetric kernel, for look-ups without any
// trigonometry: an octahedral map (Cigolle et al., JCGT 3(2), 2014), bilinear.
class BlurredEnvironment {
 public:
  // Mean over a soft cone whose solid angle is 4 pi / cells: what one of `cells` equal directions
  // of the sphere stands for.
  static BlurredEnvironment ForCells(const Environment& environment, int cells);
  // Normalised Phong lobe, cos^shininess about the direction.
  static BlurredEnvironment ForPhong(const Environment& environment, double shininess);

  Eigen::Vector3f Radiance(const Eigen::Vector3f& direction) const;

 private:
  BlurredEnvironment(const Environment& environment, double exponent);
  int side_;       // texels of the map, without its border
  ImageRgbF map_;  // with a border of one texel on every side
};

}  // namespace lorgnette
