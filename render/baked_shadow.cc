// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/units.h"
#include "render/lighting.h"
#include "render/visibility.h"

namespace lorgnette {
namespace {

constexpr double kNear_mm = 6;  // contact shadows are sharper than the far lattice up to here
constexpr int kOpenDirections = 256;
constexpr int kMaxCells = 24;  // along a triangle's side
constexpr float kFrameLift_mm = 0.02f;
// Smooth normals rise above the flat triangles; rays against the face start this far off it.
constexpr float kFaceLift_mm = 0.3f;

// Cubes of side kNear_mm that hold a vertex of the frame, or neighbour one that does.
class NearFrame {
 public:
  explicit NearFrame(const TriangleMesh& frame) {
    for (const Eigen::Vector3d& p : frame.positions) {
      const Eigen::Vector3i c = Cell(p);
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) cells_.insert(Key(c + Eigen::Vector3i(dx, dy, dz)));
        }
      }
    }
  }
  bool Contains(const Eigen::Vector3d& p) const { return cells_.contains(Key(Cell(p))); }

 private:
  static Eigen::Vector3i Cell(const Eigen::Vector3d& p) {
    return (p / kNear_mm).array().floor().cast<int>();
  }
  static std::int64_t Key(const Eigen::Vector3i& c) {
    constexpr std::int64_t kBias = 1 << 20;
    return ((c.x() + kBias) << 42) | ((c.y() + kBias) << 21) | (c.z() + kBias);
  }
  std::unordered_set<std::int64_t> cells_;
};

struct LatticeCorner {
  std::uint32_t triangle;
  float u, v;
};

}  // namespace

float WeightOfOpenShare(float open_share) {
  constexpr float kNone = 0.1f, kFull = 0.4f;
  const float s = std::clamp((open_share - kNone) / (kFull - kNone), 0.0f, 1.0f);
  return s * s * (3 - 2 * s);
}

BakedShadow BakedShadow::Bake(const EmbreeScene& scene, const TriangleMesh& face,
                              const TriangleMesh& frame, const ShadowOptions& options) {
  BakedShadow baked;
  const NearFrame near_frame(frame);
  std::vector<LatticeCorner> points;
  // Points at the mesh's own vertices are shared by its triangles.
  constexpr std::uint32_t kUnset = ~0u;
  std::vector<std::uint32_t> vertex_point(face.positions.size(), kUnset);
  for (std::size_t t = 0; t < face.triangles.size(); ++t) {
    const Eigen::Vector3i& triangle = face.triangles[t];
    const Eigen::Vector3d corners[3] = {face.positions[std::size_t(triangle[0])],
                                        face.positions[std::size_t(triangle[1])],
                                        face.positions[std::size_t(triangle[2])]};
    const double side =
        std::max({(corners[0] - corners[1]).norm(), (corners[1] - corners[2]).norm(),
                  (corners[2] - corners[0]).norm()});
    const bool near = near_frame.Contains((corners[0] + corners[1] + corners[2]) / 3) ||
                      near_frame.Contains(corners[0]) || near_frame.Contains(corners[1]) ||
                      near_frame.Contains(corners[2]);
    const double spacing = near ? options.spacing_near_mm : options.spacing_far_mm;
    const int cells = std::clamp(int(std::ceil(side / spacing)), 1, kMaxCells);
    baked.lattices_.push_back({std::uint32_t(baked.corners_.size()), std::uint16_t(cells), false});
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i + j <= cells; ++i) {
        const int corner = i == cells ? 1 : j == cells ? 2 : i + j == 0 ? 0 : -1;
        std::uint32_t* shared = corner < 0 ? nullptr : &vertex_point[std::size_t(triangle[corner])];
        if (shared != nullptr && *shared != kUnset) {
          baked.corners_.push_back(*shared);
          continue;
        }
        if (shared != nullptr) *shared = std::uint32_t(points.size());
        baked.corners_.push_back(std::uint32_t(points.size()));
        points.push_back({std::uint32_t(t), float(i) / float(cells), float(j) / float(cells)});
      }
    }
  }
  baked.point_count_ = points.size();

  baked.BakeOpenLight(scene, face, options);

  const std::vector<Eigen::Vector3f> sphere = SphereDirections(options.directions);
  std::vector<std::vector<Blocked>> results(points.size());
  std::vector<std::uint8_t> buried(points.size(), 0);  // no way out past the frame
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    const LatticeCorner& at = points[i];
    const Eigen::Vector3i& triangle = face.triangles[at.triangle];
    const float w[3] = {1 - at.u - at.v, at.u, at.v};
    Eigen::Vector3f position = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) {
      position += w[k] * face.positions[std::size_t(triangle[k])].cast<float>();
      normal += w[k] * face.normals[std::size_t(triangle[k])].cast<float>();
    }
    normal.normalize();
    std::vector<Blocked>& blocked = results[i];
    std::size_t above = 0;
    ForHemispherePackets(sphere, position + kFrameLift_mm * normal, normal,
                         [&](std::size_t first, RayPacket& packet, const float* cosine) {
                           scene.Occluded16(RaySet::kFrame, packet);
                           for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                             if (!packet.valid[k]) continue;
                             ++above;
                             if (packet.far[k] >= 0) continue;
                             blocked.push_back({std::uint16_t(first + k), false, cosine[k]});
                           }
                         });
    buried[i] = blocked.size() == above;
    if (options.sees_face) {
      MarkWhatTheFaceHides(scene, sphere, position + kFaceLift_mm * normal, blocked);
    }
  });

  std::vector<bool> is_touched(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (results[i].empty()) continue;
    is_touched[i] = true;
    baked.touched_.push_back({std::uint32_t(i), std::uint32_t(baked.blocked_.size()),
                              std::uint32_t(results[i].size()), face.triangles[points[i].triangle],
                              points[i].u, points[i].v, bool(buried[i])});
    baked.blocked_.insert(baked.blocked_.end(), results[i].begin(), results[i].end());
  }
  for (Lattice& lattice : baked.lattices_) {
    const std::uint32_t n = (lattice.cells + 1u) * (lattice.cells + 2u) / 2;
    for (std::uint32_t k = 0; k < n; ++k) {
      lattice.touched = lattice.touched || is_touched[baked.corners_[lattice.first + k]];
    }
  }
  return baked;
}

