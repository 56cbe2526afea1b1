// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/atomic_file.h"
#include "base/json_reader.h"

namespace lorgnette {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCameraFormat = "lorgnette-camera";
constexpr int kCameraVersion = 1;
constexpr double kFarthest_px = 1e6, kMostDistortion = 100;
constexpr double kSameShape = 0.005;

}  // namespace

Result<CalibratedCamera> ParseCameraFile(const std::string& text, const std::string& name) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(text, name));
  if (const std::string format = json.String("format"); format != kCameraFormat) {
    json.Fail("format", fmt::format("got '{}', want '{}'", format, kCameraFormat));
  }
  json.IntegerOr("version", kCameraVersion, kCameraVersion, kCameraVersion);
  CalibratedCamera out;
  out.camera.width = int(std::lround(json.Number("width", 1, 32768)));
  out.camera.height = int(std::lround(json.Number("height", 1, 32768)));
  const std::vector<double> k = json.Numbers("K");
  if (k.size() != 9) {
    json.Fail("K", fmt::format("got {} numbers, want 9", k.size()));
  } else if (!(k[0] >= 1 && k[0] <= kFarthest_px && k[4] >= 1 && k[4] <= kFarthest_px) ||
             !(std::abs(k[2]) <= kFarthest_px && std::abs(k[5]) <= kFarthest_px) || k[1] != 0 ||
             k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    json.Fail("K", "got another matrix, want fx 0 cx, 0 fy cy, 0 0 1 in pixels, fx and fy from 1");
  } else {
    out.camera.fx = k[0];
    out.camera.fy = k[4];
    out.camera.cx = k[2];
    out.camera.cy = k[5];
  }
  if (json.Has("distortion")) {
    const std::vector<double> d = json.Numbers("distortion");
    bool good = d.size() == 4 || d.size() == 5;
    for (const double value : d) good = good && std::abs(value) <= kMostDistortion;
    if (good) {
      out.distortion = {d[0], d[1], d[2], d[3], d.size() == 5 ? d[4] : 0};
    } else {
      json.Fail("distortion", fmt::format("got {} numbers, want k1 k2 p1 p2 and perhaps k3, "
                                          "each within 100",
                                          d.size()));
    }
  }
  out.rms_px = json.NumberOr("rms_px", 0, 0, kFarthest_px);
  out.focal_sigma_px = json.NumberOr("focal_sigma_px", 0, 0, kFarthest_px);
  out.views = json.IntegerOr("views", 0, 0, 1000000);
  LG_RETURN_IF_ERROR(json.Finish());
  return out;
}

Result<CalibratedCamera> ReadCameraFile(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  return ParseCameraFile(text, path);
}

Status WriteCameraFile(const CalibratedCamera& camera, const std::string& path) {
  const Camera& c = camera.camera;
  const LensDistortion& d = camera.distortion;
  Json json;
  json["format"] = kCameraFormat;
  json["version"] = kCameraVersion;
  json["width"] = c.width;
  json["height"] = c.height;
  json["K"] = {{c.fx, 0, c.cx}, {0, c.fy, c.cy}, {0, 0, 1}};
  json["distortion"] = {d.k1, d.k2, d.p1, d.p2, d.k3};
  json["rms_px"] = camera.rms_px;
  json["focal_sigma_px"] = camera.focal_sigma_px;
  json["views"] = camera.views;
  return WriteFileAtomically(path, json.dump(2) + "\n");
}

Result<CalibratedCamera> ScaledTo(const CalibratedCamera& camera, int width, int height,
                                  const std::string& name) {
  const double across = double(width) / camera.camera.width;
  const double down = double(height) / camera.camera.height;
  if (!(std::abs(across / down - 1) <= kSameShape)) {
    return UsageError(fmt::format("{}: is a camera of {}x{} pixels, and the video has {}x{}", name,
                                  camera.camera.width, camera.camera.height, width, height));
  }
  CalibratedCamera out = camera;
  out.camera = {width,
                height,
                across * camera.camera.fx,
                down * camera.camera.fy,
                across * camera.camera.cx,
                down * camera.camera.cy};
  return out;
}

}  // namespace lorgnette
