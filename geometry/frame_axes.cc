// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_axes.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/units.h"
#include "geometry/silhouette.h"

namespace lorgnette {
namespace {

constexpr double kLeastWidth_mm = 118, kGreatestWidth_mm = 165, kMeanWidth_mm = 140;
constexpr double kSilliestWidth_mm = 90, kWidestWidth_mm = 190;  // for a unit that the file states
constexpr double kLeastOpening_mm2 = 250;
constexpr double kFlatFront_mm = 40;  // less deep than this: there are no temples
constexpr double kMirrorCell = 0.02;  // of the extent
constexpr double kMirrorGain = 0.1;   // by which other axes must be better than the file's
constexpr double kSymmetric = 0.6;  // share of mirrored vertices that makes an axis the one across
constexpr double kLikeSize = 0.7, kLeastFill = 0.55, kLongestLens = 3;
constexpr double kFrontStep_deg = 15;

struct Box {
  Eigen::Vector3d low, high;
  Eigen::Vector3d size() const { return high - low; }
  Eigen::Vector3d middle() const { return (low + high) / 2; }
};
Box BoxOf(const TriangleMesh& mesh) {
  Box box{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), {}};
  box.high = -box.low;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      box.low = box.low.cwiseMin(mesh.positions[std::size_t(t[k])]);
      box.high = box.high.cwiseMax(mesh.positions[std::size_t(t[k])]);
    }
  }
  return box;
}

TriangleMesh Turned(const TriangleMesh& mesh, const Eigen::Matrix3d& turn) {
  TriangleMesh turned;
  turned.triangles = mesh.triangles;
  for (const Eigen::Vector3d& p : mesh.positions) turned.positions.emplace_back(turn * p);
  return turned;
}

// Two openings (or lenses) of like size beside each other.
struct Openings {
  SilhouetteRegion a, b;
  double least() const { return std::min(a.area_mm2, b.area_mm2); }
};
std::optional<Openings> TwoOfLikeSize(const std::vector<SilhouetteRegion>& regions) {
  if (regions.size() < 2 || regions[1].area_mm2 < kLeastOpening_mm2) return std::nullopt;
  if (regions[1].area_mm2 < kLikeSize * regions[0].area_mm2) return std::nullopt;
  return Openings{regions[0], regions[1]};
}
std::optional<Openings> FindOpenings(const TriangleMesh& mesh) {
  return TwoOfLikeSize(SilhouetteHoles(mesh));
}
// Two discs and nothing else, each on its own side and filling its box as a lens does.
std::optional<Openings> FindDiscs(const TriangleMesh& lenses) {
  std::vector<SilhouetteRegion> discs = SilhouetteDiscs(lenses);
  std::erase_if(discs, [](const SilhouetteRegion& d) { return d.area_mm2 < kLeastOpening_mm2; });
  const auto two = discs.size() == 2 ? TwoOfLikeSize(discs) : std::nullopt;
  if (!two) return std::nullopt;
  for (const SilhouetteRegion& disc : discs) {
    const Eigen::Vector2d size = disc.high - disc.low;
    if (disc.area_mm2 < kLeastFill * size.x() * size.y()) return std::nullopt;
    if (size.maxCoeff() > kLongestLens * size.minCoeff()) return std::nullopt;
  }
  const bool apart = two->a.high.x() < two->b.low.x() || two->b.high.x() < two->a.low.x();
  return apart ? two : std::nullopt;
}

// Axes of the surface's second moments, as rows: one of them is square to a plane of symmetry.
Eigen::Matrix3d PrincipalAxes(const TriangleMesh& mesh) {
  Eigen::Vector3d sum(0, 0, 0);
  double total = 0;
  const auto for_each = [&](const auto& take) {
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const Eigen::Vector3d& a = mesh.positions[std::size_t(t[0])];
      const Eigen::Vector3d& b = mesh.positions[std::size_t(t[1])];
      const Eigen::Vector3d& c = mesh.positions[std::size_t(t[2])];
      take((b - a).cross(c - a).norm() / 2, Eigen::Vector3d((a + b + c) / 3));
    }
  };
  for_each([&](double area, const Eigen::Vector3d& p) {
    sum += area * p;
    total += area;
  });
  if (!(total > 0)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for_each([&](double area, const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p - sum / total;
    moments += area / total * d * d.transpose();
  });
  Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().transpose();
  if (axes.determinant() < 0) axes.row(0) *= -1;
  return axes;
}