void BakedShadow::MarkWhatTheFaceHides(const EmbreeScene& scene,
                                       const std::vector<Eigen::Vector3f>& sphere,
                                       const Eigen::Vector3f& origin,
                                       std::vector<Blocked>& blocked) {
  for (std::size_t first = 0; first < blocked.size(); first += RayPacket::kSize) {
    RayPacket packet;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const bool valid = first + k < blocked.size();
      const Eigen::Vector3f& d = sphere[blocked[valid ? first + k : first].direction];
      packet.valid[k] = valid;
      packet.ox[k] = origin.x();
      packet.oy[k] = origin.y();
      packet.oz[k] = origin.z();
      packet.near[k] = 0;
      packet.dx[k] = d.x();
      packet.dy[k] = d.y();
      packet.dz[k] = d.z();
      packet.far[k] = std::numeric_limits<float>::infinity();
    }
    scene.Occluded16(RaySet::kHead, packet);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      if (packet.valid[k]) blocked[first + k].hidden = packet.far[k] < 0;
    }
  }
}

void BakedShadow::BakeOpenLight(const EmbreeScene& scene, const TriangleMesh& face,
                                const ShadowOptions& options) {
  const std::vector<Eigen::Vector3f> sphere = SphereDirections(kOpenDirections);
  std::vector<Harmonics> harmonics;
  for (const Eigen::Vector3f& d : sphere) harmonics.push_back(EvaluateHarmonics(d));
  const float solid_angle = float(4 * kPi) / kOpenDirections;
  open_.resize(face.positions.size());
  tbb::parallel_for(std::size_t(0), face.positions.size(), [&](std::size_t i) {
    const Eigen::Vector3f normal = face.normals[i].cast<float>();
    Open& point = open_[i];
    point.seen.fill(0);
    point.all.fill(0);
    float open = 0, total = 0;
    ForHemispherePackets(sphere, face.positions[i].cast<float>() + kFaceLift_mm * normal, normal,
                         [&](std::size_t first, RayPacket& packet, const float* cosine) {
                           if (options.sees_face) scene.Occluded16(RaySet::kHead, packet);
                           for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                             if (!packet.valid[k]) continue;
                             const bool past_face = packet.far[k] >= 0;
                             total += cosine[k];
                             if (past_face) open += cosine[k];
                             for (std::size_t j = 0; j < kHarmonics; ++j) {
                               const float term = solid_angle * cosine[k] * harmonics[first + k][j];
                               point.all[j] += term;
                               if (past_face) point.seen[j] += term;
                             }
                           }
                         });
    point.share = total > 0 ? open / total : 0;
  });
}

