// SPDX-License-Identifier: Apache-2.0
#include "render/compose.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/json_reader.h"
#include "optics/certify.h"
#include "render/image_io.h"
#include "render/obj_reader.h"

namespace lorgnette {
namespace {

namespace fs = std::filesystem;

// A case carries notes and records for its readers; what is not a setting is passed over.
void IgnoreTheRest(JsonReader& json) {
  for (const std::string& key : json.Keys()) json.Ignore(key);
}

Eigen::Isometry3d ReadPose(JsonReader& json, const std::string& key) {
  const std::vector<double> values = json.Numbers(key);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (values.size() != 16) {
    json.Fail(key, fmt::format("got {} numbers, want 4 rows of 4", values.size()));
    return pose;
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = values[4 * std::size_t(row) + std::size_t(column)];
    }
  }
  const Eigen::Matrix3d r = pose.linear();
  constexpr double kRotation = 1e-5;  // files carry nine decimals
  if (!((r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < kRotation) ||
      r.determinant() < 0) {
    json.Fail(key, "got a matrix that is not a rotation with a shift");
  }
  return pose;
}

// The lens frame of optics/ray.h in that of the file: both x toward opposite sides, z reversed,
// origin at the front vertex instead of the back one.
Eigen::Isometry3d FileFromLens(double center_thickness_mm) {
  Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
  m.linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
  m.translation() = Eigen::Vector3d(0, 0, center_thickness_mm);
  return m;
}

struct LensInput {
  LensOrder order;
  Eigen::Isometry3d head_from_file = Eigen::Isometry3d::Identity();
  double r1_mm = 0, r2_axis_mm = 0, r2_across_mm = 0;  // 0: not given
};

// Points of the outline in the file's lens frame: here as `outline_lens_xy`, or in a contour file
// that `outline` names as FILE#KEY.
std::vector<double> ReadOutline(JsonReader& json, const fs::path& folder) {
  if (json.Has("outline_lens_xy")) return json.Numbers("outline_lens_xy");
  const std::string reference = json.String("outline");
  const std::size_t hash = reference.find('#');
  if (hash == std::string::npos) {
    json.Fail("outline", fmt::format("got `{}`, want FILE#KEY", reference));
    return {};
  }
  const std::string file = (folder / reference.substr(0, hash)).string();
  const auto text = ReadFile(file);
  if (!text) {
    json.Fail("outline", text.error().message);
    return {};
  }
  auto contours = JsonReader::Parse(*text, file);
  if (!contours) {
    json.Fail("outline", contours.error().message);
    return {};
  }
  JsonReader side = contours->Object(reference.substr(hash + 1));
  std::vector<double> points = side.Numbers("outline_lens_xy");
  IgnoreTheRest(side);
  IgnoreTheRest(*contours);
  if (const Status status = contours->Finish(); !status)
    json.Fail("outline", status.error().message);
  return points;
}

LensInput ReadLens(JsonReader json, Eye eye, const fs::path& folder) {
  LensInput lens;
  lens.order.eye = eye;
  JsonReader rx = json.Object("Rx");
  lens.order.rx.sphere = Diopters(rx.Number("sphere_D", -40, 40));
  lens.order.rx.cylinder = Diopters(rx.NumberOr("cylinder_D", 0, -12, 12));
  lens.order.rx.axis = AxisDegrees(rx.NumberOr("axis_deg_TABO", 0, 0, 180));
  IgnoreTheRest(rx);
  lens.order.medium.index_d = json.Number("index", 1.3, 2.2);
  lens.order.base_curve = Diopters(json.Number("F1_D", -20, 30));
  lens.order.center_thickness_mm = json.Number("center_thickness_mm", 0.3, 30);
  lens.r1_mm = json.NumberOr("r1_mm", 0, -1e12, 1e12);
  lens.r2_axis_mm = json.NumberOr("r2_axis_meridian_mm", 0, -1e12, 1e12);
  lens.r2_across_mm = json.NumberOr("r2_power_meridian_mm", 0, -1e12, 1e12);
  lens.head_from_file = ReadPose(json, "head_from_lens");
  const std::vector<double> xy = ReadOutline(json, folder);
  if (xy.size() < 6 || xy.size() % 2 != 0) {
    json.Fail("outline",
              fmt::format("got {} numbers, want x and y of 3 points or more", xy.size()));
  }
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) {
    lens.order.contour_mm.emplace_back(-xy[i], xy[i + 1]);
  }
  IgnoreTheRest(json);
  return lens;
}

Result<CutLens> MakeLens(const LensInput& input, const Eigen::Isometry3d& frame_from_head,
                         const std::string& where) {
  LG_ASSIGN(LensDesign design, DesignLens(input.order));
  const Lens& lens = design.lens;
  const double power = 1000 * (lens.medium.index_d - 1);  // dioptres a unit of curvature
  const Eigen::Matrix2d back = lens.back.VertexCurvature();
  const double axis = input.order.rx.axis.radians();
  const Eigen::Vector2d along(-std::cos(axis), std::sin(axis)), across(along.y(), -along.x());
  const struct {
    const char* key;
    double stated_mm, curvature;
  } radii[] = {{"r1_mm", input.r1_mm, lens.front.VertexCurvature()(0, 0)},
               {"r2_axis_meridian_mm", input.r2_axis_mm, along.dot(back * along)},
               {"r2_power_meridian_mm", input.r2_across_mm, across.dot(back * across)}};
  for (const auto& r : radii) {
    if (r.stated_mm == 0) continue;
    if (std::abs(1 / r.stated_mm - r.curvature) * power > kCaseCurvatureTolerance_D) {
      return Failure(fmt::format("{}.{}: got {} mm, the order gives {} mm", where, r.key,
                                 r.stated_mm, 1 / r.curvature));
    }
  }
  LG_ASSIGN(CertifiedLens certified, Certify(std::move(design)));
  const double thickness = certified.lens().center_thickness_mm;
  const Eigen::Isometry3d frame_from_lens =
      frame_from_head * input.head_from_file * FileFromLens(thickness);
  return CutLens{std::move(certified), input.order.contour_mm, frame_from_lens, {}, 0};
}

}  // namespace

