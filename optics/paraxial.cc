// SPDX-License-Identifier: Apache-2.0
#include "optics/paraxial.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace lorgnette {
namespace {

using Eigen::Matrix2d;

// left * m^-1 for 2x2 blocks; infinite where m is singular.
Matrix2d TimesInverse(const Matrix2d& left, const Matrix2d& m) {
  const double det = m.determinant();
  if (det == 0) return Matrix2d::Constant(std::numeric_limits<double>::infinity());
  return left * m.inverse();
}

// Vertex powers are symmetric in exact arithmetic; this removes the rounding.
Matrix2d Symmetrized(const Matrix2d& m) { return 0.5 * (m + m.transpose()); }

}  // namespace

ParaxialSystem operator*(const ParaxialSystem& later, const ParaxialSystem& earlier) {
  return {
      later.a * earlier.a + later.b_m * earlier.c_D, later.a * earlier.b_m + later.b_m * earlier.d,
      later.c_D * earlier.a + later.d * earlier.c_D, later.c_D * earlier.b_m + later.d * earlier.d};
}

ParaxialSystem ParaxialSystem::ThickLens(Diopters front, Diopters back, double thickness_mm,
                                         double index) {
  return Refraction(back) * Transfer(thickness_mm / index) * Refraction(front);
}

std::optional<CardinalPoints> ParaxialSystem::Cardinal() const {
  const double power = -c_D;
  if (!(std::abs(power) > kAfocalPower_D)) return std::nullopt;
  CardinalPoints points;
  points.front_focal_mm = -1000 * d / power;
  points.back_focal_mm = 1000 * a / power;
  points.front_principal_mm = 1000 * (1 - d) / power;
  points.back_principal_mm = 1000 * (a - 1) / power;
  return points;
}

AstigmaticSystem AstigmaticSystem::Refraction(const Matrix2d& power_D) {
  AstigmaticSystem system;
  system.c_D = -power_D;
  return system;
}

AstigmaticSystem AstigmaticSystem::Transfer(double reduced_mm) {
  AstigmaticSystem system;
  system.b_m = reduced_mm / 1000 * Matrix2d::Identity();
  return system;
}

AstigmaticSystem operator*(const AstigmaticSystem& later, const AstigmaticSystem& earlier) {
  AstigmaticSystem s;
  s.a = later.a * earlier.a + later.b_m * earlier.c_D;
  s.b_m = later.a * earlier.b_m + later.b_m * earlier.d;
  s.c_D = later.c_D * earlier.a + later.d * earlier.c_D;
  s.d = later.c_D * earlier.b_m + later.d * earlier.d;
  return s;
}

AstigmaticSystem AstigmaticSystem::ThickLens(const Matrix2d& front_D, const Matrix2d& back_D,
                                             double thickness_mm, double index) {
  return Refraction(back_D) * Transfer(thickness_mm / index) * Refraction(front_D);
}

Eigen::Matrix4d AstigmaticSystem::Matrix() const {
  Eigen::Matrix4d m;
  m << a, b_m, c_D, d;
  return m;
}

double AstigmaticSystem::SymplecticDefect() const {
  const Matrix2d unit = a.transpose() * d - c_D.transpose() * b_m - Matrix2d::Identity();
  const Matrix2d ac = a.transpose() * c_D, bd = b_m.transpose() * d;
  return std::max(
      {unit.cwiseAbs().maxCoeff(), std::abs(ac(0, 1) - ac(1, 0)), std::abs(bd(0, 1) - bd(1, 0))});
}

Matrix2d AstigmaticSystem::BackVertexPower() const { return Symmetrized(TimesInverse(-c_D, a)); }

Matrix2d AstigmaticSystem::FrontVertexPower() const {
  const Matrix2d transposed = TimesInverse(-c_D.transpose(), d.transpose());
  return Symmetrized(transposed);
}

Matrix2d SurfacePower(const Surface& surface, double index_before, double index_after) {
  return 1000 * (index_after - index_before) * surface.VertexCurvature();
}

AstigmaticSystem SystemOf(const Lens& lens, double index) {
  return AstigmaticSystem::ThickLens(SurfacePower(lens.front, 1, index),
                                     SurfacePower(lens.back, index, 1), lens.center_thickness_mm,
                                     index);
}

AstigmaticSystem SystemOf(const Lens& lens) { return SystemOf(lens, lens.medium.index_d); }

Diopters PaperPower(Diopters front, Diopters back, double thickness_mm, double index) {
  const double tau = thickness_mm / 1000 / index;
  return front + back + tau * front.value() * front;
}

Diopters PaperPowerError(Diopters front, double thickness_mm, double index) {
  const double tau_f = thickness_mm / 1000 / index * front.value();
  return tau_f * tau_f / (1 - tau_f) * front;
}

Diopters MovedTowardEye(Diopters power, double toward_eye_mm) {
  return Diopters(power.value() / (1 - toward_eye_mm / 1000 * power.value()));
}

Matrix2d MovedTowardEye(const Matrix2d& power_D, double toward_eye_mm) {
  return Symmetrized(TimesInverse(power_D, Matrix2d::Identity() - toward_eye_mm / 1000 * power_D));
}

}  // namespace lorgnette
