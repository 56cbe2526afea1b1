// SPDX-License-Identifier: Apache-2.0
// Gaussian optics of a lens: system matrices, vertex powers and cardinal points.
//
// A ray is the pair (height in m, reduced angle in rad) in the lens frame, light travelling +z; a
// system maps the pair before the front vertex to the pair after the back vertex. Powers are in
// dioptres, lengths in mm at the interface and in metres inside the matrices. Power matrices are
// Long's, but in the lens frame's axes (optics/ray.h): F = [Fxx Fxy; Fxy Fyy].
// Source: docs/measurement.md, "Paraxial"; Keating, Harris (OVS 87(1), 2010).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/units.h"
#include "optics/lens.h"

namespace lorgnette {

// Distances in mm, positive toward the eye; the front ones from the front vertex, the back ones
// from the back vertex. In air nodal points coincide with principal points.
struct CardinalPoints {
  double front_focal_mm = 0, back_focal_mm = 0;
  double front_principal_mm = 0, back_principal_mm = 0;
};

// Below this equivalent power a system counts as afocal and has no cardinal points.
inline constexpr double kAfocalPower_D = 1e-12;

// Rotationally symmetric system [a b; c d], ad - bc = 1.
struct ParaxialSystem {
  double a = 1;    // -
  double b_m = 0;  // m
  double c_D = 0;  // D
  double d = 1;    // -

  static ParaxialSystem Refraction(Diopters power) { return {1, 0, -power.value(), 1}; }
  // reduced_mm  distance over refractive index
  static ParaxialSystem Transfer(double reduced_mm) { return {1, reduced_mm / 1000, 0, 1}; }
  static ParaxialSystem ThickLens(Diopters front, Diopters back, double thickness_mm, double index);

  double determinant() const { return a * d - b_m * c_D; }
  Diopters EquivalentPower() const { return Diopters(-c_D); }
  // Infinite when the image of an infinite object lies at the vertex (tau F1 = 1, or tau F2 = 1).
  Diopters BackVertexPower() const { return Diopters(-c_D / a); }
  Diopters FrontVertexPower() const { return Diopters(-c_D / d); }
  // nullopt when afocal (kAfocalPower_D), and for no other reason.
  std::optional<CardinalPoints> Cardinal() const;
};
// `later` acts after `earlier`.
ParaxialSystem operator*(const ParaxialSystem& later, const ParaxialSystem& earlier);

// Astigmatic system: the same with 2x2 blocks, any two axes. Symplectic: A'D - C'B = I with A'C and
// B'D symmetric (' transposes). EquivalentPower() is not symmetric for obliquely crossed surfaces
// and then has no sphere, cylinder and axis; the vertex powers always have.
struct AstigmaticSystem {
  Eigen::Matrix2d a = Eigen::Matrix2d::Identity();  // -
  Eigen::Matrix2d b_m = Eigen::Matrix2d::Zero();    // m
  Eigen::Matrix2d c_D = Eigen::Matrix2d::Zero();    // D
  Eigen::Matrix2d d = Eigen::Matrix2d::Identity();  // -

  static AstigmaticSystem Refraction(const Eigen::Matrix2d& power_D);
  static AstigmaticSystem Transfer(double reduced_mm);
  static AstigmaticSystem ThickLens(const Eigen::Matrix2d& front_D, const Eigen::Matrix2d& back_D,
                                    double thickness_mm, double index);

  Eigen::Matrix4d Matrix() const;  // [A B; C D]
  // Largest entry of A'D - C'B - I and of the antisymmetric parts of A'C and B'D (the last in
  // their own units); zero but for rounding.
  double SymplecticDefect() const;

  Eigen::Matrix2d EquivalentPower() const { return -c_D; }
  // Symmetric. Every entry infinite when A (or D) is singular.
  Eigen::Matrix2d BackVertexPower() const;
  Eigen::Matrix2d FrontVertexPower() const;
};
AstigmaticSystem operator*(const AstigmaticSystem& later, const AstigmaticSystem& earlier);

// Power of a surface at its vertex, dioptres: 1000 (n_after - n_before) times its curvature matrix.
Eigen::Matrix2d SurfacePower(const Surface& surface, double index_before, double index_after);

// The lens in air about its axis. A ground prism (Lens::back_tilt_*) changes directions by a
// constant and is no part of the matrix. The second form takes the medium's design index.
AstigmaticSystem SystemOf(const Lens& lens, double index);
AstigmaticSystem SystemOf(const Lens& lens);

// The paper's equation (1), F + B + tau F^2: the back vertex power without its terms from tau^2 on.
// It differs from the exact value by tau^2 F^3 / (1 - tau F), which the second function returns.
Diopters PaperPower(Diopters front, Diopters back, double thickness_mm, double index);
Diopters PaperPowerError(Diopters front, double thickness_mm, double index);

// Effective power of a correction moved `toward_eye_mm` nearer the eye: F (I - d F)^-1.
Diopters MovedTowardEye(Diopters power, double toward_eye_mm);
Eigen::Matrix2d MovedTowardEye(const Eigen::Matrix2d& power_D, double toward_eye_mm);

}  // namespace lorgnette