// The axis that the mesh is most symmetric across, and how much.
std::pair<int, double> MostSymmetric(const TriangleMesh& mesh) {
  std::pair<int, double> best(0, -1);
  for (int axis = 0; axis < 3; ++axis) {
    const double share = MirrorShare(mesh, axis);
    if (share > best.second) best = {axis, share};
  }
  return best;
}

Eigen::Matrix3d AxisMatrix(int x, int y, int z) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, x) = m(1, y) = m(2, z) = 1;
  if (m.determinant() < 0) m.row(0) *= -1;
  return m;
}

// Median z of the vertices around the openings.
double FrontDepth(const TriangleMesh& mesh, const Openings& openings) {
  std::vector<double> depths;
  for (const Eigen::Vector3d& p : mesh.positions) {
    for (const SilhouetteRegion* hole : {&openings.a, &openings.b}) {
      const double radius = std::sqrt(hole->area_mm2 / kPi);
      if ((p.head<2>() - hole->centre).norm() < 1.35 * radius) {
        depths.push_back(p.z());
        break;
      }
    }
  }
  if (depths.empty()) return 0;
  std::nth_element(depths.begin(), depths.begin() + long(depths.size() / 2), depths.end());
  return depths[depths.size() / 2];
}

// How much higher the temples are in their middle than at their ends; for a front alone, how much
// higher the bridge is than the openings. Positive: +y is up.
double Upness(const TriangleMesh& mesh, const Box& box, const Openings& openings) {
  const double depth = box.size().z();
  double end = 0, middle = 0;
  long ends = 0, middles = 0;
  for (const Eigen::Vector3d& p : mesh.positions) {
    const double share = (p.z() - box.low.z()) / depth;  // 0 at the tips, 1 in front
    if (share < 0.06) {
      end += p.y();
      ++ends;
    } else if (share > 0.35 && share < 0.75) {
      middle += p.y();
      ++middles;
    }
  }
  if (depth > kFlatFront_mm && ends > 0 && middles > 0) {
    const double drop = middle / double(middles) - end / double(ends);
    if (std::abs(drop) > 3) return drop;
  }
  double bridge = 0;
  long count = 0;
  const double x = box.middle().x(), front = FrontDepth(mesh, openings);
  for (const Eigen::Vector3d& p : mesh.positions) {
    if (std::abs(p.x() - x) < 4 && std::abs(p.z() - front) < 12) {
      bridge += p.y();
      ++count;
    }
  }
  if (count == 0) return 1;
  return bridge / double(count) - (openings.a.centre.y() + openings.b.centre.y()) / 2;
}

}  // namespace

double MirrorShare(const TriangleMesh& mesh, int axis) {
  const Box box = BoxOf(mesh);
  const double cell = kMirrorCell * box.size().maxCoeff();
  if (!(cell > 0)) return 0;
  using Cell = std::array<int, 3>;
  const auto cell_of = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = (p - box.low) / cell;
    return Cell{int(std::floor(q.x())), int(std::floor(q.y())), int(std::floor(q.z()))};
  };
  std::set<Cell> cells;
  for (const Eigen::Vector3d& p : mesh.positions) cells.insert(cell_of(p));
  long found = 0;
  for (Eigen::Vector3d p : mesh.positions) {
    p[axis] = box.low[axis] + box.high[axis] - p[axis];
    found += long(cells.count(cell_of(p)));
  }
  return double(found) / double(std::max<std::size_t>(1, mesh.positions.size()));
}

