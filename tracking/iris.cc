// SPDX-License-Identifier: Apache-2.0
#include "tracking/iris.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/units.h"

namespace lorgnette {
namespace {

constexpr double kTypicalPdMm = 63.5;
constexpr double kIrisBehindApexMm = 2.3;  // the limbus lies that far behind the apex
constexpr double kSearchAcrossMm = 5, kSearchUpMm = 3.5;
constexpr double kCoarseStepMm = 0.7, kFineStepMm = 0.25;
constexpr std::array<double, 5> kRadiusFactors{0.88, 0.94, 1.0, 1.06, 1.12};
constexpr double kRimShare = 0.18;  // of the radius, between the samples inside and outside
constexpr int kRimSamples = 7;      // a side
// Angles on the sides of the disc that lids leave free, degrees below the horizontal.
constexpr double kRimFromDeg = -25, kRimToDeg = 36;
constexpr double kMinContrast = 6;  // grey levels
constexpr double kMostRadiusMove = 0.15;
constexpr double kMostTurn = 0.6;  // radians off the line of sight

double Bilinear(const Image<std::uint8_t, 1>& image, double x, double y) {
  x = std::clamp(x - 0.5, 0.0, image.width - 1.001);
  y = std::clamp(y - 0.5, 0.0, image.height - 1.001);
  const int ix = int(x), iy = int(y);
  const double fx = x - ix, fy = y - iy;
  const std::uint8_t* row = image.at(ix, iy);
  const std::uint8_t* next = image.at(ix, iy + 1);
  return (row[0] * (1 - fx) + row[1] * fx) * (1 - fy) + (next[0] * (1 - fx) + next[1] * fx) * fy;
}

// The plane of the iris in the crop, to first order: crop px = centre + map * (x, y in mm).
struct IrisPlane {
  const Image<std::uint8_t, 1>& image;
  Eigen::Vector2d centre;
  Eigen::Matrix2d map;

