// SPDX-License-Identifier: Apache-2.0
// The forms a lens surface can have. Each is the graph z = sag(x, y) over the tangent plane at its
// vertex (optics/surface.h has what is common to all). Source: docs/optics.md, "Surfaces".
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

namespace lorgnette {

// Sag and derivatives at one point: mm, -, -, 1/mm, 1/mm, 1/mm.
struct SurfaceJet {
  double z = 0, zx = 0, zy = 0, zxx = 0, zxy = 0, zyy = 0;
};

// Sphere or plane.
struct SphereSurface {
  double curvature = 0;  // 1/mm
};

// Exact torus: a circle of curvature `curvature_generator` lying in the generator meridian,
// revolved about an axis parallel to that meridian, so that the curvature at the vertex across it
// is `curvature_across`. Which circle generates is part of the form, not of the powers.
struct TorusSurface {
  double curvature_generator = 0;  // 1/mm
  double curvature_across = 0;     // 1/mm
  double generator_angle = 0;      // radians from +x toward +y of the generator meridian
};

// Surface of revolution: z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + a6 r^6 + ...
// Jalie's p is 1 + k.
struct ConicSurface {
  double curvature = 0;          // 1/mm
  double conic = 0;              // k: 0 circle, -1 parabola
  std::array<double, 4> even{};  // a4, a6, a8, a10 in mm^-3, mm^-5, mm^-7, mm^-9
};

// A torus whose two sections are conics with a fourth-order term in the generator:
//   g(v) = conic(c_g, k_g; v) + a4 v^4,   z = g + conic(c_a / (1 - c_a g), k_a; u)
// with v along the generator meridian, u across it. k = 0 and a4 = 0 give the torus.
struct AtoroidSurface {
  double curvature_generator = 0, curvature_across = 0;  // 1/mm
  double conic_generator = 0, conic_across = 0;
  double a4_generator = 0;  // mm^-3
  double generator_angle = 0;
};

// Progressive surface with an exactly umbilic meridian and circular horizontal sections. Power
// rises along -y from `start` over `length` by the smooth step 10u^3 - 15u^4 + 6u^5; above and
// below it is an exact sphere. A hard design: full-width zones, strong astigmatism beside the
// corridor. `angle` turns it about its vertex (radians, from +y toward -x), for the inset.
class ProgressiveSurface {
 public:
  ProgressiveSurface() = default;
  // curvatures in 1/mm: of the far zone, and what the near zone adds; start and length in mm, the
  // start at or below the vertex (start <= 0), length > 0.
  ProgressiveSurface(double curvature_far, double curvature_add, double start, double length,
                     double angle = 0);
  double curvature_far() const { return far_; }
  double curvature_add() const { return add_; }
  double start() const { return start_; }
  double length() const { return length_; }
  double angle() const { return angle_; }

  // In the surface's own axes, y along the umbilic. nullopt where the sphere would end.
  std::optional<SurfaceJet> OwnJet(double x, double y) const;

 private:
  struct Meridian;
  bool MeridianAt(double y, Meridian& m) const;
  double SlopeSine(double y) const;
  double far_ = 0, add_ = 0, start_ = 0, length_ = 1, angle_ = 0;
  double corridor_end_sag_ = 0;  // sag at the lower end of the corridor
};

// A sphere with a segment of another curvature: round, flat-topped, or everything below a line. The
// segment's sphere shares the main sphere's normal over `center`, its optical centre, and is raised
// so that both meet along the circle of `radius` about that normal (no rise where there is no
// circle). Across the top line the surface has a ledge: the graph jumps there.
struct BifocalSurface {
  double curvature = 0, curvature_segment = 0;  // 1/mm
  Eigen::Vector2d center{0, 0};                 // mm, in (x, y)
  double radius = 0;                            // mm; 0: the segment has no lower boundary
  double top = 0;                               // the segment ends at y = center.y + top

  // The segment's sphere: a point of it over `center`, and the common normal there (toward +z).
  struct Frame {
    Eigen::Vector3d vertex, normal;
  };
  Frame SegmentFrame() const;
  // Whether a point of the segment's sphere belongs to the segment.
  bool Holds(const Frame& frame, const Eigen::Vector3d& point) const;
};

// Bicubic B-spline over a regular grid, on top of a sphere: C2, exact for cubics. Node (i, j) lies
// at (x0 + i pitch_x, y0 + j pitch_y); coefficients carry one more row and column on every side.
struct SplineGrid {
  double base_curvature = 0;  // 1/mm, of the sphere that the spline is added to
  double x0 = 0, y0 = 0, pitch_x = 1, pitch_y = 1;  // mm
  Eigen::MatrixXd coefficients;                     // (nx + 2) x (ny + 2), indexed [i + 1, j + 1]

  int nx() const { return int(coefficients.rows()) - 2; }
  int ny() const { return int(coefficients.cols()) - 2; }
  // The spline that passes through nx x ny sags (mm) with not-a-knot ends; at least 4 x 4.
  static SplineGrid Through(const Eigen::MatrixXd& sag, double x0, double y0, double pitch_x,
                            double pitch_y, double base_curvature);
};
struct GridSurface {
  std::shared_ptr<const SplineGrid> grid;  // never null in a Surface; holds the vertex (0, 0)
};

std::optional<SurfaceJet> JetOf(const SphereSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const TorusSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const ConicSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const AtoroidSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const ProgressiveSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const BifocalSurface& s, double x, double y);
std::optional<SurfaceJet> JetOf(const GridSurface& s, double x, double y);

// A jet known in axes (u, v) with v = (co, si) and u = (si, -co), expressed in (x, y).
SurfaceJet RotatedJet(const SurfaceJet& jet, double si, double co);

}  // namespace lorgnette
