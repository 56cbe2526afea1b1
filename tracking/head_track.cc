// SPDX-License-Identifier: Apache-2.0
#include "tracking/head_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/json_reader.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTrackFormat = "lorgnette-head-track";
constexpr int kTrackVersion = 1;
constexpr double kHuge = 1e6;                // mm or px; nothing sensible is larger
constexpr double kVertexDigits = 1e3;        // vertices are written to 0.001 mm
constexpr double kRotationTolerance = 1e-4;  // of R^T R - 1: files of others carry four digits

Json Rounded(double value) { return std::round(value * kVertexDigits) / kVertexDigits; }

template <typename Point>
Json JsonOf(const std::vector<Point>& points) {
  Json array = Json::array();
  for (const Point& p : points) array.push_back({Rounded(p[0]), Rounded(p[1]), Rounded(p[2])});
  return array;
}

Json JsonOf(const Eigen::Isometry3d& pose) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) {
    rows.push_back({pose(r, 0), pose(r, 1), pose(r, 2), pose(r, 3)});
  }
  return rows;
}

bool AllBounded(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && std::abs(v) <= kHuge; });
}

// `count` points of three numbers each under `key`; count < 0: any number of them.
std::vector<Eigen::Vector3d> ReadPoints(JsonReader& json, const std::string& key, int count) {
  const std::vector<double> values = json.Numbers(key);
  std::vector<Eigen::Vector3d> points;
  const bool fits = count < 0 ? values.size() % 3 == 0 : values.size() == 3 * std::size_t(count);
  if (!fits) {
    json.Fail(key, fmt::format("got {} numbers, want {}", values.size(),
                               count < 0 ? "three a point" : fmt::format("{}", 3 * count)));
    return std::vector<Eigen::Vector3d>(std::size_t(std::max(count, 0)), Eigen::Vector3d::Zero());
  }
  if (!AllBounded(values)) json.Fail(key, "got a number beyond 1e6, want millimetres");
  for (std::size_t i = 0; i < values.size(); i += 3) {
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return points;
}

Eigen::Isometry3d ReadPose(JsonReader& json, const std::string& key) {
  const std::vector<double> v = json.Numbers(key);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (v.size() != 12 && v.size() != 16) {
    json.Fail(key, fmt::format("got {} numbers, want 12 (three rows of a rotation and a shift) or "
                               "16",
                               v.size()));
    return pose;
  }
  if (!AllBounded(v)) {
    json.Fail(key, "got a number beyond 1e6, want a rotation and millimetres");
    return pose;
  }
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) pose(r, c) = v[4 * std::size_t(r) + std::size_t(c)];
  }
  if (v.size() == 16 && (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1)) {
    json.Fail(key, "got a fourth row that is not 0 0 0 1, want a rigid pose");
  }
  const Eigen::Matrix3d square = pose.linear().transpose() * pose.linear();
  if (!square.isApprox(Eigen::Matrix3d::Identity(), kRotationTolerance) ||
      pose.linear().determinant() < 0) {
    json.Fail(key, "got a matrix that is not a rotation, want a rigid pose, row by row");
    return Eigen::Isometry3d::Identity();
  }
  return pose;
}

Camera ReadCamera(JsonReader json, LensDistortion& distortion) {
  Camera camera;
  camera.width = int(std::lround(json.Number("width", 1, 32768)));
  camera.height = int(std::lround(json.Number("height", 1, 32768)));
  camera.fx = json.Number("fx", 1, kHuge);
  camera.fy = json.NumberOr("fy", camera.fx, 1, kHuge);
  camera.cx = json.NumberOr("cx", camera.width / 2.0, -kHuge, kHuge);
  camera.cy = json.NumberOr("cy", camera.height / 2.0, -kHuge, kHuge);
  if (json.Has("distortion")) {
    const std::vector<double> d = json.Numbers("distortion");
    if (d.size() == 5 && AllBounded(d)) {
      distortion = {d[0], d[1], d[2], d[3], d[4]};
    } else {
      json.Fail("distortion", fmt::format("got {} numbers, want k1 k2 p1 p2 k3", d.size()));
    }
  }
  return camera;
}

TriangleMesh ReadFace(JsonReader json) {
  TriangleMesh face;
  face.positions = ReadPoints(json, "positions", -1);
  const std::vector<double> triangles = json.Numbers("triangles");
  if (face.positions.empty()) json.Fail("positions", "got no point, want a face");
  if (triangles.empty() || triangles.size() % 3 != 0) {
    json.Fail("triangles", fmt::format("got {} numbers, want three a triangle", triangles.size()));
    return face;
  }
  const double count = double(face.positions.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k) {
      const double index = triangles[i + std::size_t(k)];
      if (!(index >= 0 && index < count) || index != std::floor(index)) {
        json.Fail("triangles", fmt::format("got vertex {}, want a whole number 0..{}", index,
                                           face.positions.size() - 1));
        return face;
      }
      t[k] = int(index);
    }
    face.triangles.push_back(t);
  }
  if (json.Has("uvs")) {
    const std::vector<double> uvs = json.Numbers("uvs");
    if (uvs.size() != 2 * face.positions.size() || !AllBounded(uvs)) {
      json.Fail("uvs",
                fmt::format("got {} numbers, want {}", uvs.size(), 2 * face.positions.size()));
      return face;
    }
    for (std::size_t i = 0; i < uvs.size(); i += 2) {
      face.uvs.emplace_back(float(uvs[i]), float(uvs[i + 1]));
    }
  }
  return face;
}