  double At(double x, double y) const {
    const Eigen::Vector2d p = centre + map * Eigen::Vector2d(x, y);
    return Bilinear(image, p.x(), p.y());
  }
  // Mean step from inside to outside over the free arcs of a circle; the weaker side counts.
  double Contrast(double x, double y, double radius) const {
    std::array<double, 2> sides{};
    for (int k = 0; k < kRimSamples; ++k) {
      const double a =
          RadiansFromDegrees(kRimFromDeg + (kRimToDeg - kRimFromDeg) * k / (kRimSamples - 1));
      const double down = -std::sin(a), out = std::cos(a);
      for (std::size_t side = 0; side < 2; ++side) {
        const double across = side == 0 ? -out : out;
        const double r0 = radius * (1 - kRimShare), r1 = radius * (1 + kRimShare);
        sides[side] += At(x + r1 * across, y + r1 * down) - At(x + r0 * across, y + r0 * down);
      }
    }
    return (std::min(sides[0], sides[1]) + 0.25 * std::max(sides[0], sides[1])) / 1.25 /
           kRimSamples;
  }
};

struct Best {
  double x = 0, y = 0, radius = 0, contrast = -1e9;
};

void Search(const IrisPlane& plane, double radius, double half_x, double half_y, double step,
            Best& best) {
  const Best from = best;
  for (double y = from.y - half_y; y <= from.y + half_y + 1e-9; y += step) {
    for (double x = from.x - half_x; x <= from.x + half_x + 1e-9; x += step) {
      const double contrast = plane.Contrast(x, y, radius);
      if (contrast > best.contrast) best = {x, y, radius, contrast};
    }
  }
}

double Peak(double before, double at, double after);

// Moves a circle to the steps along its radii: each free direction votes with the place of its
// steepest rise, and directions that disagree (lashes, a reflection) lose their vote.
bool FitRim(const IrisPlane& plane, Best& best) {
  constexpr int kRays = 12, kSteps = 17, kRounds = 4;  // rays a side; samples a ray
  constexpr double kFromDeg = -38, kToDeg = 52, kInner = 0.72, kOuter = 1.28;
  constexpr double kScatterMm = 0.12;    // of the votes, from which on they lose weight
  constexpr double kPriorSigmaMm = 0.6;  // of the move, against the search, in units of scatter
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d normal = std::pow(kScatterMm / kPriorSigmaMm, 2) * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int votes = 0;
    for (int k = 0; k < 2 * kRays; ++k) {
      const int step_of_side = k / 2;  // right, left, right, ...
      const double a =
          RadiansFromDegrees(kFromDeg + (kToDeg - kFromDeg) * step_of_side / (kRays - 1));
      const Eigen::Vector2d out(k % 2 == 0 ? std::cos(a) : -std::cos(a), -std::sin(a));
      const double step = (kOuter - kInner) * best.radius / (kSteps - 1);
      std::array<double, kSteps> value{};
      for (int i = 0; i < kSteps; ++i) {
        const double r = kInner * best.radius + step * i;
        value[std::size_t(i)] = plane.At(best.x + r * out.x(), best.y + r * out.y());
      }
      // The rise over two steps, which a pixel of blur does not hide.
      std::array<double, kSteps> rise{};
      std::size_t top = 2;
      for (std::size_t i = 2; i + 2 < kSteps; ++i) {
        rise[i] = value[i + 1] + value[i + 2] - value[i - 1] - value[i - 2];
        if (rise[i] > rise[top]) top = i;
      }
      if (rise[top] < kMinContrast || top == 2 || top + 3 == kSteps) continue;
      const double found = kInner * best.radius +
                           step * (double(top) + Peak(rise[top - 1], rise[top], rise[top + 1]));
      const double off = found - best.radius;
      const double w = 1 / (1 + off * off / (kScatterMm * kScatterMm) / (round == 0 ? 9 : 1));
      const Eigen::Vector3d by(out.x(), out.y(), 1);
      normal += w * by * by.transpose();
      right += w * off * by;
      ++votes;
    }
    if (votes < kRays) return false;
    const Eigen::Vector3d move = SolveSymmetric(normal, right);
    best.x += move.x();
    best.y += move.y();
    best.radius += move.z();
  }
  return best.radius > 0;
}

// Offset in -0.5..0.5 of the top of a parabola through three even samples.
double Peak(double before, double at, double after) {
  const double curvature = before - 2 * at + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Standard error of the median of frames: 1.4826 times the median deviation is the standard
// deviation of a normal scatter; neighbouring frames err alike, so that many count as ten.
double ErrorOfMedian(const std::vector<double>& values) {
  const double median = Median(values);
  std::vector<double> deviations;
  for (const double v : values) deviations.push_back(std::abs(v - median));
  return 1.4826 * Median(deviations) / std::sqrt(std::min(10.0, double(values.size())));
}

// The point at the depth of `expected` (head space) that is seen at `pixel`.
Eigen::Vector3d AtDepthOf(const Eigen::Vector3d& expected, const Camera& camera,
                          const Eigen::Isometry3d& camera_from_head, const Eigen::Vector2d& pixel) {
  const Eigen::Isometry3d head_from_camera = camera_from_head.inverse();
  const Eigen::Vector3d eye = head_from_camera.translation();
  const Eigen::Vector3d ray = head_from_camera.linear() * camera.Direction(pixel.x(), pixel.y());
  return eye + (expected.z() - eye.z()) / ray.z() * ray;
}

}  // namespace

std::optional<Iris> FindIris(const FaceCrop& crop, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, const Eigen::Vector3d& apex,
                             double pd_mm) {
  const Eigen::Vector3d middle = apex - Eigen::Vector3d(0, 0, kIrisBehindApexMm);
  const Eigen::Vector3d at = camera_from_head * middle;
  const double turn =
      std::acos(std::clamp(-camera_from_head.linear().col(2).dot(at.normalized()), -1.0, 1.0));
  if (turn > kMostTurn || crop.grey.empty()) return std::nullopt;
  const auto to_crop = [&](const Eigen::Vector3d& head) -> Eigen::Vector2d {
    return double(crop.grey.width) * crop.region.FromImage(camera.Project(camera_from_head * head));
  };
  IrisPlane plane{crop.grey, to_crop(middle), {}};
  for (int k = 0; k < 2; ++k) {
    plane.map.col(k) = to_crop(middle + Eigen::Vector3d::Unit(k)) - plane.centre;
  }
  const double expected = kIrisDiameterMm / 2 * pd_mm / kTypicalPdMm;
  Best best;
  Search(plane, expected, kSearchAcrossMm, kSearchUpMm, kCoarseStepMm, best);
  const Best coarse = best;
  for (const double factor : kRadiusFactors) {
    Best tried{coarse.x, coarse.y, 0, -1e9};
    Search(plane, factor * expected, 2 * kFineStepMm, 2 * kFineStepMm, kFineStepMm, tried);
    if (tried.contrast > best.contrast) best = tried;
  }
  if (best.contrast < kMinContrast) return std::nullopt;
  // A best place at the border of the search is no place.
  if (std::abs(best.x) > kSearchAcrossMm || std::abs(best.y) > kSearchUpMm) return std::nullopt;
  if (Best rim = best;
      FitRim(plane, rim) && std::abs(rim.radius / best.radius - 1) < kMostRadiusMove) {
    const Eigen::Vector2d found = plane.centre + plane.map * Eigen::Vector2d(rim.x, rim.y);
    return Iris{crop.region.ToImage(found / crop.grey.width), rim.radius, best.contrast};
  }
  const double h = kFineStepMm, r = best.radius, dr = 0.06 * expected;
  const double c = best.contrast;
  const double x = best.x + h * Peak(plane.Contrast(best.x - h, best.y, r), c,
                                     plane.Contrast(best.x + h, best.y, r));
  const double y = best.y + h * Peak(plane.Contrast(best.x, best.y - h, r), c,
                                     plane.Contrast(best.x, best.y + h, r));
  const double radius = r + dr * Peak(plane.Contrast(best.x, best.y, r - dr), c,
                                      plane.Contrast(best.x, best.y, r + dr));
  const Eigen::Vector2d found = plane.centre + plane.map * Eigen::Vector2d(x, y);
  return Iris{crop.region.ToImage(found / crop.grey.width), radius, c};
}

std::optional<IrisSummary> SummariseIrises(const std::vector<IrisReading>& readings,
                                           const Camera& camera,
                                           const std::vector<Eigen::Isometry3d>& poses,
                                           const Pupils& expected) {
  constexpr std::size_t kFewest = 3;
  const Eigen::Vector3d behind(0, 0, kIrisBehindApexMm);
  std::array<std::vector<double>, 6> coordinates;
  std::vector<double> ratios, diameters, distances;
  for (std::size_t f = 0; f < readings.size(); ++f) {
    if (!readings[f].right || !readings[f].left) continue;
    const Eigen::Vector3d right =
        AtDepthOf(expected.right - behind, camera, poses[f], readings[f].right->pixel) + behind;
    const Eigen::Vector3d left =
        AtDepthOf(expected.left - behind, camera, poses[f], readings[f].left->pixel) + behind;
    for (int k = 0; k < 3; ++k) {
      coordinates[std::size_t(k)].push_back(right[k]);
      coordinates[std::size_t(k) + 3].push_back(left[k]);
    }
    diameters.push_back(readings[f].right->radius_mm + readings[f].left->radius_mm);
    distances.push_back((left - right).norm());
    ratios.push_back(distances.back() / diameters.back());
  }
  if (diameters.size() < std::min(kFewest, readings.size())) return std::nullopt;
  if (diameters.empty()) return std::nullopt;
  IrisSummary summary;
  summary.frames = int(diameters.size());
  for (int k = 0; k < 3; ++k) {
    summary.pupils.right[k] = Median(coordinates[std::size_t(k)]);
    summary.pupils.left[k] = Median(coordinates[std::size_t(k) + 3]);
  }
  summary.diameter_mm = Median(diameters);
  const double ratio = Median(ratios);
  summary.distance_sigma_mm = ErrorOfMedian(distances);
  summary.pd_mm = kIrisDiameterMm * ratio;
  summary.pd_sigma_mm = std::hypot(kIrisDiameterMm * ErrorOfMedian(ratios),
                                   summary.pd_mm * kIrisDiameterSigmaMm / kIrisDiameterMm);
  return summary;
}

}  // namespace lorgnette
