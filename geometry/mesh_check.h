// SPDX-License-Identifier: Apache-2.0
// What a mesh must be before anybody prints, cuts or traces it.
#pragma once

#include <string>

#include "base/mesh.h"

namespace lorgnette {

struct MeshReport {
  int vertices = 0, triangles = 0;  // after merging equal positions
  int components = 0;
  int boundary_edges = 0;        // 0: closed
  int non_manifold_edges = 0;    // shared by three triangles or more, or walked twice one way
  int degenerate_triangles = 0;  // two corners at one position
  int self_intersections = -1;   // pairs of triangles; -1: not asked for
  double volume_mm3 = 0;         // meaningful when closed
  double least_part_mm3 = 0;     // of the components' volumes; negative: one faces inwards

  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0; }
};

// Merges equal positions, then counts. Self-intersections (CGAL) cost the most and can be left out.
MeshReport CheckMesh(const TriangleMesh& mesh, bool find_self_intersections);

// The same surface with one vertex a position; normals and uvs are dropped.
TriangleMesh MergeEqualPositions(const TriangleMesh& mesh);

}  // namespace lorgnette
