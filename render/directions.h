// SPDX-License-Identifier: Apache-2.0
// Sets of directions for integrals of light, in the order that suits packets of 16 rays.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace lorgnette {

// `count` directions spread evenly over the sphere (a spherical Fibonacci lattice), each standing
// for the solid angle 4 pi / count, sorted so that 16 neighbours in the list lie together.
//   count  a multiple of 16
std::vector<Eigen::Vector3f> SphereDirections(int count);

// Directions by columns, as packets take them; their count is a multiple of 16.
struct DirectionColumns {
  std::vector<float> x, y, z;
  DirectionColumns() = default;
  explicit DirectionColumns(const std::vector<Eigen::Vector3f>& directions) {
    for (const Eigen::Vector3f& d : directions) {
      x.push_back(d.x());
      y.push_back(d.y());
      z.push_back(d.z());
    }
  }
  std::size_t size() const { return x.size(); }
  Eigen::Vector3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

// Cosine-weighted directions about +z, stratified and jittered: `rays` of them in rows of equal
// weight (160: 4 rows of 40, the paper's choice), so that the mean over them of f estimates
// (1 / pi) * integral of f cos. Different seeds give different jitter.
std::vector<Eigen::Vector3f> HemisphereStrata(int rays, std::uint64_t seed);

// Rotation whose third column is `normal` (unit); the other two turn smoothly with it except at
// one point (Duff et al., JCGT 6(1), 2017).
Eigen::Matrix3f BasisAbout(const Eigen::Vector3f& normal);

// Real spherical harmonics of degree 0 to 4, orthonormal, of a unit direction.
inline constexpr int kHarmonics = 25;
using Harmonics = std::array<float, kHarmonics>;
Harmonics EvaluateHarmonics(const Eigen::Vector3f& direction);

}  // namespace lorgnette
