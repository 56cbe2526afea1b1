// SPDX-License-Identifier: Apache-2.0
#include "optics/soft_progressive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "optics/banded_system.h"

namespace lorgnette {
namespace {

constexpr int kGridNodes = 23;  // each way
constexpr int kSide = kGridNodes + 2;
constexpr int kBand = 3 * kSide + 3;  // a spline's sixteen coefficients reach three on, either way
constexpr int kSamplesPerCell = 2;    // each way
constexpr int kGaussNewtonSteps = 6;
constexpr double kMostRedrive = 1.5;
constexpr double kMargin_mm = 2.5;  // of the grid beyond the rim

// Curvature tensor of a graph in an orthonormal frame of its tangent plane: mean, and the two
// components whose norm is half the difference of the principal curvatures.
struct Bend {
  double mean, plus, cross;
};
Bend BendOf(const SurfaceJet& j) {
  const double wx = 1 + j.zx * j.zx, w2 = wx + j.zy * j.zy;
  const double w = std::sqrt(w2);
  // e1 along the tangent over x, e2 across it in the surface.
  const double k11 = j.zxx / (wx * w);
  const double k12 = (j.zxy - j.zx * j.zy / wx * j.zxx) / w2;
  const double shear = j.zx * j.zy / wx;
  const double k22 = (j.zyy - 2 * shear * j.zxy + shear * shear * j.zxx) * wx / (w2 * w);
  return {0.5 * (k11 + k22), 0.5 * (k11 - k22), k12};
}

struct Weights {
  double cylinder, mean;
};

// Where the design cares. Lengths in mm along (v) and across (u) the meridian.
Weights WeightsAt(const ProgressiveSurface& hard, double u, double v) {
  const double top = hard.start(), bottom = top - hard.length();
  const double on_meridian = std::exp(-u * u / (2 * 2.5 * 2.5));
  const double corridor = on_meridian * std::exp(-std::pow((v - 0.5 * (top + bottom)) / 14, 2));
  const auto bell = [&](double v0, double wide, double high) {
    return std::exp(-u * u / (2 * wide * wide) - (v - v0) * (v - v0) / (2 * high * high));
  };
  const double far = bell(top + 8, 9, 6), near = bell(bottom - 4, 4, 4);
  return {1 + 30 * corridor + 12 * far + 8 * near, 0.1 + 40 * corridor + 20 * far + 150 * near};
}

// Cubic B-spline weights of the four coefficients around a sample, with derivatives in mm.
struct Row {
  int first;
  double b[4], b1[4], b2[4];
};
Row RowAt(double position, double pitch, int nodes) {
  const double g = position / pitch;
  Row row;
  row.first = std::clamp(int(std::floor(g)), 0, nodes - 2);
  const double u = g - row.first, v = 1 - u;
  const double b[4] = {v * v * v / 6, (4 + 3 * u * u * (u - 2)) / 6, (4 + 3 * v * v * (v - 2)) / 6,
                       u * u * u / 6};
  const double b1[4] = {-0.5 * v * v, u * (1.5 * u - 2), -v * (1.5 * v - 2), 0.5 * u * u};
  const double b2[4] = {v, 3 * u - 2, 3 * v - 2, u};
  for (int k = 0; k < 4; ++k) {
    row.b[k] = b[k];
    row.b1[k] = b1[k] / pitch;
    row.b2[k] = b2[k] / (pitch * pitch);
  }
  return row;
}

// Terms of the sum of squares that share sixteen coefficients, weighted: gradients and residuals.
struct CellRows {
  int count = 0;
  Eigen::Matrix<double, 16, 3 * kSamplesPerCell * kSamplesPerCell> gradients;  // a column a term
  double residuals[3 * kSamplesPerCell * kSamplesPerCell];
};

// The spline's unknowns and the normal equations of one Gauss-Newton step.
class Fit {
 public:
  Fit(const ProgressiveSurface& hard, double index, double half_width)
      : hard_(hard), power_(1000 * (index - 1)), half_(half_width) {
    grid_.base_curvature = hard.curvature_far();
    grid_.x0 = grid_.y0 = -half_width;
    grid_.pitch_x = grid_.pitch_y = 2 * half_width / (kGridNodes - 1);
    grid_.coefficients = Eigen::MatrixXd::Zero(kSide, kSide);
  }

