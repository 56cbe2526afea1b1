// SPDX-License-Identifier: Apache-2.0
// The environment as the head sees it in one frame, and light baked once a clip for points that
// move with the head: irradiance by spherical harmonics, shadow by lists of blocked directions.
//
// Since frame and face move together, what blocks what never changes while the face is rigid; only
// the light turns (a precomputed radiance transfer, Sloan et al. 2002).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/mesh.h"
#include "render/directions.h"
#include "render/embree_scene.h"
#include "render/environment.h"
#include "render/face_lattice.h"
#include "render/face_views.h"
#include "render/visibility.h"

namespace lorgnette {

// Radiance of every baked direction times its solid angle, and the same light in harmonics.
struct HeadLight {
  std::vector<Eigen::Vector3f> cells;
  // Four floats a term, the last 0: one load and one multiplication for the three channels.
  std::array<Eigen::Vector4f, kHarmonics> harmonics;
};
//   directions  SphereDirections(n), in head space;  blurred  ForCells(environment, n)
HeadLight LightAt(const std::vector<Eigen::Vector3f>& directions, const BlurredEnvironment& blurred,
                  const Eigen::Matrix3f& world_from_head, float scale);

struct SurfacePoint {
  Eigen::Vector3f position;  // head space, mm
  Eigen::Vector3f normal;    // unit
};

// Irradiance at the vertices of the frame, from what neither frame nor head hides, and the share of
// the cosine-weighted hemisphere that the head fills. Vertices inside another part of the frame,
// which no light reaches, take the mean of their neighbours outside: a triangle that ends in there
// is not darker where it comes out.
class BakedIrradiance {
 public:
  //   frame  head space, with normals
  static BakedIrradiance Bake(const EmbreeScene& scene, const TriangleMesh& frame, int directions);
  // W/m^2 in units of the environment: one a vertex, plus pi * head_radiance from the head's part.
  std::vector<Eigen::Vector3f> Relight(const HeadLight& light,
                                       const Eigen::Vector3f& head_radiance) const;

 private:
  void LightBuried(const std::vector<Eigen::Vector3i>& triangles, std::vector<bool> buried);

  std::vector<Harmonics> transfer_;
  std::vector<float> head_share_;
};

// Weight of the reading that sees the face, by the share of a point's cosine-weighted hemisphere
// that the face leaves open. In creases (the corners of the eyes) next to nothing is open and a
// ratio of two such remainders is noise; there the frame alone decides.
float WeightOfOpenShare(float open_share);

struct ShadowOptions {
  bool sees_face = true;                               // S_noGlasses with the face as an occluder
  int directions = 1024;                               // multiple of 16
  double spacing_near_mm = 1.0, spacing_far_mm = 3.0;  // of points, near the frame and elsewhere
  // A point takes the mean of two on either side where the frame blocks the same directions for
  // both, but for this share of the hemisphere.
  float most_difference = 0.1f;
};

// Equation (2) of the paper from baked visibility.
class BakedShadow {
 public:
  static BakedShadow Bake(const EmbreeScene& scene, const TriangleMesh& face,
                          const TriangleMesh& frame, const ShadowOptions& options);

  // After the face has moved: traces anew the points from which the frame looks most different,
  // `most` at most, and only those that have moved since they were traced by kMoved_mm and by
  // kMovedShare of their distance to the frame (half of a direction's cell). The light without
  // glasses stays that of the face at rest. Returns how many.
  static constexpr float kMoved_mm = 0.3f, kMovedShare = 0.05f;
  std::size_t Follow(const EmbreeScene& scene, const std::vector<Eigen::Vector3f>& vertices,
                     std::size_t most);

  std::size_t point_count() const { return lattice_.points().size(); }
  std::size_t touched_count() const { return touched_.size(); }
  // False where the frame hides nothing from any point of the triangle: its ratio is exactly 1.
  bool touched(std::uint32_t triangle) const { return lattice_.touched(triangle); }
  // S_withGlasses / S_noGlasses by channel, one a point, in [0, 1]; without value where the point
  // lies inside the frame, which a coarse face mesh can bring about.
  std::vector<Eigen::Vector3f> Relight(const HeadLight& light) const;
  Eigen::Vector3f Ratio(const std::vector<Eigen::Vector3f>& relit, std::uint32_t triangle, float u,
                        float v) const {
    return lattice_.Interpolate(relit, triangle, u, v);
  }

 private:
  struct Blocked {
    std::uint16_t direction;
    std::uint16_t cosine;  // in units of 1 / kCosineUnits
  };
  static constexpr float kCosineUnits = 65535;
  // Light that arrives without glasses, at the vertices: it varies slowly.
  struct Open {
    Harmonics seen{};  // past the face
    Harmonics all{};   // as if there were no face
    float share = 1;   // of the cosine-weighted hemisphere that the face leaves open
  };
  // What the frame blocks from one point: first what the face leaves open, then what it hides with
  // or without glasses.
  struct Lists {
    std::vector<Blocked> blocked;
    std::uint32_t seen = 0;                        // length of the first part
    std::uint32_t above = 0;                       // directions above the surface
    bool buried = false;                           // all of them are blocked
    std::vector<std::uint64_t> bits[2];            // of the directions in each part
    float DifferenceTo(const Lists& other) const;  // share of the hemisphere's directions
  };
  struct Touched {
    std::uint32_t point;
    Eigen::Vector3i vertices;  // of its triangle
    float u, v;
    std::uint32_t like;  // where it is buried: the nearest point that is not, whose factor it takes
    Eigen::Vector3f baked_at;
    float to_frame_mm;  // nearest distance, to a few mm
    Lists lists;
  };
  //   corners  vertices of the point's triangle
  Lists ListBlocked(const EmbreeScene& scene, const LatticePoint& at,
                    const Eigen::Vector3i& corners);
  // Whether the face hides each of the blocked directions.
  void FindHidden(const EmbreeScene& scene, const LatticePoint& at, const Eigen::Vector3i& corners,
                  const std::vector<Blocked>& blocked, std::vector<std::uint8_t>& hidden);
  void FindNeighbours();
  void BakeOpenLight(const TriangleMesh& face, const std::vector<Eigen::Vector3f>& sphere);

  FaceLattice lattice_;
  std::vector<FaceLattice::Between> means_;  // points that take the mean of two before them
  std::vector<Open> open_;                   // one a vertex, of those beside touched points
  std::vector<Touched> touched_;
  DirectionColumns sphere_;
  std::optional<FaceViews> views_;  // of the face at rest, where S_noGlasses sees it
};

}  // namespace lorgnette
