// SPDX-License-Identifier: Apache-2.0
#include "render/face_light.h"

#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/units.h"
#include "render/directions.h"
#include "render/picture_view.h"

namespace lorgnette {
namespace {

constexpr int kTerms = FaceLight::kTerms;
constexpr int kFewestVertices = 60;
constexpr int kMapWidth = 64;
// A vertex whose normal leans farther from the camera shares its pixel with the background.
constexpr double kLeastCosine = 0.3;
// Beside the fit's own weights: how much a term of degree 1 and 2 costs.
constexpr double kSmoothness[3] = {1e-4, 0.004, 0.012};
constexpr int kRounds = 6;  // of reweighting: eyes, brows and lips are no skin

int DegreeOf(int term) { return term == 0 ? 0 : term < 4 ? 1 : 2; }

// Of the clamped cosine: irradiance of a radiance harmonic.
double CosineTerm(int degree) { return degree == 0 ? kPi : degree == 1 ? 2 * kPi / 3 : kPi / 4; }

using Terms = Eigen::Matrix<double, kTerms, 1>;

Terms TermsAt(const Eigen::Vector3f& direction) {
  const Harmonics all = EvaluateHarmonics(direction);
  Terms terms;
  for (int i = 0; i < kTerms; ++i) terms[i] = double(all[std::size_t(i)]);
  return terms;
}

// Harmonics of a map, degree 2.
FaceLight Project(const Environment& environment) {
  FaceLight light;
  Eigen::Matrix<double, kTerms, 3> sum = Eigen::Matrix<double, kTerms, 3>::Zero();
  const ImageRgbF& map = environment.map();
  const double texel = 2 * kPi / map.width * kPi / map.height;
  for (int y = 0; y < map.height; ++y) {
    const double area = texel * std::cos(kPi * (0.5 - (y + 0.5) / map.height));
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Map<const Eigen::Vector3f> value(map.at(x, y));
      sum += area * TermsAt(environment.Direction(x + 0.5, y + 0.5)) *
             value.cast<double>().transpose();
    }
  }
  for (int i = 0; i < kTerms; ++i) {
    light.radiance[std::size_t(i)] = sum.row(i).transpose().cast<float>();
  }
  return light;
}

}  // namespace

Eigen::Vector3f FaceLight::At(const Eigen::Vector3f& world_direction) const {
  const Harmonics all = EvaluateHarmonics(world_direction.normalized());
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < kTerms; ++i) sum += all[i] * radiance[i];
  return sum.cwiseMax(0.0f);
}

std::optional<FaceLight> FitFaceLight(const ImageRgbF& input, const Camera& camera,
                                      const Eigen::Isometry3d& camera_from_head,
                                      const TriangleMesh& face,
                                      const Eigen::Matrix3d& world_from_camera) {
  struct Seen {
    Terms terms;  // irradiance / pi of each harmonic of the light
    Eigen::Vector3d colour;
  };
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < face.positions.size(); ++i) {
    const Eigen::Vector3d p = camera_from_head * face.positions[i];
    if (p.z() <= 1) continue;
    const Eigen::Vector3d normal = camera_from_head.linear() * face.normals[i];
    if (-normal.dot(p.normalized()) < kLeastCosine) continue;
    const Eigen::Vector2d at = camera.Project(p);
    if (at.x() < 0 || at.y() < 0 || at.x() > input.width || at.y() > input.height) continue;
    Terms terms = TermsAt((world_from_camera * normal).cast<float>());
    for (int k = 0; k < kTerms; ++k) terms[k] *= CosineTerm(DegreeOf(k)) / kPi;
    seen.push_back({terms, SampleBilinear(input, float(at.x()), float(at.y())).cast<double>()});
  }
  if (seen.size() < kFewestVertices) return std::nullopt;

  using Square = Eigen::Matrix<double, kTerms, kTerms>;
  using Columns = Eigen::Matrix<double, kTerms, 3>;
  std::vector<double> weight(seen.size(), 1);
  Columns fit = Columns::Zero();
  FaceLight light;
  for (int round = 0; round < kRounds; ++round) {
    Square normal = Square::Zero();
    Columns right = Columns::Zero();
    double total = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      normal += weight[i] * seen[i].terms * seen[i].terms.transpose();
      right += weight[i] * seen[i].terms * seen[i].colour.transpose();
      total += weight[i];
    }
    for (int k = 0; k < kTerms; ++k) normal(k, k) += total * kSmoothness[DegreeOf(k)];
    fit = SolveSymmetric(normal, right);
    // Errors beyond twice the median count less (Huber).
    std::vector<double> errors;
    double mean = 0, squares = 0;
    for (const Seen& s : seen) {
      errors.push_back((fit.transpose() * s.terms - s.colour).norm());
      mean += s.colour.norm() / double(seen.size());
    }
    std::vector<double> sorted = errors;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2),
                     sorted.end());
    const double knee = std::max(2 * sorted[sorted.size() / 2], 1e-9);
    double weights = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      weight[i] = errors[i] <= knee ? 1 : knee / errors[i];
      squares += weight[i] * errors[i] * errors[i];
      weights += weight[i];
    }
    if (!(mean > 0)) return std::nullopt;
    light.residual = std::sqrt(squares / weights) / mean;
  }
  for (int k = 0; k < kTerms; ++k) {
    light.radiance[std::size_t(k)] = fit.row(k).transpose().cast<float>();
  }
  if (!(light.radiance[0].maxCoeff() > 0)) return std::nullopt;
  return light;
}

Environment EnvironmentOf(const FaceLight& light) {
  const Environment grid(ImageRgbF(kMapWidth, kMapWidth / 2));
  ImageRgbF map(kMapWidth, kMapWidth / 2);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Vector3f value = light.At(grid.Direction(x + 0.5, y + 0.5));
      std::copy(value.data(), value.data() + 3, map.at(x, y));
    }
  }
  return Environment(std::move(map));
}

Environment Relit(const Environment& detail, const FaceLight& light) {
  const FaceLight own = Project(detail);
  const float own_mean = own.radiance[0].mean(), mean = light.radiance[0].mean();
  if (!(own_mean > 0) || !(mean > 0)) return EnvironmentOf(light);
  // Harmonics ring: neither light is taken for darker than this share of its mean.
  constexpr float kFloor = 0.2f;
  const float y00 = 0.28209479f;  // the first harmonic
  ImageRgbF map = detail.map();
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Vector3f d = detail.Direction(x + 0.5, y + 0.5);
      const Eigen::Vector3f before = own.At(d).cwiseMax(kFloor * y00 * own_mean);
      const Eigen::Vector3f after = light.At(d).cwiseMax(kFloor * y00 * mean);
      for (int c = 0; c < 3; ++c) {
        map.at(x, y)[c] *= (after[c] / before[c]) * (own_mean / mean);
      }
    }
  }
  return Environment(std::move(map));
}

}  // namespace lorgnette
