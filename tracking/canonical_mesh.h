// SPDX-License-Identifier: Apache-2.0
// The canonical face mesh whose vertices the landmark network predicts, and what is known of them:
// mirror partners, and how firmly each point sits on the skull.
//
// Canonical space here: mm at the scale of the file, +x toward the wearer's left, +y up, +z out of
// the face.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/mesh.h"
#include "base/result.h"

namespace lorgnette {

inline constexpr int kLandmarks = 468;

// Vertices with a name (right and left are the wearer's).
struct EyeLandmarks {
  int outer, inner;          // corners of the lids
  std::array<int, 4> upper;  // lid margin, from the outer to the inner side, corners left out
  std::array<int, 4> lower;
};
inline constexpr EyeLandmarks kRightEye{33, 133, {161, 160, 159, 158}, {163, 144, 145, 153}};
inline constexpr EyeLandmarks kLeftEye{263, 362, {388, 387, 386, 385}, {390, 373, 374, 380}};

struct CanonicalMesh {
  TriangleMesh mesh;                 // 468 vertices with normals and uvs, mm
  std::vector<int> mirror;           // partner of each vertex under x -> -x
  std::vector<double> rigid_weight;  // 0..1: how well the point stands for the skull in a pose fit
};

// Reads a Wavefront file of 468 vertices (cm), triangles with texture coordinates, and gives it the
// depths of scanned people (tracking/scanned_depth.h).
// Fails when the file is missing, has other counts, or is not symmetric.
Result<CanonicalMesh> ReadCanonicalMesh(const std::string& path);

// Weight of a landmark in the rigid fit, from its place on the canonical face (mm): 1 from the
// forehead to the nose and cheekbones, falling to 0 at mouth and jaw; lids and brows low.
// Tested: the nose bridge weighs more than any point of the mouth; symmetric in x.
std::vector<double> RigidWeights(const std::vector<Eigen::Vector3d>& canonical_mm);

}  // namespace lorgnette
