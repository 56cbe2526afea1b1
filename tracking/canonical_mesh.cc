// SPDX-License-Identifier: Apache-2.0
#include "tracking/canonical_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/atomic_file.h"
#include "tracking/scanned_depth.h"

namespace lorgnette {
namespace {

constexpr double kMmPerCm = 10;
constexpr std::size_t kTriangles = 898;

// The point of `points` nearest to `p`.
int Nearest(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& p) {
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  };
  return int(std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

struct Corner {
  int vertex = 0, uv = 0;  // 1-based, as in the file
};

bool ReadFace(std::istringstream& line, std::array<Corner, 3>& corners) {
  for (Corner& corner : corners) {
    std::string word;
    if (!(line >> word)) return false;
    if (std::sscanf(word.c_str(), "%d/%d", &corner.vertex, &corner.uv) != 2) return false;
  }
  return true;
}

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Result<CanonicalMesh> ReadCanonicalMesh(const std::string& path) {
  LG_ASSIGN(const std::string text, ReadFile(path));
  CanonicalMesh out;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<std::array<Corner, 3>> faces;
  std::istringstream file(text);
  int number = 0;
  for (std::string row; std::getline(file, row);) {
    ++number;
    std::istringstream line(row);
    std::string key;
    line >> key;
    bool good = true;
    if (key == "v") {
      Eigen::Vector3d p;
      good = bool(line >> p.x() >> p.y() >> p.z()) && p.allFinite();
      out.mesh.positions.push_back(p * kMmPerCm);
    } else if (key == "vt") {
      Eigen::Vector2f uv;
      good = bool(line >> uv.x() >> uv.y()) && uv.allFinite();
      uvs.emplace_back(uv.x(), 1 - uv.y());
    } else if (key == "f") {
      good = ReadFace(line, faces.emplace_back());
    }
    if (!good) {
      return Failure(fmt::format("{}:{}: got '{}', want numbers after '{}'", path, number,
                                 row.substr(0, 60), key));
    }
  }
  if (out.mesh.positions.size() != kLandmarks || faces.size() != kTriangles) {
    return Failure(fmt::format("{}: got {} vertices and {} triangles, want {} and {}", path,
                               out.mesh.positions.size(), faces.size(), kLandmarks, kTriangles));
  }
  out.mesh.uvs.assign(kLandmarks, Eigen::Vector2f::Zero());
  for (const auto& face : faces) {
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const Corner& c = face[std::size_t(k)];
      if (c.vertex < 1 || c.vertex > kLandmarks || c.uv < 1 || c.uv > int(uvs.size())) {
        return Failure(
            fmt::format("{}: a triangle names vertex {} and texture point {}, want "
                        "1..{} and 1..{}",
                        path, c.vertex, c.uv, kLandmarks, uvs.size()));
      }
      triangle[k] = c.vertex - 1;
      out.mesh.uvs[std::size_t(c.vertex - 1)] = uvs[std::size_t(c.uv - 1)];
    }
    out.mesh.triangles.push_back(triangle);
  }
  for (const Eigen::Vector3d& p : out.mesh.positions) {
    const Eigen::Vector3d reflected(-p.x(), p.y(), p.z());
    const int partner = Nearest(out.mesh.positions, reflected);
    // The file is symmetric to its last digit, 1e-5 mm.
    if ((out.mesh.positions[std::size_t(partner)] - reflected).norm() > 1e-3) {
      return Failure(path + ": got a mesh without mirror symmetry, want the canonical face");
    }
    out.mirror.push_back(partner);
  }
  out.rigid_weight = RigidWeights(out.mesh.positions);
  for (std::size_t i = 0; i < std::size_t(kLandmarks); ++i) {
    out.mesh.positions[i].z() += kScannedDepthMm[i];
  }
  ComputeVertexNormals(out.mesh);
  return out;
}

std::vector<double> RigidWeights(const std::vector<Eigen::Vector3d>& canonical_mm) {
  std::vector<double> weights;
  weights.reserve(canonical_mm.size());
  for (const Eigen::Vector3d& p : canonical_mm) {
    // Mouth and jaw lie below the nose; they move with speech.
    const double above_mouth = SmoothStep(-28, -8, p.y());
    // Behind the cheekbones the network follows the outline of the head, not a point of it.
    const double before_ears = SmoothStep(-5, 22, p.z());
    // Brows and lids move: two bands over the eyes.
    const double eye = std::exp(
        -0.5 * (std::pow((std::abs(p.x()) - 31.5) / 11, 2) + std::pow((p.y() - 27) / 5, 2)));
    const double brow =
        std::exp(-0.5 * (std::pow((std::abs(p.x()) - 36) / 20, 2) + std::pow((p.y() - 48) / 8, 2)));
    weights.push_back(above_mouth * before_ears * (1 - 0.7 * eye) * (1 - 0.7 * brow));
  }
  return weights;
}

}  // namespace lorgnette