  // False where the equations have no solution.
  bool Step() {
    const int n = kSide * kSide;
    BandedSystem normal(n, kBand);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    const double pitch = grid_.pitch_x / kSamplesPerCell;
    for (int cell_x = 0; cell_x < kGridNodes - 1; ++cell_x) {
      for (int cell_y = 0; cell_y < kGridNodes - 1; ++cell_y) {
        CellRows rows;
        for (int k = 0; k < kSamplesPerCell * kSamplesPerCell; ++k) {
          const int i = kSamplesPerCell * cell_x + k / kSamplesPerCell;
          const int j = kSamplesPerCell * cell_y + k % kSamplesPerCell;
          const double x = -half_ + (i + 0.5) * pitch, y = -half_ + (j + 0.5) * pitch;
          if (x * x + y * y <= half_ * half_) AddSample(x, y, rows);
        }
        AddCell(cell_x, cell_y, rows, normal, right);
      }
    }
    AddVertex(normal, right);
    // A trace of stiffness settles coefficients that no sample touches.
    const double stiff = 1e-9 * normal.MeanDiagonal();
    for (int k = 0; k < n; ++k) {
      normal(k, k) += stiff;
      right(k) -= stiff * Coefficient(k);
    }
    const auto step = normal.SolveInPlace(std::move(right));
    if (!step) return false;
    for (int k = 0; k < n; ++k) Coefficient(k) += (*step)(k);
    Redrive();
    return true;
  }

  // The vertex keeps its place and normal to the last bit: a plane is in the spline's span.
  SplineGrid Finished() const {
    SplineGrid grid = grid_;
    const auto jet = JetOf(Current(), 0, 0);
    for (int i = 0; i < grid.coefficients.rows(); ++i) {
      for (int j = 0; j < grid.coefficients.cols(); ++j) {
        const double x = grid.x0 + (i - 1) * grid.pitch_x, y = grid.y0 + (j - 1) * grid.pitch_y;
        grid.coefficients(i, j) -= jet->z + jet->zx * x + jet->zy * y;
      }
    }
    return grid;
  }

 private:
  // Asks for as much more than the addition as the compromise took away at the near point.
  void Redrive() {
    const double v = hard_.start() - hard_.length();
    const double x = -std::sin(hard_.angle()) * v, y = std::cos(hard_.angle()) * v;
    const GridSurface surface = Current();
    const auto far = JetOf(surface, 0, 0), near = JetOf(surface, x, y);
    if (!far || !near) return;
    const double reached = BendOf(*near).mean - BendOf(*far).mean;
    if (reached > 0) drive_ *= std::min(hard_.curvature_add() / reached, kMostRedrive);
  }
  // The surface as it stands; it holds no copy, and so lives no longer than this.
  GridSurface Current() const { return {{std::shared_ptr<void>(), &grid_}}; }
  double& Coefficient(int k) { return grid_.coefficients(k / kSide, k % kSide); }

  // Adds the term weight * (residual + gradient . step)^2, the gradient by the jet's derivatives.
  static void AddRow(const Row& rx, const Row& ry, double weight, double residual,
                     const std::array<double, 6>& by_jet, CellRows& rows) {
    const double root = std::sqrt(weight);
    auto g = rows.gradients.col(rows.count);
    for (int a = 0; a < 4; ++a) {
      const double by_value = by_jet[0] * rx.b[a] + by_jet[1] * rx.b1[a] + by_jet[3] * rx.b2[a];
      const double by_slope = by_jet[2] * rx.b[a] + by_jet[4] * rx.b1[a];
      const double by_bend = by_jet[5] * rx.b[a];
      for (int b = 0; b < 4; ++b) {
        g(4 * a + b) = root * (by_value * ry.b[b] + by_slope * ry.b1[b] + by_bend * ry.b2[b]);
      }
    }
    rows.residuals[rows.count++] = root * residual;
  }

  // All of a cell's terms at once: its sixteen coefficients are the same for all.
  static void AddCell(int cell_x, int cell_y, const CellRows& rows, BandedSystem& normal,
                      Eigen::VectorXd& right) {
    const auto place = [&](int k) { return (cell_x + k / 4) * kSide + cell_y + k % 4; };
    for (int q = 0; q < 16; ++q) {
      for (int p = q / 4 * 4; p < 16; p += 4) {
        Eigen::Vector4d sums = Eigen::Vector4d::Zero();
        for (int k = 0; k < rows.count; ++k) {
          sums += rows.gradients(q, k) * rows.gradients.block<4, 1>(p, k);
        }
        for (int r = std::max(p, q); r < p + 4; ++r) normal(place(r), place(q)) += sums(r - p);
      }
      for (int k = 0; k < rows.count; ++k) {
        right(place(q)) -= rows.gradients(q, k) * rows.residuals[k];
      }
    }
  }

