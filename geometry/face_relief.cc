// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_relief.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lorgnette {

FaceRelief::FaceRelief(const TriangleMesh& face, double step_mm, double reach_mm,
                       double deepest_z_mm)
    : step_(step_mm), reach_(reach_mm), size_(int(2 * reach_mm / step_mm) + 1) {
  z_.assign(std::size_t(size_) * std::size_t(size_), std::numeric_limits<float>::quiet_NaN());
  for (const Eigen::Vector3i& t : face.triangles) {
    const Eigen::Vector3d& a = face.positions[std::size_t(t[0])];
    const Eigen::Vector3d& b = face.positions[std::size_t(t[1])];
    const Eigen::Vector3d& c = face.positions[std::size_t(t[2])];
    const double area = (b - a).head<2>().x() * (c - a).y() - (b - a).y() * (c - a).x();
    if (std::abs(area) < 1e-12 || std::min({a.z(), b.z(), c.z()}) < deepest_z_mm) continue;
    const auto index = [&](double v) { return (v + reach_) / step_; };
    const int x0 = std::max(0, int(std::ceil(index(std::min({a.x(), b.x(), c.x()})))));
    const int x1 = std::min(size_ - 1, int(std::floor(index(std::max({a.x(), b.x(), c.x()})))));
    const int y0 = std::max(0, int(std::ceil(index(std::min({a.y(), b.y(), c.y()})))));
    const int y1 = std::min(size_ - 1, int(std::floor(index(std::max({a.y(), b.y(), c.y()})))));
    for (int j = y0; j <= y1; ++j) {
      for (int i = x0; i <= x1; ++i) {
        const Eigen::Vector2d d(i * step_ - reach_ - a.x(), j * step_ - reach_ - a.y());
        const double v = (d.x() * (c - a).y() - d.y() * (c - a).x()) / area;
        const double w = ((b - a).x() * d.y() - (b - a).y() * d.x()) / area;
        if (v < -1e-9 || w < -1e-9 || v + w > 1 + 1e-9) continue;
        const float z = float(a.z() + v * (b - a).z() + w * (c - a).z());
        float& cell = z_[std::size_t(j) * std::size_t(size_) + std::size_t(i)];
        if (std::isnan(cell) || z > cell) cell = z;
      }
    }
  }
}

std::optional<double> FaceRelief::Height(double x, double y) const {
  const double fx = (x + reach_) / step_, fy = (y + reach_) / step_;
  if (!(fx >= 0 && fy >= 0 && fx < size_ - 1 && fy < size_ - 1)) return std::nullopt;
  const int i = int(fx), j = int(fy);
  const double u = fx - i, v = fy - j;
  const auto at = [&](int p, int q) {
    return double(z_[std::size_t(q) * std::size_t(size_) + std::size_t(p)]);
  };
  const double z = (1 - u) * (1 - v) * at(i, j) + u * (1 - v) * at(i + 1, j) +
                   (1 - u) * v * at(i, j + 1) + u * v * at(i + 1, j + 1);
  return std::isnan(z) ? std::nullopt : std::optional(z);
}

std::optional<Eigen::Vector3d> FaceRelief::Normal(double x, double y) const {
  const auto left = Height(x - step_, y), right = Height(x + step_, y);
  const auto below = Height(x, y - step_), above = Height(x, y + step_);
  if (!left || !right || !below || !above) return std::nullopt;
  return Eigen::Vector3d((*left - *right) / (2 * step_), (*below - *above) / (2 * step_), 1)
      .normalized();
}

}  // namespace lorgnette