std::vector<Eigen::Vector3f> BakedShadow::Relight(const HeadLight& light) const {
  // Light at the vertices, past the face and as if there were none.
  struct VertexLight {
    Eigen::Vector3f seen, all;
  };
  std::vector<VertexLight> lights(open_.size());
  tbb::parallel_for(std::size_t(0), open_.size(), [&](std::size_t i) {
    Eigen::Vector3f seen = Eigen::Vector3f::Zero(), all = Eigen::Vector3f::Zero();
    for (std::size_t j = 0; j < kHarmonics; ++j) {
      seen += open_[i].seen[j] * light.harmonics[j];
      all += open_[i].all[j] * light.harmonics[j];
    }
    lights[i] = {seen, all};
  });
  // Ringing of the harmonics could leave less light than the list has lost.
  const auto ratio = [](float open, float lost) {
    const float whole = std::max(open, lost);
    return whole > 0 ? 1 - lost / whole : 1.0f;
  };
  std::vector<Eigen::Vector3f> ratios(point_count_, Eigen::Vector3f::Ones());
  tbb::parallel_for(std::size_t(0), touched_.size(), [&](std::size_t i) {
    const Touched& point = touched_[i];
    if (point.buried) {
      ratios[point.point].setConstant(kBuried);
      return;
    }
    Eigen::Vector3f lost_seen = Eigen::Vector3f::Zero(), lost_hidden = Eigen::Vector3f::Zero();
    for (std::uint32_t k = 0; k < point.blocked_count; ++k) {
      const Blocked& b = blocked_[point.first_blocked + k];
      (b.hidden ? lost_hidden : lost_seen) += b.cosine * light.cells[b.direction];
    }
    const float w[3] = {1 - point.u - point.v, point.u, point.v};
    Eigen::Vector3f seen = Eigen::Vector3f::Zero(), all = Eigen::Vector3f::Zero();
    float share = 0;
    for (int k = 0; k < 3; ++k) {
      const std::size_t vertex = std::size_t(point.vertices[k]);
      seen += w[k] * lights[vertex].seen;
      all += w[k] * lights[vertex].all;
      share += w[k] * open_[vertex].share;
    }
    const float weight = WeightOfOpenShare(share);
    for (int c = 0; c < 3; ++c) {
      ratios[point.point][c] = weight * ratio(seen[c], lost_seen[c]) +
                               (1 - weight) * ratio(all[c], lost_seen[c] + lost_hidden[c]);
    }
  });
  return ratios;
}

Eigen::Vector3f BakedShadow::Ratio(const std::vector<Eigen::Vector3f>& relit,
                                   std::uint32_t triangle, float u, float v) const {
  const Lattice& lattice = lattices_[triangle];
  if (!lattice.touched) return Eigen::Vector3f::Ones();
  const int cells = lattice.cells;
  const float x = std::clamp(u, 0.0f, 1.0f) * float(cells);
  const float y = std::clamp(v, 0.0f, 1.0f) * float(cells);
  const int j = std::min(int(y), cells - 1);
  const int i = std::min(int(x), cells - 1 - j);
  const float fx = std::clamp(x - float(i), 0.0f, 1.0f), fy = std::clamp(y - float(j), 0.0f, 1.0f);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  const auto add = [&](float w, int column, int row) {
    const int index = row * (cells + 1) - row * (row - 1) / 2 + column;
    const Eigen::Vector3f& ratio = relit[corners_[lattice.first + std::size_t(index)]];
    if (ratio.x() == kBuried) return;
    sum += w * ratio;
    weight += w;
  };
  if (fx + fy <= 1 || i + j + 2 > cells) {
    add(std::max(1 - fx - fy, 0.0f), i, j);
    add(fx, i + 1, j);
    add(fy, i, j + 1);
  } else {
    add(fx + fy - 1, i + 1, j + 1);
    add(1 - fx, i, j + 1);
    add(1 - fy, i + 1, j);
  }
  constexpr float kLeastWeight = 1e-3f;
  return weight > kLeastWeight ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Ones();
}

}  // namespace lorgnette