  void AddSample(double x, double y, CellRows& rows) const {
    const auto jet = JetOf(Current(), x, y);
    if (!jet) return;
    const double co = -std::sin(hard_.angle()), si = std::cos(hard_.angle());
    const double u = si * x - co * y, v = co * x + si * y;
    const Weights weights = WeightsAt(hard_, u, v);
    const double s = std::clamp((hard_.start() - v) / hard_.length(), 0.0, 1.0);
    const double wanted = hard_.curvature_far() +
                          drive_ * hard_.curvature_add() * s * s * s * (10 + s * (-15 + 6 * s));
    const Row rx = RowAt(x + half_, grid_.pitch_x, kGridNodes);
    const Row ry = RowAt(y + half_, grid_.pitch_y, kGridNodes);

    const Bend bend = BendOf(*jet);
    std::array<double, 6> by_mean{}, by_plus{}, by_cross{};
    const auto differentiate = [&](double SurfaceJet::*field, int slot, double step) {
      SurfaceJet up = *jet, down = *jet;
      up.*field += step;
      down.*field -= step;
      const Bend a = BendOf(up), b = BendOf(down);
      by_mean[slot] = (a.mean - b.mean) / (2 * step);
      by_plus[slot] = (a.plus - b.plus) / (2 * step);
      by_cross[slot] = (a.cross - b.cross) / (2 * step);
    };
    differentiate(&SurfaceJet::zx, 1, 1e-5);
    differentiate(&SurfaceJet::zy, 2, 1e-5);
    differentiate(&SurfaceJet::zxx, 3, 1e-6);
    differentiate(&SurfaceJet::zxy, 4, 1e-6);
    differentiate(&SurfaceJet::zyy, 5, 1e-6);
    const double p2 = power_ * power_;
    AddRow(rx, ry, weights.mean * p2, bend.mean - wanted, by_mean, rows);
    AddRow(rx, ry, 4 * weights.cylinder * p2, bend.plus, by_plus, rows);
    AddRow(rx, ry, 4 * weights.cylinder * p2, bend.cross, by_cross, rows);
  }

  // The spline adds neither height nor slope at the vertex: a plane is in its span, so this holds
  // to rounding and costs the design nothing.
  void AddVertex(BandedSystem& normal, Eigen::VectorXd& right) const {
    const auto jet = JetOf(Current(), 0, 0);
    const Row r = RowAt(half_, grid_.pitch_x, kGridNodes);
    constexpr double kHard = 1e6;
    CellRows rows;
    AddRow(r, r, kHard, jet->z, {1, 0, 0, 0, 0, 0}, rows);
    AddRow(r, r, kHard, jet->zx, {0, 1, 0, 0, 0, 0}, rows);
    AddRow(r, r, kHard, jet->zy, {0, 0, 1, 0, 0, 0}, rows);
    AddCell(r.first, r.first, rows, normal, right);
  }

  const ProgressiveSurface& hard_;
  double power_, half_, drive_ = 1;
  SplineGrid grid_;
};

}  // namespace

Result<Surface> SoftProgressive(const ProgressiveSurface& hard, double index,
                                double rim_radius_mm) {
  const double half = rim_radius_mm + kMargin_mm;
  if (half * std::sqrt(2.0) * std::abs(hard.curvature_far() + hard.curvature_add()) >= 0.98) {
    return Failure(
        "lens: the progressive front is too steep for this outline; possible: a flatter "
        "base curve or a smaller outline");
  }
  Fit fit(hard, index, half);
  for (int i = 0; i < kGaussNewtonSteps; ++i) {
    if (!fit.Step()) return Failure("lens: no soft progressive front is found for this outline");
  }
  return Surface(GridSurface{std::make_shared<SplineGrid>(fit.Finished())});
}

std::optional<FrontPower> FrontPowerAt(const Surface& surface, double x, double y, double index) {
  const auto jet = surface.Jet(x, y);
  if (!jet) return std::nullopt;
  const Bend bend = BendOf(*jet);
  const double f = 1000 * (index - 1);
  return FrontPower{f * bend.mean, 2 * f * std::hypot(bend.plus, bend.cross)};
}

ProgressiveZones ZonesOf(const Surface& surface, const Eigen::Vector2d& near_point, double index) {
  constexpr double kPitch_mm = 0.5;
  ProgressiveZones zones;
  const auto cylinder = [&](double x, double y) {
    const auto power = FrontPowerAt(surface, x, y, index);
    return power ? power->cylinder : HUGE_VAL;
  };
  const int reach = int(kSoftTestRadius_mm / kPitch_mm);
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const double x = i * kPitch_mm, y = j * kPitch_mm;
      if (std::hypot(x, y) > kSoftTestRadius_mm) continue;
      zones.worst_cylinder_D = std::max(zones.worst_cylinder_D, cylinder(x, y));
    }
  }
  // Width of the clear stretch around the meridian at height y.
  const auto width = [&](double y) {
    const double middle = y < 0 && near_point.y() < 0 ? near_point.x() * y / near_point.y() : 0;
    double total = 0;
    for (const double side : {-1.0, 1.0}) {
      double x = 0;
      while (x < kSoftTestRadius_mm && cylinder(middle + side * x, y) < kClearCylinder_D) {
        x += 0.1 * kPitch_mm;
      }
      total += x;
    }
    return total;
  };
  zones.far_width_mm = width(0);
  zones.near_width_mm = width(near_point.y());
  zones.corridor_width_mm = HUGE_VAL;
  for (double y = 0; y >= near_point.y(); y -= kPitch_mm) {
    zones.corridor_width_mm = std::min(zones.corridor_width_mm, width(y));
  }
  const auto far = FrontPowerAt(surface, 0, 0, index);
  const auto near = FrontPowerAt(surface, near_point.x(), near_point.y(), index);
  if (far && near) zones.addition_D = near->mean - far->mean;
  return zones;
}

}  // namespace lorgnette
