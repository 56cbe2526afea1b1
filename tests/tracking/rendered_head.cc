// SPDX-License-Identifier: Apache-2.0
#include "tests/tracking/rendered_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "tests/tracking/synthetic_face.h"

namespace lorgnette::test {
namespace {

constexpr int kFine = 2;               // samples a pixel along each side
constexpr double kDepthSlackMm = 1.5;  // between a point and what its still shows there
constexpr double kStillYawDeg = 20, kStillDistanceMm = 600;
constexpr int kBackground = 120;

struct Surface {
  std::vector<float> depth;  // 0: nothing there
  std::vector<int> triangle;
  std::vector<Eigen::Vector3f> weights;  // barycentric, in space
};

// What a camera sees of a mesh, one sample at the middle of each of `width` x `height` cells.
Surface Rasterised(const TriangleMesh& mesh, const Camera& camera,
                   const Eigen::Isometry3d& camera_from_head) {
  const std::size_t cells = std::size_t(camera.width) * std::size_t(camera.height);
  Surface out{std::vector<float>(cells, 0), std::vector<int>(cells, -1),
              std::vector<Eigen::Vector3f>(cells)};
  std::vector<Eigen::Vector3d> at;
  std::vector<Eigen::Vector2d> px;
  for (const Eigen::Vector3d& p : mesh.positions) {
    at.push_back(camera_from_head * p);
    px.push_back(camera.Project(at.back()));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector2d, 3> q;
    Eigen::Vector3d inverse_z;
    for (int k = 0; k < 3; ++k) {
      const auto v = std::size_t(mesh.triangles[t][k]);
      q[std::size_t(k)] = px[v];
      inverse_z[k] = 1 / at[v].z();
    }
    const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
      return a.x() * b.y() - a.y() * b.x();
    };
    const double area = cross(q[1] - q[0], q[2] - q[0]);
    if (!(area < 0)) continue;  // y runs down: front sides are clockwise
    const auto low = [](double a, double b, double c) {
      return int(std::ceil(std::min({a, b, c}) - 0.5));
    };
    const auto high = [](double a, double b, double c) {
      return int(std::floor(std::max({a, b, c}) - 0.5));
    };
    const int x0 = std::max(0, low(q[0].x(), q[1].x(), q[2].x()));
    const int x1 = std::min(camera.width - 1, high(q[0].x(), q[1].x(), q[2].x()));
    const int y0 = std::max(0, low(q[0].y(), q[1].y(), q[2].y()));
    const int y1 = std::min(camera.height - 1, high(q[0].y(), q[1].y(), q[2].y()));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d s(x + 0.5, y + 0.5);
        Eigen::Vector3d w(cross(q[1] - s, q[2] - s), cross(q[2] - s, q[0] - s),
                          cross(q[0] - s, q[1] - s));
        w /= area;
        if (w.minCoeff() < -1e-9) continue;
        w = w.cwiseProduct(inverse_z);
        const double depth = 1 / w.sum();
        const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
        if (out.depth[i] > 0 && depth >= double(out.depth[i])) continue;
        out.depth[i] = float(depth);
        out.triangle[i] = int(t);
        out.weights[i] = (w * depth).cast<float>();
      }
    }
  }
  return out;
}

template <typename Values>
Eigen::Vector3d Blend(const Values& values, const Eigen::Vector3i& t, const Eigen::Vector3f& w) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) sum += double(w[k]) * values[std::size_t(t[k])];
  return sum;
}

std::optional<TriangleMesh> ReadObj(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  TriangleMesh mesh;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      Eigen::Vector3d& p = mesh.positions.emplace_back();
      words >> p.x() >> p.y() >> p.z();
    } else if (key == "f") {
      std::vector<int> corners;
      for (std::string word; words >> word;) corners.push_back(std::stoi(word) - 1);
      for (std::size_t k = 2; k < corners.size(); ++k) {
        mesh.triangles.emplace_back(corners[0], corners[k - 1], corners[k]);
      }
    }
  }
  ComputeVertexNormals(mesh);
  return mesh;
}

}  // namespace