std::optional<FrameAxes> FindFrameAxes(const TriangleMesh& mesh, std::optional<double> unit_mm,
                                       const TriangleMesh* lenses, bool scan) {
  Eigen::Matrix3d base = Eigen::Matrix3d::Identity();  // file to axes that fit the glasses
  auto [side, share] = MostSymmetric(mesh);
  bool turned_in_space = false;
  if (scan && share < kSymmetric) {
    const Eigen::Matrix3d principal = PrincipalAxes(mesh);
    const auto [other, other_share] = MostSymmetric(Turned(mesh, principal));
    if (other_share > share + kMirrorGain) {
      base = principal;
      side = other;
      turned_in_space = true;
    }
  }
  const double width = BoxOf(Turned(mesh, base)).size()[side];
  if (!(width > 0) || !std::isfinite(width)) return std::nullopt;

  FrameAxes axes;
  double scale = unit_mm.value_or(0);
  if (unit_mm && (scale * width < kSilliestWidth_mm || scale * width > kWidestWidth_mm)) {
    axes.notes.push_back(
        fmt::format("unit: the file's {} mm makes the frame {:.0f} mm wide; not believed", scale,
                    scale * width));
    scale = 0;
  }
  if (scale == 0) {
    for (const double candidate : {1.0, 10.0, 1000.0, 25.4}) {
      const double mm = candidate * width;
      if (scale == 0 && mm >= kLeastWidth_mm && mm <= kGreatestWidth_mm) scale = candidate;
    }
    const bool fits = scale != 0;
    if (!fits) scale = kMeanWidth_mm / width;
    axes.notes.push_back(
        fmt::format("unit guessed: {:.4g} mm, so that the frame is {:.0f} mm wide{}", scale,
                    scale * width, fits ? "" : " as frames are on average; give the unit"));
  }

  std::optional<Openings> openings;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  const auto look = [&](const Eigen::Matrix3d& tried) {
    const auto found =
        lenses != nullptr ? FindDiscs(Turned(*lenses, tried)) : FindOpenings(Turned(mesh, tried));
    if (found && (!openings || found->least() > openings->least())) {
      openings = found;
      turn = tried;
    }
  };
  const Eigen::Matrix3d first = scale * AxisMatrix(side, (side + 1) % 3, (side + 2) % 3) * base;
  if (!turned_in_space) {
    look(first);
    look(scale * AxisMatrix(side, (side + 2) % 3, (side + 1) % 3) * base);
  }
  if (!openings && scan) {
    for (double angle = 0; angle < 180; angle += kFrontStep_deg) {
      look(Eigen::AngleAxisd(RadiansFromDegrees(angle), Eigen::Vector3d::UnitX())
               .toRotationMatrix() *
           first);
    }
    for (double step = kFrontStep_deg / 2; openings && step > 3; step /= 2) {
      // look() changes turn. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
      const Eigen::Matrix3d from = turn;
      for (const double angle : {-step, step}) {
        look(Eigen::AngleAxisd(RadiansFromDegrees(angle), Eigen::Vector3d::UnitX())
                 .toRotationMatrix() *
             from);
      }
    }
    if (openings) {
      axes.notes.push_back("turned: the file's axes are not those of the glasses");
    }
  }
  if (!openings) return std::nullopt;

  TriangleMesh turned = Turned(mesh, turn);
  Box box = BoxOf(turned);
  const bool temples = box.size().z() > kFlatFront_mm;
  if (!temples) axes.notes.push_back("no temples found: the file's own front is kept");
  if (temples && FrontDepth(turned, *openings) < box.middle().z()) {
    turn = Eigen::Matrix3d(Eigen::Vector3d(-1, 1, -1).asDiagonal() * turn);
    turned = Turned(mesh, turn);
    box = BoxOf(turned);
    for (SilhouetteRegion* hole : {&openings->a, &openings->b}) hole->centre.x() *= -1;
  }
  if (Upness(turned, box, *openings) < 0) {
    turn = Eigen::Matrix3d(Eigen::Vector3d(-1, -1, 1).asDiagonal() * turn);
  }
  axes.frame_from_file = turn;
  return axes;
}

}  // namespace lorgnette