TrackedFrame ReadFrame(JsonReader& json, int vertices) {
  TrackedFrame frame;
  frame.time_s = json.Number("time_s", -kHuge, kHuge);
  frame.found = json.BoolOr("found", true);
  if (!frame.found) return frame;
  frame.camera_from_head = ReadPose(json, "camera_from_head");
  frame.residual_px = float(json.NumberOr("residual_px", 0, 0, kHuge));
  const auto read_iris = [&json](const std::string& key, std::optional<Eigen::Vector2f>& iris) {
    if (!json.Has(key)) return;
    const std::vector<double> v = json.Numbers(key);
    if (v.size() != 2 || !AllBounded(v)) {
      json.Fail(key, fmt::format("got {} numbers, want two, in pixels", v.size()));
      return;
    }
    iris = Eigen::Vector2f(float(v[0]), float(v[1]));
  };
  read_iris("iris_right", frame.iris_right);
  read_iris("iris_left", frame.iris_left);
  if (json.Has("vertices")) {
    for (const Eigen::Vector3d& p : ReadPoints(json, "vertices", vertices)) {
      frame.vertices.push_back(p.cast<float>());
    }
  }
  return frame;
}

}  // namespace

int HeadTrack::frames_without_face() const {
  return int(std::count_if(frames.begin(), frames.end(),
                           [](const TrackedFrame& frame) { return !frame.found; }));
}

Result<HeadTrack> ReadHeadTrack(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  return ParseHeadTrack(text, path);
}

Result<HeadTrack> ParseHeadTrack(const std::string& text, const std::string& name) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(text, name));
  const std::string format = json.String("format");
  if (format != kTrackFormat) {
    json.Fail("format", fmt::format("got '{}', want '{}'", format, kTrackFormat));
  }
  json.IntegerOr("version", kTrackVersion, kTrackVersion, kTrackVersion);
  HeadTrack track;
  track.camera = ReadCamera(json.Object("camera"), track.distortion);
  track.pd_mm = json.Number("pd_mm", 40, 90);
  track.pupil_right = {-track.pd_mm / 2, 0, 0};
  track.pupil_left = {track.pd_mm / 2, 0, 0};
  if (json.Has("pupil_right")) track.pupil_right = ReadPoints(json, "pupil_right", 1)[0];
  if (json.Has("pupil_left")) track.pupil_left = ReadPoints(json, "pupil_left", 1)[0];
  track.iris_pd_mm = json.NumberOr("iris_pd_mm", 0, 0, 200);
  track.iris_pd_sigma_mm = json.NumberOr("iris_pd_sigma_mm", 0, 0, 200);
  json.Ignore("iris_pd_minus_pd_mm");  // of the two above
  track.face = ReadFace(json.Object("face"));
  ComputeVertexNormals(track.face);
  double last = -kHuge;
  for (JsonReader& frame : json.Objects("frames")) {
    track.frames.push_back(ReadFrame(frame, int(track.face.positions.size())));
    const double time = track.frames.back().time_s;
    if (!(time >= last)) frame.Fail("time_s", fmt::format("got {}, want at least {}", time, last));
    last = time;
  }
  if (track.frames.empty()) json.Fail("frames", "got none, want at least one frame");
  LG_RETURN_IF_ERROR(json.Finish());
  return track;
}

Status WriteHeadTrack(const HeadTrack& track, const std::string& path) {
  Json json;
  json["format"] = kTrackFormat;
  json["version"] = kTrackVersion;
  const Camera& c = track.camera;
  json["camera"] = {{"width", c.width}, {"height", c.height}, {"fx", c.fx},
                    {"fy", c.fy},       {"cx", c.cx},         {"cy", c.cy}};
  if (const LensDistortion& d = track.distortion; !d.IsNone()) {
    json["camera"]["distortion"] = {d.k1, d.k2, d.p1, d.p2, d.k3};
  }
  json["pd_mm"] = track.pd_mm;
  json["pupil_right"] = {track.pupil_right.x(), track.pupil_right.y(), track.pupil_right.z()};
  json["pupil_left"] = {track.pupil_left.x(), track.pupil_left.y(), track.pupil_left.z()};
  if (track.iris_pd_mm > 0) {
    json["iris_pd_mm"] = Rounded(track.iris_pd_mm);
    json["iris_pd_sigma_mm"] = Rounded(track.iris_pd_sigma_mm);
    json["iris_pd_minus_pd_mm"] = Rounded(track.iris_pd_mm - track.pd_mm);
  }
  Json& face = json["face"];
  face["positions"] = JsonOf(track.face.positions);
  face["triangles"] = Json::array();
  for (const Eigen::Vector3i& t : track.face.triangles) {
    face["triangles"].push_back({t[0], t[1], t[2]});
  }
  if (!track.face.uvs.empty()) {
    face["uvs"] = Json::array();
    for (const Eigen::Vector2f& uv : track.face.uvs) {
      face["uvs"].push_back({double(uv.x()), double(uv.y())});
    }
  }
  json["frames"] = Json::array();
  for (const TrackedFrame& frame : track.frames) {
    Json& out = json["frames"].emplace_back();
    out["time_s"] = frame.time_s;
    out["found"] = frame.found;
    if (!frame.found) continue;
    out["camera_from_head"] = JsonOf(frame.camera_from_head);
    out["residual_px"] = Rounded(double(frame.residual_px));
    if (const auto& i = frame.iris_right)
      out["iris_right"] = {Rounded(double(i->x())), Rounded(double(i->y()))};
    if (const auto& i = frame.iris_left)
      out["iris_left"] = {Rounded(double(i->x())), Rounded(double(i->y()))};
    if (!frame.vertices.empty()) out["vertices"] = JsonOf(frame.vertices);
  }
  return WriteFileAtomically(path, json.dump() + "\n");
}

}  // namespace lorgnette
