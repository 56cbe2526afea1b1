// SPDX-License-Identifier: Apache-2.0
// What a parametric frame has besides its rims: bridge, pads, end pieces, hinges, temples. All for
// the wearer's left (the bridge spans both sides), frame coordinates.
#pragma once

#include <vector>

#include "geometry/frame_parameters.h"
#include "geometry/rim_shape.h"

namespace lorgnette {

TriangleMesh BridgeMesh(const RimShape& rim, const RimParameters& rim_parameters,
                        const BridgeParameters& bridge, const MeshFineness& fineness);

struct Pad {
  TriangleMesh pad;
  TriangleMesh arm;                       // empty without arm
  std::vector<Eigen::Vector3d> contacts;  // points of the face that rests on the nose
};
Pad PadMesh(const RimShape& rim, const RimParameters& rim_parameters, const PadParameters& pad,
            const MeshFineness& fineness);

struct EndPiece {
  TriangleMesh mesh, barrel;
  Eigen::Vector3d hinge;  // where the temple begins, on the bar's middle line
};
EndPiece EndPieceMesh(const RimShape& rim, const RimParameters& rim_parameters,
                      const EndPieceParameters& end, double temple_thickness_mm,
                      const MeshFineness& fineness);

struct Temple {
  TriangleMesh bar, sleeve;   // sleeve may be empty
  Eigen::Vector3d ear_point;  // under the bend
};
Temple TempleMesh(const TempleParameters& temple, const Eigen::Vector3d& hinge,
                  double pantoscopic_tilt_deg, const MeshFineness& fineness);

}  // namespace lorgnette
