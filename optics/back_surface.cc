// SPDX-License-Identifier: Apache-2.0
#include "optics/back_surface.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "base/units.h"
#include "optics/trace.h"

namespace lorgnette {

GroundPrism GrindPrism(const Eigen::Vector2d& prism, double index) {
  GroundPrism ground;
  const double amount = prism.norm();
  if (amount == 0) return ground;
  ground.toward = prism / amount;
  // Snell on the tilted plane: n sin i = sin(i + e), solved for i.
  const double e = ground.deviation = std::atan(amount / 100);
  const double i = ground.incidence = std::atan2(std::sin(e), index - std::cos(e));
  // The back normal leans away from the base: thickness grows toward it.
  ground.tilt_x = std::asin(std::sin(i) * ground.toward.y());
  ground.tilt_y = std::asin(-std::sin(i) * ground.toward.x() / std::cos(ground.tilt_x));
  return ground;
}

Eigen::Matrix2d BackCurvature(const Eigen::Matrix2d& front_D, const Eigen::Matrix2d& power_D,
                              double thickness_mm, double index, const GroundPrism& prism) {
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  const double tau = thickness_mm / 1000 / index;
  const Eigen::Matrix2d arriving = front_D * (identity - tau * front_D).inverse();
  if (prism.deviation == 0) {
    const Eigen::Matrix2d k = (power_D - arriving) / (1000 * (1 - index));
    return 0.5 * (k + k.transpose());
  }
  // e1 lies across the plane of incidence, e2 and g2 in it: across the ray and in the surface.
  const Eigen::Vector3d d(0, 0, 1);
  const Eigen::Vector3d e1(-prism.toward.y(), prism.toward.x(), 0);
  const Eigen::Vector3d e2 = d.cross(e1);
  Lens tilted;
  tilted.back_tilt_x = prism.tilt_x;
  tilted.back_tilt_y = prism.tilt_y;
  const Eigen::Matrix3d axes = BackRotation(tilted);
  const Eigen::Vector3d normal = axes.col(2);
  const Eigen::Vector3d g2 = normal.cross(e1);

  Eigen::Matrix2d basis;
  basis << e1.head<2>(), e2.head<2>();
  const double ci = std::cos(prism.incidence), co = std::cos(prism.incidence + prism.deviation);
  const Eigen::Vector2d before(1, ci), after(1, co);
  const Eigen::Matrix2d vin = basis.transpose() * arriving * basis;
  const Eigen::Matrix2d vout = basis.transpose() * power_D * basis;
  const Eigen::Matrix2d k = (after.asDiagonal() * vout * after.asDiagonal() -
                             Eigen::Matrix2d(before.asDiagonal() * vin * before.asDiagonal())) /
                            (1000 * (co - index * ci));
  Eigen::Matrix2d to_surface;
  to_surface << (axes.transpose() * e1).head<2>(), (axes.transpose() * g2).head<2>();
  const Eigen::Matrix2d own = to_surface * k * to_surface.transpose();
  return 0.5 * (own + own.transpose());
}

Eigen::Matrix2d PaperBackCurvature(const Eigen::Matrix2d& front_D, const Eigen::Matrix2d& power_D,
                                   double thickness_mm, double index) {
  const double tau = thickness_mm / 1000 / index;
  const Eigen::Matrix2d k = (power_D - front_D - tau * front_D * front_D) / (1000 * (1 - index));
  return 0.5 * (k + k.transpose());
}

Eigen::Matrix2d PrismaticObserverMagnification(const Lens& lens, double index, double camera_mm,
                                               double depth_mm) {
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  const Eigen::Matrix3d axes = BackRotation(lens);
  const Eigen::Vector3d normal = axes.col(2);
  const double lean = normal.head<2>().norm();
  const Eigen::Vector2d toward =
      lean > 0 ? Eigen::Vector2d(-normal.head<2>() / lean) : Eigen::Vector2d(1, 0);
  const double incidence = std::atan2(lean, normal.z());
  const double leaving = std::asin(index * std::sin(incidence)), deviation = leaving - incidence;

  // Lengths in mm and curvatures in 1/mm here; slopes are reduced (index times slope).
  const Eigen::Matrix2d front = (index - 1) * lens.front.VertexCurvature();
  const Eigen::Matrix2d at_front = camera_mm * identity;  // height by camera angle
  const Eigen::Matrix2d inside = identity - front * at_front;
  const Eigen::Matrix2d at_back = at_front + lens.center_thickness_mm / index * inside;

  const Eigen::Vector3d e1(-toward.y(), toward.x(), 0);
  const Eigen::Vector3d g2 = normal.cross(e1);
  Eigen::Matrix2d basis, to_surface;
  basis << e1.head<2>(), -toward;
  to_surface << (axes.transpose() * e1).head<2>(), (axes.transpose() * g2).head<2>();
  const Eigen::Matrix2d bend = to_surface.transpose() * lens.back.VertexCurvature() * to_surface;
  const double ci = std::cos(incidence), co = std::cos(leaving);
  const Eigen::DiagonalMatrix<double, 2> before(1, ci), over_before(1, 1 / ci), after(1, co),
      over_after(1, 1 / co);
  const Eigen::Matrix2d y = basis.transpose() * at_back, p = basis.transpose() * inside;
  const Eigen::Matrix2d y_out = after * Eigen::Matrix2d(over_before * y);
  const Eigen::Matrix2d p_out =
      over_after * Eigen::Matrix2d(Eigen::Matrix2d(before * p) -
                                   (co - index * ci) * bend * Eigen::Matrix2d(over_before * y));
  // Along the deviated ray to the feature's plane, which it crosses at a slant.
  const Eigen::Matrix2d y_plane = y_out + depth_mm / std::cos(deviation) * p_out;
  const Eigen::DiagonalMatrix<double, 2> slant(1, 1 / std::cos(deviation));
  const Eigen::Matrix2d feature = basis * Eigen::Matrix2d(slant * y_plane);
  return (camera_mm + lens.center_thickness_mm + depth_mm) * feature.inverse();
}

Surface ToricSurface(const Eigen::Matrix2d& k, ToricGenerator generator, bool across_is_steeper) {
  const double mean = 0.5 * k.trace();
  const double half_difference = 0.5 * (k(0, 0) - k(1, 1)), off = 0.5 * (k(0, 1) + k(1, 0));
  const double half_range = std::hypot(half_difference, off);
  if (half_range <= kSphericalCurvature_per_mm) return SphereSurface{mean};
  const double steep_angle = 0.5 * std::atan2(off, half_difference);
  const bool steep_generates = (generator == ToricGenerator::kAcrossMinusAxis) == across_is_steeper;
  TorusSurface torus;
  torus.curvature_generator = mean + (steep_generates ? half_range : -half_range);
  torus.curvature_across = mean - (steep_generates ? half_range : -half_range);
  torus.generator_angle = steep_generates ? steep_angle : steep_angle + 0.5 * kPi;
  return torus;
}

}  // namespace lorgnette
