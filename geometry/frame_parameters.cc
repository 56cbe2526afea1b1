// SPDX-License-Identifier: Apache-2.0
#include "geometry/frame_parameters.h"

#include "base/json_reader.h"

namespace lorgnette {
namespace {

constexpr int kMinOutlinePoints = 6, kMaxOutlinePoints = 64;

// Reads one group after the other; every material's name is remembered with the key that used it.
class Reader {
 public:
  explicit Reader(JsonReader root) : root_(std::move(root)) {}

  FrameParameters Read() {
    FrameParameters p;
    p.name = root_.String("name");
    p.description = root_.StringOr("description", "");
    p.mount = ReadMount(root_);
    JsonReader boxing = root_.Object("boxing");
    p.a_mm = boxing.Number("A", 30, 80);
    p.b_mm = boxing.Number("B", 15, 70);
    p.dbl_mm = boxing.Number("DBL", 8, 35);
    if (root_.Has("bridge_sizes")) ReadSizes(p);
    ReadOutline(p);
    JsonReader front = root_.Object("front");
    p.pantoscopic_tilt_deg = front.Number("pantoscopic_tilt", -5, 25);
    p.face_form_deg = front.Number("face_form", -5, 25);
    p.frame_curve_diopters = front.Number("frame_curve", 0, 9);
    p.rim = ReadRim(root_.Object("rim"));
    for (JsonReader& bridge : root_.Objects("bridges")) p.bridges.push_back(ReadBridge(bridge));
    p.pads = ReadPads(root_.Object("pads"));
    p.end_piece = ReadEndPiece(root_.Object("end_piece"));
    p.temples = ReadTemples(root_.Object("temples"));
    JsonReader materials = root_.Object("materials");
    for (const std::string& key : materials.Keys()) {
      p.materials[key] = ReadMaterial(materials.Object(key));
    }
    for (const auto& [key, material] : used_materials_) {
      if (p.materials.count(material) == 0) {
        root_.Fail(key, "got \"" + material + "\", want a name of \"materials\"");
      }
    }
    return p;
  }
  Status Finish() const { return root_.Finish(); }

 private:
  void ReadSizes(FrameParameters& p) {
    p.bridge_sizes_mm = root_.Numbers("bridge_sizes");
    for (const double size : p.bridge_sizes_mm) {
      if (!(size >= 8 && size <= 35)) {
        root_.Fail("bridge_sizes", "got " + std::to_string(size) + ", want 8..35");
      }
    }
  }

  void ReadOutline(FrameParameters& p) {
    const std::vector<double> numbers = root_.Numbers("outline");
    const std::size_t count = numbers.size() / 2;
    if (numbers.size() % 2 != 0 || count < kMinOutlinePoints || count > kMaxOutlinePoints) {
      root_.Fail("outline", "got " + std::to_string(numbers.size()) +
                                " numbers, want x, y of 6..64 control points");
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      p.outline.emplace_back(numbers[2 * i], numbers[2 * i + 1]);
    }
    if (SignedArea(p.outline) < 1e-3) {
      root_.Fail("outline", "got a clockwise or empty outline, want counter-clockwise");
    }
  }

  std::string Material(JsonReader& json, const std::string& key, const std::string& path) {
    std::string name = json.String(key);
    used_materials_.emplace_back(path, name);
    return name;
  }

  RimParameters ReadRim(JsonReader json) {
    RimParameters rim;
    JsonReader width = json.Object("width");
    rim.top_mm = width.Number("top", 0.4, 15);
    rim.bottom_mm = width.Number("bottom", 0.4, 15);
    rim.nasal_mm = width.Number("nasal", 0.4, 15);
    rim.temporal_mm = width.Number("temporal", 0.4, 15);
    if (json.Has("flares")) {
      for (JsonReader& flare : json.Objects("flares")) {
        rim.flares.push_back({flare.Number("angle", -180, 360), flare.Number("spread", 3, 90),
                              flare.Number("width", -5, 12)});
      }
    }
    rim.depth_mm = json.Number("depth", 1.2, 10);
    rim.lip_mm = json.Number("lip", 0.2, 1.5);
    rim.groove_width_mm = json.Number("groove_width", 0.4, rim.depth_mm - 0.4);
    rim.rounding_mm = json.Number("rounding", 0.1, rim.depth_mm / 2);
    rim.material = Material(json, "material", "rim.material");
    return rim;
  }

  BridgeParameters ReadBridge(JsonReader& json) {
    BridgeParameters bridge;
    bridge.attach_top_deg = json.Number("attach_top", 60, 270);
    bridge.attach_bottom_deg = json.Number("attach_bottom", bridge.attach_top_deg, 270);
    bridge.rise_top_mm = json.NumberOr("rise_top", 0, -15, 15);
    bridge.rise_bottom_mm = json.NumberOr("rise_bottom", 0, -15, 15);
    bridge.forward_mm = json.NumberOr("forward", 0, -5, 8);
    bridge.depth_mm = json.Number("depth", 0.8, 10);
    bridge.material = Material(json, "material", "bridges.material");
    return bridge;
  }

