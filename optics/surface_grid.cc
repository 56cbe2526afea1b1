// SPDX-License-Identifier: Apache-2.0
// The bicubic spline of a measured or computed surface.
#include <Eigen/LU>
#include <cmath>

#include "base/check.h"
#include "optics/surface_shapes.h"

namespace lorgnette {
namespace {

// Values and derivatives (by the node index) of the four B-splines over a cell at u in [0, 1].
struct Basis {
  double b[4], b1[4], b2[4];

  explicit Basis(double u) {
    const double v = 1 - u;
    b[0] = v * v * v / 6;
    b[1] = (4 + 3 * u * u * (u - 2)) / 6;
    b[2] = (4 + 3 * v * v * (v - 2)) / 6;
    b[3] = u * u * u / 6;
    b1[0] = -0.5 * v * v;
    b1[1] = u * (1.5 * u - 2);
    b1[2] = -v * (1.5 * v - 2);
    b1[3] = 0.5 * u * u;
    b2[0] = v;
    b2[1] = 3 * u - 2;
    b2[2] = 3 * v - 2;
    b2[3] = u;
  }
};

// Maps n node values to n + 2 coefficients: interpolation, and the third derivative continuous
// across the second and the last but one node.
Eigen::MatrixXd Interpolation(int n) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 2, n + 2);
  for (int i = 0; i < n; ++i) {
    a(i, i) = a(i, i + 2) = 1.0 / 6;
    a(i, i + 1) = 4.0 / 6;
  }
  const double ends[5] = {1, -4, 6, -4, 1};
  for (int k = 0; k < 5; ++k) {
    a(n, k) = ends[k];
    a(n + 1, n + 1 - k) = ends[k];
  }
  return a;
}

}  // namespace

SplineGrid SplineGrid::Through(const Eigen::MatrixXd& sag, double x0, double y0, double pitch_x,
                               double pitch_y, double base_curvature) {
  const int nx = int(sag.rows()), ny = int(sag.cols());
  LG_CHECK_GE(nx, 4);
  LG_CHECK_GE(ny, 4);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(nx + 2, ny + 2);
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const auto base = JetOf(SphereSurface{base_curvature}, x0 + i * pitch_x, y0 + j * pitch_y);
      LG_CHECK(base.has_value());
      values(i, j) = sag(i, j) - base->z;
    }
  }
  const Eigen::MatrixXd along = Interpolation(nx).partialPivLu().solve(values);
  SplineGrid grid;
  grid.base_curvature = base_curvature;
  grid.x0 = x0;
  grid.y0 = y0;
  grid.pitch_x = pitch_x;
  grid.pitch_y = pitch_y;
  grid.coefficients = Interpolation(ny).partialPivLu().solve(along.transpose()).transpose();
  return grid;
}

std::optional<SurfaceJet> JetOf(const GridSurface& s, double x, double y) {
  const SplineGrid& grid = *s.grid;
  const double gx = (x - grid.x0) / grid.pitch_x, gy = (y - grid.y0) / grid.pitch_y;
  if (!(gx >= 0 && gy >= 0 && gx <= grid.nx() - 1 && gy <= grid.ny() - 1)) return std::nullopt;
  auto jet = JetOf(SphereSurface{grid.base_curvature}, x, y);
  if (!jet) return std::nullopt;
  const int i = std::min(int(gx), grid.nx() - 2), j = std::min(int(gy), grid.ny() - 2);
  const Basis bx(gx - i), by(gy - j);
  SurfaceJet w;
  for (int a = 0; a < 4; ++a) {
    double f = 0, fy = 0, fyy = 0;
    for (int b = 0; b < 4; ++b) {
      const double c = grid.coefficients(i + a, j + b);
      f += by.b[b] * c;
      fy += by.b1[b] * c;
      fyy += by.b2[b] * c;
    }
    w.z += bx.b[a] * f;
    w.zx += bx.b1[a] * f;
    w.zxx += bx.b2[a] * f;
    w.zy += bx.b[a] * fy;
    w.zxy += bx.b1[a] * fy;
    w.zyy += bx.b[a] * fyy;
  }
  const double px = grid.pitch_x, py = grid.pitch_y;
  jet->z += w.z;
  jet->zx += w.zx / px;
  jet->zy += w.zy / py;
  jet->zxx += w.zxx / (px * px);
  jet->zxy += w.zxy / (px * py);
  jet->zyy += w.zyy / (py * py);
  return jet;
}

}  // namespace lorgnette