Result<ComposeCase> ReadComposeCase(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  LG_ASSIGN(JsonReader json, JsonReader::Parse(text, path));
  const fs::path folder = fs::path(path).parent_path();

  const std::string name = json.StringOr("name", fs::path(path).stem().string());
  JsonReader image = json.Object("image");
  Camera camera;
  camera.width = int(image.Number("width", 1, 16384));
  camera.height = int(image.Number("height", 1, 16384));
  IgnoreTheRest(image);
  const std::vector<double> k = json.Numbers("K");
  if (k.size() == 9) {
    camera.fx = k[0];
    camera.fy = k[4];
    camera.cx = k[2];
    camera.cy = k[5];
  }
  if (!(camera.fx > 0 && camera.fy > 0))
    json.Fail("K", "want 3 rows of 3 with positive focal lengths");
  const Eigen::Isometry3d camera_from_head = ReadPose(json, "camera_from_head");
  const Eigen::Isometry3d camera_from_world =
      json.Has("camera_from_world") ? ReadPose(json, "camera_from_world") : camera_from_head;
  const Eigen::Isometry3d head_from_frame = ReadPose(json, "head_from_frame");

  JsonReader files = json.Object("files");
  const std::string input_file = (folder / files.String("input")).string();
  const std::string head_file = (folder / files.String("head_mesh")).string();
  const std::string frame_file = (folder / files.String("frame_mesh")).string();
  const std::string environment_file = (folder / files.String("environment")).string();
  IgnoreTheRest(files);

  FrameMaterial material;  // a case's frame is matt unless it says otherwise
  material.diffuse.setConstant(0.05f);
  material.specular.setZero();
  if (json.Has("frame")) {
    JsonReader frame = json.Object("frame");
    material.diffuse.setConstant(float(frame.NumberOr("albedo", 0.05, 0, 1)));
    material.specular.setConstant(float(frame.NumberOr("specular", 0, 0, 1)));
    material.shininess = float(frame.NumberOr("shininess", 60, 1, 1e5));
    IgnoreTheRest(frame);
  }
  CompositorOptions options;
  options.samples_per_side = 4;
  options.shadow = ShadowMode::kGathered;
  options.shadow_directions = 2048;
  options.shadow_spacing_mm = 1.5;
  options.max_internal_bounces = 12;
  options.least_weight = 0.001;
  options.finish.edge = EdgeFinish::kPolished;
  options.fade_temples = false;
  options.bevel_mm = 0;  // cases are of flat edges
  options.world_from_camera = camera_from_world.rotation().transpose();
  if (json.Has("background")) {
    JsonReader background = json.Object("background");
    const double z = background.Number("plane_world_z_mm", -1e6, 1e6);
    IgnoreTheRest(background);
    // The plane has to face the camera: it is taken at the depth of its point on the camera's axis.
    const Eigen::Isometry3d world_from_camera = camera_from_world.inverse();
    const double slope = world_from_camera.linear()(2, 2);
    options.background_depth_mm = (z - world_from_camera.translation().z()) / slope;
    if (!(*options.background_depth_mm > 0)) {
      json.Fail("background", "got a plane that is not before the camera");
    }
  }
  JsonReader lenses = json.Object("lenses");
  const LensInput right = ReadLens(lenses.Object("right"), Eye::kRight, folder);
  const LensInput left = ReadLens(lenses.Object("left"), Eye::kLeft, folder);
  IgnoreTheRest(json);
  LG_RETURN_IF_ERROR(json.Finish());

  LG_ASSIGN(ImageRgbF input, ReadExr(input_file));
  if (input.width != camera.width || input.height != camera.height) {
    return Failure(fmt::format("{}: got {}x{} pixels, want {}x{} as {} says", input_file,
                               input.width, input.height, camera.width, camera.height, path));
  }
  LG_ASSIGN(TriangleMesh head, ReadObjTriangles(head_file));
  LG_ASSIGN(TriangleMesh frame_mesh, ReadObjTriangles(frame_file));
  LG_ASSIGN(Environment environment, Environment::Read(environment_file));
  ComputeVertexNormals(frame_mesh);

  const Eigen::Isometry3d frame_from_head = head_from_frame.inverse();
  LG_ASSIGN(CutLens right_lens, MakeLens(right, frame_from_head, path + ":lenses.right"));
  LG_ASSIGN(CutLens left_lens, MakeLens(left, frame_from_head, path + ":lenses.left"));
  FrameModel frame;
  frame.name = name;
  frame.parts.push_back({"frame", FramePartKind::kOther, std::move(frame_mesh), material});
  return ComposeCase{name,
                     std::move(input),
                     camera,
                     camera_from_head,
                     std::move(head),
                     Eyewear{std::move(frame), std::move(right_lens), std::move(left_lens),
                             head_from_frame, WearingPosition{}},
                     std::move(environment),
                     options};
}

Result<ComposeOutput> Compose(const ComposeCase& scene, const EffectChoice& choice) {
  LG_ASSIGN(const Compositor compositor,
            Compositor::Create(scene.eyewear, scene.head, TriangleMesh{}, scene.environment,
                               scene.options));
  ComposeOutput output;
  output.plan = compositor.Plan(scene.input, scene.camera, scene.camera_from_head, choice);
  output.picture = compositor.Render(scene.input, scene.camera, scene.camera_from_head,
                                     &output.counts, &output.plan.effects);
  output.hits = compositor.HitMap(scene.camera, scene.camera_from_head);
  return output;
}

}  // namespace lorgnette
