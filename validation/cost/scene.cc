// SPDX-License-Identifier: Apache-2.0
#include "validation/cost/scene.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/assemble.h"
#include "geometry/frame_io.h"
#include "geometry/head_occluder.h"
#include "render/compose.h"
#include "render/embree_scene.h"

namespace lorgnette::validation {
namespace {

constexpr double kHalfPd_mm = 32, kCamera_mm = 600, kFocal_px = 1500;
constexpr int kWidth = 1280, kHeight = 720;

// Skin over (x, y), head space: cheeks and forehead curve back, a nose comes forward, eyeballs
// stand in their sockets.
double SkinHeight(double x, double y) {
  const double face = -x * x / 115 - std::pow(std::max(0.0, std::abs(y + 15) - 35), 2) / 90;
  const double down = std::min(y - 6, 0.0);
  const double ridge = 9.5 - 0.5 * down + 0.3 * std::max(y - 6, 0.0);
  const double tip = std::max(0.0, -y - 46);
  const double flank = std::sqrt(x * x + 10) - std::sqrt(10.0);
  const double nose = ridge - (1.85 + 0.011 * down) * flank - 0.35 * tip * tip;
  return std::max(face, nose);
}

TriangleMesh MadeFace() {
  TriangleMesh mesh;
  constexpr double kStep_mm = 1.5;
  constexpr int kColumns = 101, kRows = 115;  // x to 75, y from -95 to 76
  constexpr int kMiddle = kColumns / 2;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double x = kStep_mm * (i - kMiddle), y = kStep_mm * j - 95;
      mesh.positions.emplace_back(x, y, SkinHeight(x, y));
    }
  }
  for (int j = 0; j + 1 < kRows; ++j) {
    for (int i = 0; i + 1 < kColumns; ++i) {
      const int a = j * kColumns + i;
      mesh.triangles.emplace_back(a, a + 1, a + kColumns);
      mesh.triangles.emplace_back(a + 1, a + kColumns + 1, a + kColumns);
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

// What the skin reflects at (x, y): detail of 2 to 3 mm, brows, and eyes with iris and pupil.
Eigen::Vector3d Albedo(double x, double y) {
  Eigen::Vector3d skin(0.46, 0.31, 0.25);
  skin *= 1 + 0.06 * std::sin(2.1 * x + 0.7 * y) * std::sin(1.3 * y - 0.4 * x) +
          0.04 * std::sin(5.3 * x) * std::sin(4.7 * y);
  const double ex = std::abs(x) - kHalfPd_mm;
  const double brow = std::pow((y - 19 + 0.01 * ex * ex) / 2.6, 2) + std::pow(ex / 17, 2);
  if (brow < 1) return {0.07, 0.05, 0.04};
  if (std::pow(ex / 14, 2) + std::pow(y / 5.6, 2) > 1) return skin;
  const double r = std::hypot(ex, y);
  if (r < 2) return {0.01, 0.01, 0.01};
  if (r > 5.85) return {0.72, 0.68, 0.66};
  return Eigen::Vector3d(0.12, 0.16, 0.1) * (1 + 0.35 * std::sin(24 * std::atan2(y, ex)));
}

Eigen::Vector3d Background(const Eigen::Vector3d& direction) {
  const double u = direction.x() / direction.z(), v = direction.y() / direction.z();
  const double board = 0.5 + 0.5 * std::sin(60 * u) * std::sin(45 * v);
  return Eigen::Vector3d(0.2, 0.27, 0.33) * (0.55 + 0.6 * board);
}

Environment MadeEnvironment() {
  constexpr int kMapWidth = 512, kMapHeight = 256;
  ImageRgbF map(kMapWidth, kMapHeight);
  for (int y = 0; y < kMapHeight; ++y) {
    for (int x = 0; x < kMapWidth; ++x) {
      const bool lamp = std::abs(x - 190) < 14 && std::abs(y - 70) < 14;
      const bool window = std::abs(x - 330) < 26 && std::abs(y - 95) < 30;
      const float sky = 1.2f - 0.004f * float(y);
      for (int c = 0; c < 3; ++c) {
        map.at(x, y)[c] = lamp ? 20.0f : window ? 4.0f + 0.5f * float(c) : sky;
      }
    }
  }
  return Environment(std::move(map));
}

// The picture without glasses: 3 x 3 rays a pixel against the face.
Result<ImageRgbF> DrawInput(const WornScene& scene) {
  constexpr int kSub = 3;
  LG_ASSIGN(const EmbreeScene rays, EmbreeScene::Build(scene.face, TriangleMesh{}, TriangleMesh{}));
  const Eigen::Isometry3d head_from_camera = scene.camera_from_head.inverse();
  const Eigen::Vector3d eye = head_from_camera.translation();
  const Eigen::Vector3d light = Eigen::Vector3d(0.4, 0.6, 0.7).normalized();
  ImageRgbF image(scene.camera.width, scene.camera.height);
  tbb::parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int s = 0; s < kSub * kSub; ++s) {
        const int column = s % kSub, row = s / kSub;
        const Eigen::Vector3d in_camera =
            scene.camera.Direction(x + (column + 0.5) / kSub, y + (row + 0.5) / kSub);
        const Eigen::Vector3d d = (head_from_camera.linear() * in_camera).normalized();
        const SceneHit hit = rays.Intersect(RaySet::kHead, eye.cast<float>(), d.cast<float>(), 0,
                                            std::numeric_limits<float>::infinity());
        if (!hit.hit()) {
          sum += Background(in_camera);
          continue;
        }
        const Eigen::Vector3d p = eye + double(hit.distance) * d;
        const Eigen::Vector3i& t = scene.face.triangles[hit.triangle];
        const Eigen::Vector3d normal =
            ((1 - double(hit.u) - double(hit.v)) * scene.face.normals[std::size_t(t[0])] +
             double(hit.u) * scene.face.normals[std::size_t(t[1])] +
             double(hit.v) * scene.face.normals[std::size_t(t[2])])
                .normalized();
        sum += (0.35 + 0.65 * std::max(0.0, normal.dot(light))) * Albedo(p.x(), p.y());
      }
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(sum[c] / (kSub * kSub));
    }
  });
  return image;
}

}  // namespace