  static FrameMount ReadMount(JsonReader& json) {
    if (!json.Has("mount")) return FrameMount::kFullRim;
    const std::string mount = json.String("mount");
    if (mount != "full rim" && mount != "half rim" && mount != "rimless") {
      json.Fail("mount", "got \"" + mount + "\", want full rim, half rim or rimless");
    }
    return mount == "half rim"  ? FrameMount::kHalfRim
           : mount == "rimless" ? FrameMount::kRimless
                                : FrameMount::kFullRim;
  }

  PadParameters ReadPads(JsonReader json) {
    PadParameters pads;
    pads.height_mm = json.Number("height", 4, 25);
    pads.width_mm = json.Number("width", 2, 15);
    pads.thickness_mm = json.Number("thickness", 0.5, 10);
    pads.half_gap_mm = json.Number("half_gap", 3, 15);
    pads.y_mm = json.Number("y", -20, 15);
    pads.z_mm = json.Number("z", -15, 3);
    pads.frontal_deg = json.Number("frontal", 0, 45);
    pads.splay_deg = json.Number("splay", 0, 60);
    pads.arm_mm = json.Number("arm", 0, 1.5);
    pads.material = Material(json, "material", "pads.material");
    if (pads.arm_mm > 0) pads.arm_material = Material(json, "arm_material", "pads.arm_material");
    return pads;
  }

  EndPieceParameters ReadEndPiece(JsonReader json) {
    EndPieceParameters end;
    end.angle_deg = json.Number("angle", -45, 80);
    end.height_mm = json.Number("height", 1, 20);
    end.thickness_mm = json.Number("thickness", 0.8, 8);
    end.reach_mm = json.Number("reach", 0.5, 15);
    end.back_mm = json.Number("back", 2, 20);
    end.material = Material(json, "material", "end_piece.material");
    return end;
  }

  TempleParameters ReadTemples(JsonReader json) {
    TempleParameters temple;
    temple.length_mm = json.Number("length", 100, 170);
    temple.to_bend_mm = json.Number("to_bend", 60, temple.length_mm - 15);
    temple.height_mm = json.Number("height", 0.8, 25);
    temple.thickness_mm = json.Number("thickness", 0.8, 8);
    temple.middle_height_mm = json.Number("middle_height", 0.8, 20);
    temple.tip_height_mm = json.Number("tip_height", 1, 20);
    temple.bend_deg = json.Number("bend", 0, 90);
    temple.tip_inward_deg = json.Number("tip_inward", -10, 30);
    temple.spread_mm = json.Number("spread", 90, 200);
    temple.tip_sleeve_mm = json.NumberOr("tip_sleeve", 0, 0, temple.length_mm - 30);
    temple.tip_thickness_mm = json.NumberOr("tip_thickness", temple.thickness_mm, 0.8, 8);
    temple.material = Material(json, "material", "temples.material");
    temple.tip_material = temple.material;
    if (json.Has("tip_material")) {
      temple.tip_material = Material(json, "tip_material", "temples.tip_material");
    }
    return temple;
  }

  static Eigen::Vector3f Colour(JsonReader& json, const std::string& key) {
    const std::vector<double> rgb = json.Numbers(key);
    if (rgb.size() != 3) {
      json.Fail(key, "got " + std::to_string(rgb.size()) + " numbers, want 3 (linear RGB, 0..1)");
      return {0, 0, 0};
    }
    for (const double c : rgb) {
      if (!(c >= 0 && c <= 1)) json.Fail(key, "got " + std::to_string(c) + ", want 0..1");
    }
    return {float(rgb[0]), float(rgb[1]), float(rgb[2])};
  }

  static FrameMaterial ReadMaterial(JsonReader json) {
    FrameMaterial material;
    material.diffuse = Colour(json, "diffuse");
    material.specular = Colour(json, "specular");
    material.shininess = float(json.Number("shininess", 1, 1000));
    return material;
  }

  JsonReader root_;
  std::vector<std::pair<std::string, std::string>> used_materials_;
};

}  // namespace

Result<FrameParameters> ParseFrameParameters(const std::string& json_text,
                                             const std::string& name) {
  LG_ASSIGN(JsonReader root, JsonReader::Parse(json_text, name));
  Reader reader(std::move(root));
  FrameParameters parameters = reader.Read();
  LG_RETURN_IF_ERROR(reader.Finish());
  return parameters;
}

}  // namespace lorgnette