std::optional<RenderedHead> RenderedHead::Read(const std::string& folder) {
  auto mesh = ReadObj(folder + "/common/head.obj");
  if (!mesh) return std::nullopt;
  RenderedHead head;
  head.mesh_ = std::move(*mesh);
  for (const double yaw : {0.0, kStillYawDeg}) {
    const std::string name = yaw == 0 ? "/pose_y0p0/input.png" : "/pose_y20p0/input.png";
    const cv::Mat bgr = cv::imread(folder + name, cv::IMREAD_COLOR);
    if (bgr.empty()) return std::nullopt;
    Source source;
    source.picture = ImageRgb8(bgr.cols, bgr.rows);
    cv::cvtColor(bgr, cv::Mat(bgr.rows, bgr.cols, CV_8UC3, source.picture.data.data()),
                 cv::COLOR_BGR2RGB);
    source.camera = {960, 720, 1680, 1680, 480, 360};
    source.camera_from_head = TestPose(yaw);
    source.camera_from_head.translation() = Eigen::Vector3d(0, 0, kStillDistanceMm);
    source.depth = Rasterised(head.mesh_, source.camera, source.camera_from_head).depth;
    head.sources_.push_back(source);
    if (yaw == 0) continue;
    source.mirror = -1;  // the other cheek: mesh and light are nearly symmetric
    head.sources_.push_back(source);
  }
  return head;
}

Eigen::Vector3d RenderedHead::ColourAt(const Eigen::Vector3d& p,
                                       const Eigen::Vector3d& normal) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 1e-12;
  for (const Source& s : sources_) {
    const Eigen::Vector3d mirror(s.mirror, 1, 1);
    const Eigen::Vector3d at = s.camera_from_head * p.cwiseProduct(mirror);
    const double facing =
        -(s.camera_from_head.linear() * normal.cwiseProduct(mirror)).dot(at.normalized());
    if (facing <= 0.02) continue;
    const Eigen::Vector2d px = s.camera.Project(at) - Eigen::Vector2d(0.5, 0.5);
    const int x = int(std::floor(px.x())), y = int(std::floor(px.y()));
    if (x < 0 || y < 0 || x + 1 >= s.camera.width || y + 1 >= s.camera.height) continue;
    double shown = 0;
    Eigen::Vector3d colour = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
      const int cx = x + k % 2, cy = y + k / 2;
      const double w =
          (k % 2 ? px.x() - x : 1 - px.x() + x) * (k / 2 ? px.y() - y : 1 - px.y() + y);
      const float depth = s.depth[std::size_t(cy) * std::size_t(s.camera.width) + std::size_t(cx)];
      if (!(depth > 0) || at.z() > double(depth) + kDepthSlackMm) continue;
      shown += w;
      const std::uint8_t* c = s.picture.at(cx, cy);
      colour += w * Eigen::Vector3d(c[0], c[1], c[2]);
    }
    if (shown < 0.3) continue;
    // The frontal still rules where it sees well, the others at the sides.
    const double weight = std::pow(facing, 6) * (s.camera_from_head(0, 2) == 0 ? 4 : 1);
    sum += weight / shown * colour;
    total += weight;
  }
  return sum / total;
}

ImageRgb8 RenderedHead::Draw(const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head) const {
  const Camera fine{kFine * camera.width, kFine * camera.height, kFine * camera.fx,
                    kFine * camera.fy,    kFine * camera.cx,     kFine * camera.cy};
  const Surface seen = Rasterised(mesh_, fine, camera_from_head);
  ImageRgb8 out(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = 0; k < kFine * kFine; ++k) {
        const std::size_t i = std::size_t(kFine * y + k / kFine) * std::size_t(fine.width) +
                              std::size_t(kFine * x + k % kFine);
        if (seen.triangle[i] < 0) {
          sum.array() += kBackground;
          continue;
        }
        const Eigen::Vector3i& t = mesh_.triangles[std::size_t(seen.triangle[i])];
        sum += ColourAt(Blend(mesh_.positions, t, seen.weights[i]),
                        Blend(mesh_.normals, t, seen.weights[i]).normalized());
      }
      for (int c = 0; c < 3; ++c) {
        out.at(x, y)[c] =
            std::uint8_t(std::lround(std::clamp(sum[c] / (kFine * kFine), 0.0, 255.0)));
      }
    }
  }
  return out;
}

std::optional<Eigen::Vector3d> RenderedHead::Hit(const Camera& camera,
                                                 const Eigen::Isometry3d& camera_from_head,
                                                 double px, double py) const {
  Camera one = camera;  // a picture of one cell, about the pixel
  one.width = one.height = 1;
  one.cx += 0.5 - px;
  one.cy += 0.5 - py;
  const Surface seen = Rasterised(mesh_, one, camera_from_head);
  if (seen.triangle[0] < 0) return std::nullopt;
  return Blend(mesh_.positions, mesh_.triangles[std::size_t(seen.triangle[0])], seen.weights[0]);
}

}  // namespace lorgnette::test
