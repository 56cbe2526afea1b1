// SPDX-License-Identifier: Apache-2.0
// What is usually wrong with a mesh that somebody modelled, put right: points that nearly meet,
// triangles without area or given twice, faces turned inside out, small holes.
#pragma once

#include <string>
#include <vector>

#include "base/mesh.h"

namespace lorgnette {

// What was found and done; counts of several pieces are added up.
struct MeshRepair {
  int points_joined = 0;      // moved onto another less than kJoin_mm away
  int triangles_dropped = 0;  // without area, or of the same three points as another
  int triangles_turned = 0;   // against their neighbours
  int pieces_turned = 0;      // closed, but inside out
  int holes_filled = 0;       // with an edge of at most kLargestHole_mm
  int open_edges = 0;         // that remain: a sheet, or a larger hole
  int crossing_pairs = 0;     // triangles of one piece that pass through each other: kept

  MeshRepair& operator+=(const MeshRepair& other);
  // One for each count that is not 0: "3 holes filled".
  std::vector<std::string> Sentences() const;
};

inline constexpr double kJoin_mm = 0.005;
inline constexpr double kLargestHole_mm = 15;

// Points nearer than kJoin_mm to another get its position; vertices stay apart, with their normals
// and uvs. Returns how many moved. mm.
int JoinNearPoints(TriangleMesh& mesh);

// One connected piece, mm. Normals are made anew where triangles turned or holes were filled; a
// filled hole's corners have the uvs of its edge.
// Tested: a closed mesh with flipped faces, doubled and flat triangles and a hole comes back
// closed, oriented outward, of the volume that it had; a sound mesh is left as it is.
MeshRepair RepairMesh(TriangleMesh& mesh);

}  // namespace lorgnette
