// SPDX-License-Identifier: Apache-2.0
#include "validation/cost/camera_lens.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "optics/long_double_trace.h"
#include "optics/media.h"

namespace lorgnette::validation {
namespace {

struct Accumulator {
  double squares = 0, greatest = 0;
  long count = 0;
  void Add(double error) {
    squares += error * error;
    greatest = std::max(greatest, error);
    ++count;
  }
  void Put(CostPoint& point) const {
    point.errors.push_back(count > 0 ? std::sqrt(squares / double(count)) : 0);
    point.worst.push_back(greatest);
  }
};

// Visits pixels whose neighbour `step` columns and `step` rows on is inside too, with both answers.
template <typename Visit>
void ForPairs(const CameraRays& rays, const std::vector<ExitRay>& truth,
              const std::vector<ExitRay>& found, int step, Visit&& visit) {
  const auto usable = [&](std::size_t i) { return rays.inside(i) && truth[i].ok && found[i].ok; };
  for (int y = 0; y < rays.rows(); ++y) {
    for (int x = 0; x < rays.columns(); ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(rays.columns()) + std::size_t(x);
      if (!usable(i)) continue;
      if (x + step < rays.columns() && usable(i + std::size_t(step))) {
        visit(i, i + std::size_t(step));
      }
      const std::size_t below = i + std::size_t(step) * std::size_t(rays.columns());
      if (y + step < rays.rows() && usable(below)) visit(i, below);
    }
  }
}

}  // namespace

CameraRays::CameraRays(const Lens& lens, const LensView& view)
    : view_(view), thickness_(lens.center_thickness_mm) {
  const double px_per_mm = view.focal_px / view.camera_mm;  // on the front vertex plane
  columns_ = int(std::ceil(view.width_mm * px_per_mm)) + 1;
  rows_ = int(std::ceil(view.height_mm * px_per_mm)) + 1;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      // Off the grid's centre, as a lens in a picture is.
      const Eigen::Vector2d slope =
          Eigen::Vector2d(x - 0.5 * (columns_ - 1) + 0.31, y - 0.5 * (rows_ - 1) - 0.17) /
          view.focal_px;
      const Eigen::Vector2d at = view.camera_mm * slope;
      slopes_.push_back(slope);
      inside_.push_back(
          std::pow(2 * at.x() / view.width_mm, 2) + std::pow(2 * at.y() / view.height_mm, 2) < 1);
      inside_count_ += inside_.back();
    }
  }
}

ExitRay CameraRays::ExitFrom(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  if (!(direction.z() > 0)) return {};
  ExitRay ray;
  ray.ok = true;
  ray.slope = direction.head<2>() / direction.z();
  ray.at = point.head<2>() + (thickness_ - point.z()) * ray.slope;
  return ray;
}

LensReference TraceReference(const Lens& lens, const CameraRays& rays) {
  LensReference reference;
  const auto trace = [&](double index) {
    std::vector<ExitRay> out(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!rays.inside(i)) continue;
      const oracle::Vec direction =
          oracle::Vec(rays.slope(i).x(), rays.slope(i).y(), 1).normalized();
      const oracle::Trace ray =
          oracle::TraceLens(lens, oracle::Vec(0, 0, -rays.view().camera_mm), direction, index);
      if (ray.status != RayStatus::kOk || !(ray.exit.z() > 0)) continue;
      const oracle::Vec slope = ray.exit / ray.exit.z();
      const oracle::Vec at =
          ray.second.point +
          (oracle::Real(lens.center_thickness_mm) - ray.second.point.z()) * slope;
      out[i] = {true, at.head<2>().cast<double>(), slope.head<2>().cast<double>()};
    }
    return out;
  };
  reference.design = trace(lens.medium.index_d);
  reference.red = trace(IndexAt(lens.medium, kRed_nm));
  reference.blue = trace(IndexAt(lens.medium, kBlue_nm));
  return reference;
}

std::vector<ErrorUnit> LensUnits() {
  return {{"px", "on the face, in pixels of the picture"},
          {"magnification", "of the local magnification, between neighbouring pixels"},
          {"D", "of the power over 4 mm of the lens, in dioptres"},
          {"arcmin", "of the ray behind the lens, in arc minutes"},
          {"colour_px", "of red and blue light on the face, in pixels of the picture"}};
}

void SetErrors(const CameraRays& rays, const LensReference& reference, const LensAnswer& answer,
               CostPoint& point) {
  Accumulator px, magnification, power, arcmin, colour;
  long lost = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ExitRay& truth = reference.design[i];
    if (!rays.inside(i) || !truth.ok) continue;
    const ExitRay& found = answer.design[i];
    if (!found.ok) {
      ++lost;
      continue;
    }
    px.Add(rays.px_per_mm() * (rays.FaceHit(found) - rays.FaceHit(truth)).norm());
    const Eigen::Vector3d a = found.slope.homogeneous(), b = truth.slope.homogeneous();
    // The cross product as a difference of slopes, which keeps its digits where they agree.
    const Eigen::Vector3d difference(found.slope.x() - truth.slope.x(),
                                     found.slope.y() - truth.slope.y(), 0);
    arcmin.Add(60 * DegreesFromRadians(std::atan2(difference.cross(b).norm(), a.dot(b))));
    for (const bool red : {true, false}) {
      const ExitRay& true_colour = (red ? reference.red : reference.blue)[i];
      const std::vector<ExitRay>& own = red ? answer.red : answer.blue;
      const ExitRay& found_colour = own.empty() ? found : own[i];
      if (!true_colour.ok || !found_colour.ok) continue;
      colour.Add(rays.px_per_mm() *
                 (rays.FaceHit(found_colour) - rays.FaceHit(true_colour)).norm());
    }
  }
  ForPairs(rays, reference.design, answer.design, 1, [&](std::size_t i, std::size_t j) {
    const auto step = [&](const std::vector<ExitRay>& r) -> Eigen::Vector2d {
      return rays.FaceHit(r[j]) - rays.FaceHit(r[i]);
    };
    const Eigen::Vector2d truth = step(reference.design);
    magnification.Add((step(answer.design) - truth).norm() / truth.norm());
  });
  const int base = std::max(1, int(std::lround(kPowerBase_mm / rays.spacing_mm())));
  ForPairs(rays, reference.design, answer.design, base, [&](std::size_t i, std::size_t j) {
    const auto turn = [&](const std::vector<ExitRay>& r) -> Eigen::Vector2d {
      return r[j].slope - r[i].slope;
    };
    const double width_mm = (reference.design[j].at - reference.design[i].at).norm();
    power.Add(1000 * (turn(answer.design) - turn(reference.design)).norm() / width_mm);
  });
  for (const Accumulator* sum : {&px, &magnification, &power, &arcmin, &colour}) sum->Put(point);
  if (lost > 0) point.note = fmt::format("lost {} of {} rays", lost, lost + px.count);
}

}  // namespace lorgnette::validation
