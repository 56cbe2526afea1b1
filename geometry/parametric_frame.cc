// SPDX-License-Identifier: Apache-2.0
#include "geometry/parametric_frame.h"

#include <utility>

#include "geometry/frame_limbs.h"
#include "geometry/rim_shape.h"

namespace lorgnette {
namespace {

// Where a half rim ends, below hinge and pad: angles of the outline's points.
constexpr double kHalfRimFrom_deg = -12, kHalfRimTo_deg = 192;

// Adds a left part and its mirror image.
class PartList {
 public:
  PartList(FrameModel& model, const FrameParameters& parameters)
      : model_(model), parameters_(parameters) {}
  void AddPair(const std::string& name, FramePartKind kind, const TriangleMesh& left,
               const std::string& material) {
    if (left.empty()) return;
    Add("right " + name, kind, MirroredX(left), material);
    Add("left " + name, kind, left, material);
  }
  void Add(const std::string& name, FramePartKind kind, TriangleMesh mesh,
           const std::string& material) {
    model_.parts.push_back({name, kind, std::move(mesh), parameters_.materials.at(material)});
  }

 private:
  FrameModel& model_;
  const FrameParameters& parameters_;
};

}  // namespace

FrameModel BuildFrame(const FrameParameters& parameters, const FrameTessellation& fineness) {
  const RimShape rim(parameters);
  FrameModel model;
  model.name = parameters.name;
  PartList parts(model, parameters);
  if (parameters.mount != FrameMount::kRimless) {
    parts.AddPair("rim", FramePartKind::kFront,
                  parameters.mount == FrameMount::kFullRim
                      ? rim.Mesh(fineness.mesh)
                      : rim.UpperMesh(kHalfRimFrom_deg, kHalfRimTo_deg, fineness.mesh),
                  parameters.rim.material);
  }
  for (std::size_t i = 0; i < parameters.bridges.size(); ++i) {
    parts.Add(i == 0 ? "bridge" : "upper bridge", FramePartKind::kFront,
              BridgeMesh(rim, parameters.rim, parameters.bridges[i], fineness.mesh),
              parameters.bridges[i].material);
  }
  const Pad pad = PadMesh(rim, parameters.rim, parameters.pads, fineness.mesh);
  parts.AddPair("pad", FramePartKind::kNosePad, pad.pad, parameters.pads.material);
  parts.AddPair("pad arm", FramePartKind::kOther, pad.arm, parameters.pads.arm_material);
  const EndPiece end = EndPieceMesh(rim, parameters.rim, parameters.end_piece,
                                    parameters.temples.thickness_mm, fineness.mesh);
  parts.AddPair("end piece", FramePartKind::kFront, end.mesh, parameters.end_piece.material);
  parts.AddPair("hinge", FramePartKind::kHinge, end.barrel,
                parameters.materials.count("hinge") != 0 ? "hinge" : parameters.end_piece.material);
  const Temple temple =
      TempleMesh(parameters.temples, end.hinge, parameters.pantoscopic_tilt_deg, fineness.mesh);
  parts.AddPair("temple", FramePartKind::kTemple, temple.bar, parameters.temples.material);
  parts.AddPair("temple tip", FramePartKind::kTemple, temple.sleeve,
                parameters.temples.tip_material);

  model.mount = parameters.mount;
  model.left = rim.Opening(fineness.contour_points);
  if (parameters.mount != FrameMount::kFullRim) model.left.aperture_mm = model.left.contour_mm;
  model.right = MirroredX(model.left);
  model.boxing = MeasureContour(model.left.contour_mm);
  model.boxing.dbl_mm = parameters.dbl_mm;
  model.pantoscopic_tilt_deg = parameters.pantoscopic_tilt_deg;
  model.face_form_deg = parameters.face_form_deg;
  model.frame_curve_diopters = parameters.frame_curve_diopters;
  model.temple_length_mm = parameters.temples.length_mm;
  model.temple_spread_mm = parameters.temples.spread_mm;
  for (const Eigen::Vector3d& p : pad.contacts) {
    model.nose_contacts.push_back(p);
    model.nose_contacts.push_back(MirroredX(p));
  }
  model.ear_point_left = temple.ear_point;
  model.ear_point_right = MirroredX(temple.ear_point);
  model.parameters = std::make_shared<const FrameParameters>(parameters);
  return model;
}

FrameParameters WithBridge(FrameParameters parameters, double dbl_mm, double pad_shift_mm) {
  parameters.pads.half_gap_mm += (dbl_mm - parameters.dbl_mm) / 2 + pad_shift_mm;
  parameters.dbl_mm = dbl_mm;
  return parameters;
}

}  // namespace lorgnette
