// SPDX-License-Identifier: Apache-2.0
// What the coated surfaces of a page's lens do to daylight at any angle, tabled.
#pragma once

#include <Eigen/Core>
#include <array>

#include "page_json.h"

namespace lorgnette::page {

// Reflection of one coated surface, met from the air at cos_incident, under D65: as the eye weighs
// it, and its colour as linear Rec.709 components. Linear between kMirrorNodes even cosines.
inline constexpr int kMirrorNodes = 65;
class Mirror {
 public:
  static const Mirror& Of(CoatKind coat, double index);  // the last one asked for is kept
  double Luminous(double cos_incident) const;
  Eigen::Vector3d Rgb(double cos_incident) const;

 private:
  Mirror(CoatKind coat, double index);
  CoatKind coat_;
  double index_;
  std::array<Eigen::Vector4d, kMirrorNodes> nodes_;  // luminous, r, g, b
  Eigen::Vector4d At(double cos_incident) const;
};

// Cosine in the air of a ray that meets a surface of the glass from inside; negative past the
// critical angle.
double CosineOutside(double cos_inside, double index);

// Share of light that passes both surfaces, met at these cosines in the air, with every bounce
// between them, and glass that leaves `glass` of it each time.
double Passed(const Mirror& mirror, double cos_front, double cos_back, double glass);

}  // namespace lorgnette::page
