// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>

#include "optics/long_double_trace.h"
#include "validation/magnification_grid.h"
#include "validation/worst.h"

namespace lorgnette::validation {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, 2, 2>;

// (L + t + z) times the inverse of feature / angle, by two long double rays near the axis.
Matrix ByRays(const Lens& lens, const ObserverGeometry& view) {
  constexpr Real kAngle = 1e-7L;
  const Real plane = Real(lens.center_thickness_mm) + view.depth_mm;
  Matrix heights;
  for (int k = 0; k < 2; ++k) {
    const oracle::Vec direction =
        oracle::Vec(k == 0 ? kAngle : 0, k == 1 ? kAngle : 0, 1).normalized();
    const oracle::Trace ray =
        oracle::TraceLens(lens, oracle::Vec(0, 0, -view.camera_mm), direction, lens.medium.index_d);
    const oracle::Vec at =
        ray.second.point + (plane - ray.second.point.z()) / ray.exit.z() * ray.exit;
    heights.col(k) = at.head<2>() / kAngle;
  }
  return (Real(view.camera_mm) + plane) * heights.inverse();
}

void RunV064(CaseRun& run) {
  Worst entries, transposed;
  for (const double sphere : {-12.0, -6.0, -1.0, 2.0, 6.0, 10.0}) {
    for (const double cylinder : {-0.5, -2.0, -5.0}) {
      for (const double axis : {5.0, 40.0, 90.0, 145.0}) {
        for (const double depth : {12.0, 25.0}) {
          LensOrder order;
          order.rx.sphere = Diopters(sphere);
          order.rx.cylinder = Diopters(cylinder);
          order.rx.axis = AxisDegrees(axis);
          order.medium.index_d = 1.6;
          order.diameter_mm = 40;
          const auto design = DesignLens(order);
          if (!design) {
            run.Bound(design.error().message, "1", 1, 0, "every lens of the grid can be made");
            return;
          }
          const ObserverGeometry view{500, depth};
          const auto where = [&] {
            return fmt::format("{:+g} {:+g} x {}, depth {} mm", sphere, cylinder, axis, depth);
          };
          const Eigen::Matrix2d library = ObserverMagnification(design->lens, 1.6, view);
          const Eigen::Matrix2d rays = ByRays(design->lens, view).cast<double>();
          entries.Add((library - rays).cwiseAbs().maxCoeff(), where);
          const AstigmaticSystem system = SystemOf(design->lens);
          const Eigen::Matrix2d far =
              ObserverMagnification(system, design->lens.center_thickness_mm, {1e12, depth});
          transposed.Add(
              (far.transpose() - SpectacleMagnification(system, depth)).cwiseAbs().maxCoeff(),
              where);
        }
      }
    }
  }
  entries.Report(run, "entries of the matrix against long double rays", "1", 1e-11,
                 "the square of the ray's angle, 1e-7, times the aberration");
  transposed.Report(run, "observer at infinity against the wearer's transpose", "1", 1e-9,
                    "1e12 mm for infinity, over the lens' own lengths");
}

}  // namespace

extern const Case kV064;
const Case kV064 = {"V064", "magnification", "sphero-cylinders: the matrix of magnification",
                    "derived: optics reference section 5; rays in long double", RunV064};

}  // namespace lorgnette::validation
