// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d MeridianDirection(double angle) { return {-std::cos(angle), std::sin(angle)}; }

// A meridian of a cylinder without power has what rounding left of the other one's.
constexpr double kPlano = 8 * std::numeric_limits<double>::epsilon();

MeridianPair Radii(const MeridianPair& power_D, double index_step) {
  const double greatest = std::max(std::abs(power_D.along), std::abs(power_D.across));
  const auto radius = [&](double power) {
    return std::abs(power) <= kPlano * greatest ? std::numeric_limits<double>::infinity()
                                                : 1000 * index_step / power;
  };
  return {radius(power_D.along), radius(power_D.across)};
}

}  // namespace

LensSheet MakeLensSheet(const LensDesign& design, const SheetRequest& request) {
  const Lens& lens = design.lens;
  const double n = lens.medium.index_d;
  const double t = lens.center_thickness_mm;
  const EyePrescription& rx = design.order.rx;
  const double axis = rx.cylinder.value() == 0 ? kPi : rx.axis.radians();
  const Vector2d u = MeridianDirection(axis), v(-u.y(), u.x());
  const auto pair = [&](const Matrix2d& m) { return MeridianPair{u.dot(m * u), v.dot(m * v)}; };

  const Matrix2d front = SurfacePower(lens.front, 1, n), back = SurfacePower(lens.back, n, 1);
  const AstigmaticSystem system = AstigmaticSystem::ThickLens(front, back, t, n);

  LensSheet sheet;
  sheet.front_power_D = pair(front);
  sheet.back_power_D = pair(back);
  sheet.radius_front_mm = Radii(sheet.front_power_D, n - 1);
  sheet.radii_back_mm = Radii(sheet.back_power_D, 1 - n);
  sheet.back_vertex_power_D = pair(system.BackVertexPower());
  sheet.front_vertex_power_D = pair(system.FrontVertexPower());
  sheet.equivalent_power_D = pair(system.EquivalentPower());

  const Diopters f_along(sheet.front_power_D.along), f_across(sheet.front_power_D.across);
  const Diopters b_along(sheet.back_power_D.along), b_across(sheet.back_power_D.across);
  sheet.paper_power_D = {PaperPower(f_along, b_along, t, n).value(),
                         PaperPower(f_across, b_across, t, n).value()};
  sheet.paper_power_error_D = {PaperPowerError(f_along, t, n).value(),
                               PaperPowerError(f_across, t, n).value()};
  sheet.cardinal_along = ParaxialSystem::ThickLens(f_along, b_along, t, n).Cardinal();
  sheet.cardinal_across = ParaxialSystem::ThickLens(f_across, b_across, t, n).Cardinal();

  sheet.center_thickness_mm = t;
  sheet.edge_thickness_min_mm = design.min_edge_thickness_mm;
  sheet.edge_thickness_max_mm = design.max_edge_thickness_mm;
  sheet.mass_g = design.mass_g;
  sheet.min_blank_mm = design.min_blank_mm;

  sheet.pupil_mm = design.order.vertex_distance_mm + kEntrancePupilDepth_mm;
  sheet.shape_factor = {ShapeFactor(f_along, t, n), ShapeFactor(f_across, t, n)};
  sheet.power_factor = {PowerFactor(Diopters(sheet.back_vertex_power_D.along), sheet.pupil_mm),
                        PowerFactor(Diopters(sheet.back_vertex_power_D.across), sheet.pupil_mm)};
  sheet.spectacle_magnification = pair(SpectacleMagnification(system, sheet.pupil_mm));

  const Vector2d along_feature =
      MeridianDirection(RadiansFromDegrees(request.feature_meridian_deg));
  const auto component = [&](const Matrix2d& m) { return along_feature.dot(m * along_feature); };
  sheet.observer_magnification_thin =
      ObserverMagnificationThin(Diopters(component(system.BackVertexPower())), request.observer);
  sheet.observer_magnification_paraxial =
      component(ObserverMagnification(system, t, request.observer));
  if (const auto ray =
          ObserverExact(lens, n, request.observer, request.feature_height_mm * along_feature)) {
    sheet.observer_magnification_exact = ray->magnification;
  }
  return sheet;
}

}  // namespace lorgnette
