// SPDX-License-Identifier: Apache-2.0
#include "optics/focimeter.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/check.h"
#include "base/linear_algebra.h"
#include "optics/coddington.h"
#include "optics/trace.h"

namespace lorgnette {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Basis = Eigen::Matrix<double, 3, 2>;

// Height and slope of a ray across a plane at `origin` with axes (across, normal).
struct Screen {
  Vector3d origin, normal;
  Basis across;

  Vector2d Slope(const Ray& ray) const {
    return across.transpose() * ray.direction / ray.direction.dot(normal);
  }
  Vector2d Height(const Ray& ray) const {
    const double steps = (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
    return across.transpose() * (ray.origin + steps * ray.direction - origin);
  }
};

// Axes across `direction` that follow the lens frame's x and y as closely as may be.
Basis UprightAcross(const Vector3d& direction) {
  Basis basis;
  basis.col(1) = (Vector3d::UnitY() - direction.y() * direction).normalized();
  basis.col(0) = basis.col(1).cross(direction);
  if (direction.z() < 0) basis.col(0) = -basis.col(0);
  return basis;
}

// Reading at a point of the face that `leaving` (unit, out of the lens, normal to the face) leaves.
std::optional<FocimeterReading> Read(const Lens& lens, double index, const Vector3d& at,
                                     const Vector3d& leaving, const FocimeterOptions& options) {
  LG_CHECK_GE(options.rays, 4);
  LG_CHECK_GT(options.pupil_radius_mm, 0.0);
  // Backward along the normal to find the object side's direction.
  constexpr double kStandOff_mm = 10;
  const LensTrace back = TraceThrough(lens, {at + kStandOff_mm * leaving, -leaving}, index);
  if (back.status != RayStatus::kOk) return std::nullopt;
  const Vector3d object = -back.exit.direction;
  const Vector3d start = back.exit.origin - kStandOff_mm * object;
  const Basis entrance = UprightAcross(object);
  const Screen screen{at, leaving, UprightAcross(leaving)};

  Eigen::MatrixXd design(2 * options.rays, 3);
  Eigen::VectorXd slopes(2 * options.rays);
  for (int k = 0; k < options.rays; ++k) {
    const double angle = 2 * kPi * k / options.rays;
    const Vector2d target = options.pupil_radius_mm * Vector2d(std::cos(angle), std::sin(angle));
    // Where a parallel ray must enter to leave through the pupil's edge: the lens is nearly of
    // unit magnification between its surfaces, so the correction contracts fast.
    constexpr int kMaxSteps = 60;
    constexpr double kOnRing_mm = 1e-12;
    Vector2d offset = target, miss(1, 1);
    LensTrace trace;
    for (int i = 0; i < kMaxSteps && miss.norm() > kOnRing_mm; ++i) {
      trace = TraceThrough(lens, {start + entrance * offset, object}, index);
      if (trace.status != RayStatus::kOk) return std::nullopt;
      miss = target - screen.Height(trace.exit);
      offset += miss;
    }
    const Vector2d h = screen.Height(trace.exit), s = screen.Slope(trace.exit);
    design.row(2 * k) << h.x(), h.y(), 0;
    design.row(2 * k + 1) << 0, h.x(), h.y();
    slopes.segment<2>(2 * k) = s;
  }
  const Eigen::Vector3d fit = LeastSquares(design, slopes);

  FocimeterReading reading;
  reading.power_D << fit.x(), fit.y(), fit.y(), fit.z();
  reading.power_D *= -1000;
  reading.power = MinusCylinderForm(PowerVectorOfLensFrame(reading.power_D));
  const Vector3d bent = leaving - object * leaving.dot(object);
  if (bent.head<2>().norm() > 0) {
    reading.prism =
        100 * object.cross(leaving).norm() / object.dot(leaving) * bent.head<2>().normalized();
  }
  reading.residual_D = 1000 * (slopes - design * fit).norm() / std::sqrt(double(slopes.size())) /
                       options.pupil_radius_mm;
  return reading;
}

}  // namespace

std::optional<FocimeterReading> ReadBackVertexPower(const Lens& lens, double index,
                                                    const Vector2d& at_mm,
                                                    const FocimeterOptions& options) {
  const auto hit = IntersectBack(lens, {{at_mm.x(), at_mm.y(), 0}, {0, 0, 1}});
  if (!hit) return std::nullopt;
  return Read(lens, index, hit->point, hit->normal, options);
}

std::optional<FocimeterReading> ReadFrontVertexPower(const Lens& lens, double index,
                                                     const Vector2d& at_mm,
                                                     const FocimeterOptions& options) {
  const auto hit = lens.front.Intersect({{at_mm.x(), at_mm.y(), 0}, {0, 0, 1}});
  if (!hit) return std::nullopt;
  return Read(lens, index, hit->point, -hit->normal, options);
}

double FocimeterTargetTravel(Diopters power, Diopters standard_lens) {
  const double focal_m = 1 / standard_lens.value();
  return 1000 * focal_m * focal_m * power.value();
}

}  // namespace lorgnette