Result<WornScene> MadeScene(const LensOrder& order, const std::string& frame_name) {
  LG_ASSIGN(const FrameModel frame, LoadFrame(frame_name));
  TriangleMesh face = MadeFace();
  Prescription prescription;
  prescription.right = prescription.left = order.rx;
  EyewearOptions options;
  options.medium = order.medium;
  options.base_curves = {order.base_curve, order.base_curve};
  LG_ASSIGN(FittedEyewear fitted, FitEyewear(frame, face, {-kHalfPd_mm, 0, 0}, {kHalfPd_mm, 0, 0},
                                             prescription, {}, options));
  TriangleMesh occluder = BuildHeadOccluder(face, fitted.fit.ears);
  WornScene scene{"a head of formulas, frame " + frame_name,
                  std::move(fitted.eyewear),
                  std::move(face),
                  std::move(occluder),
                  MadeEnvironment(),
                  {},
                  {kWidth, kHeight, kFocal_px, kFocal_px, 0.5 * kWidth, 0.5 * kHeight},
                  Eigen::Isometry3d::Identity(),
                  {}};
  scene.camera_from_head.linear() =
      Eigen::Vector3d(1, -1, -1).asDiagonal() *
      Eigen::AngleAxisd(RadiansFromDegrees(12), Eigen::Vector3d::UnitY()).toRotationMatrix();
  scene.camera_from_head.translation() = Eigen::Vector3d(0, 0, kCamera_mm);
  LG_ASSIGN(scene.input, DrawInput(scene));
  return scene;
}

Result<WornScene> SceneFromCase(const std::string& path) {
  LG_ASSIGN(ComposeCase one, ReadComposeCase(path));
  return WornScene{"case " + one.name, std::move(one.eyewear),     std::move(one.head),
                   TriangleMesh{},     std::move(one.environment), std::move(one.input),
                   one.camera,         one.camera_from_head,       one.options};
}

ImageRgbF Shrunk(const ImageRgbF& image, int factor) {
  ImageRgbF small(image.width / factor, image.height / factor);
  const float share = 1.0f / float(factor * factor);
  for (int y = 0; y < small.height * factor; ++y) {
    for (int x = 0; x < small.width * factor; ++x) {
      for (int c = 0; c < 3; ++c) {
        small.at(x / factor, y / factor)[c] += share * image.at(x, y)[c];
      }
    }
  }
  return small;
}

Camera Shrunk(const Camera& camera, int factor) {
  return {camera.width / factor, camera.height / factor, camera.fx / factor,
          camera.fy / factor,    camera.cx / factor,     camera.cy / factor};
}

ImageRgbF Grown(const ImageRgbF& image, int factor, const ImageRgbF& like) {
  ImageRgbF large(like.width, like.height);
  for (int y = 0; y < large.height; ++y) {
    const float v =
        std::clamp((float(y) + 0.5f) / float(factor) - 0.5f, 0.0f, float(image.height - 1));
    const int y0 = std::min(int(v), image.height - 2);
    for (int x = 0; x < large.width; ++x) {
      const float u =
          std::clamp((float(x) + 0.5f) / float(factor) - 0.5f, 0.0f, float(image.width - 1));
      const int x0 = std::min(int(u), image.width - 2);
      const float fu = u - float(x0), fv = v - float(y0);
      for (int c = 0; c < 3; ++c) {
        large.at(x, y)[c] =
            (1 - fv) * ((1 - fu) * image.at(x0, y0)[c] + fu * image.at(x0 + 1, y0)[c]) +
            fv * ((1 - fu) * image.at(x0, y0 + 1)[c] + fu * image.at(x0 + 1, y0 + 1)[c]);
      }
    }
  }
  return large;
}

}  // namespace lorgnette::validation
