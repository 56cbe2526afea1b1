// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/units.h"
#include "render/lighting.h"

namespace lorgnette {
namespace {

// Enough of the frame's vertices to tell distances to a few mm, by columns.
class SomeVertices {
 public:
  explicit SomeVertices(const TriangleMesh& frame) {
    const std::size_t n = frame.positions.size();
    for (std::size_t i = 0; i < kVertices && n > 0; ++i) {
      const Eigen::Vector3f p = frame.positions[i * n / kVertices].cast<float>();
      x_[i] = p.x();
      y_[i] = p.y();
      z_[i] = p.z();
    }
  }
  float DistanceToNearest(const Eigen::Vector3f& from) const {
    // In lanes, which the compiler puts side by side; it does not so for a single minimum.
    constexpr std::size_t kLanes = 16;
    float nearest[kLanes];
    std::fill_n(nearest, kLanes, std::numeric_limits<float>::max());
    for (std::size_t i = 0; i < kVertices; i += kLanes) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        const float dx = x_[i + k] - from.x(), dy = y_[i + k] - from.y(), dz = z_[i + k] - from.z();
        const float squared = dx * dx + dy * dy + dz * dz;
        nearest[k] = squared < nearest[k] ? squared : nearest[k];
      }
    }
    return std::max(std::sqrt(*std::min_element(nearest, nearest + kLanes)), 1.0f);
  }

 private:
  static constexpr std::size_t kVertices = 512;
  float x_[kVertices] = {}, y_[kVertices] = {}, z_[kVertices] = {};
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
  baked.lattice_ = FaceLattice(face, frame, options.spacing_near_mm, options.spacing_far_mm);
  const std::vector<LatticePoint>& points = baked.lattice_.points();

  const std::vector<Eigen::Vector3f> sphere = SphereDirections(options.directions);
  baked.sphere_ = DirectionColumns(sphere);
  if (options.sees_face) baked.views_.emplace(face, sphere.size());

  std::vector<Lists> lists(points.size());
  const auto trace = [&](const std::vector<std::uint32_t>& which) {
    tbb::parallel_for(std::size_t(0), which.size(), [&](std::size_t k) {
      const LatticePoint& at = points[which[k]];
      lists[which[k]] = baked.ListBlocked(scene, at, face.triangles[at.triangle]);
    });
  };
  // A point between two others is traced where they do not see about the same of the frame.
  std::vector<bool> waits(points.size(), false);
  for (const auto& level : baked.lattice_.between()) {
    for (const FaceLattice::Between& b : level) waits[b.point] = true;
  }
  std::vector<std::uint32_t> now;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!waits[i]) now.push_back(i);
  }
  trace(now);
  std::vector<std::uint32_t> stands_for(
      points.size());  // a traced point, beside those that are not
  std::iota(stands_for.begin(), stands_for.end(), 0u);
  for (const auto& level : baked.lattice_.between()) {
    now.clear();
    for (const FaceLattice::Between& b : level) {
      const Lists &one = lists[stands_for[b.one]], &other = lists[stands_for[b.other]];
      if (one.buried || other.buried || one.DifferenceTo(other) > options.most_difference) {
        now.push_back(b.point);
      } else {
        stands_for[b.point] = stands_for[b.one];
        baked.means_.push_back(b);
      }
    }
    trace(now);
  }

  std::vector<bool> is_touched(points.size(), false);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (lists[i].blocked.empty()) continue;
    is_touched[i] = true;
    const LatticePoint& at = points[i];
    baked.touched_.push_back(
        {i, face.triangles[at.triangle], at.u, at.v, i, at.position, 0, std::move(lists[i])});
  }
  const SomeVertices some(frame);
  tbb::parallel_for(std::size_t(0), baked.touched_.size(), [&](std::size_t k) {
    Touched& point = baked.touched_[k];
    point.to_frame_mm = some.DistanceToNearest(point.baked_at);
  });
  baked.BakeOpenLight(face, sphere);
  baked.FindNeighbours();
  for (const FaceLattice::Between& b : baked.means_) {
    is_touched[b.point] = is_touched[b.one] || is_touched[b.other];
  }
  baked.lattice_.Touch(is_touched);
  return baked;
}

BakedShadow::Lists BakedShadow::ListBlocked(const EmbreeScene& scene, const LatticePoint& at,
                                            const Eigen::Vector3i& corners) {
  thread_local std::vector<Blocked> thread_blocked, thread_hidden;
  std::vector<Blocked>&blocked = thread_blocked, &hidden = thread_hidden;
  blocked.clear();
  hidden.clear();
  std::int32_t above = 0;
  ForHemispherePackets(sphere_, at.position + kFrameLift_mm * at.normal, at.normal,
                       [&](std::size_t first, RayPacket& packet, const float* cosine) {
                         scene.Occluded16(RaySet::kFrame, packet);
                         // Most packets pass the frame.
                         float least = 0;
                         for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                           above -= packet.valid[k];
                           least = packet.far[k] < least ? packet.far[k] : least;
                         }
                         if (least == 0) return;
                         for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
                           if (packet.far[k] >= 0) continue;
                           blocked.push_back({std::uint16_t(first + k),
                                              std::uint16_t(std::lrint(kCosineUnits * cosine[k]))});
                         }
                       });
  Lists lists;
  lists.above = std::uint32_t(above);
  lists.buried = blocked.size() == lists.above;
  if (views_) {
    // Those that the face hides go behind the others.
    thread_local std::vector<std::uint8_t> is_hidden;
    FindHidden(scene, at, corners, blocked, is_hidden);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < blocked.size(); ++k) {
      if (is_hidden[k]) {
        hidden.push_back(blocked[k]);
      } else {
        blocked[kept++] = blocked[k];
      }
    }
    blocked.resize(kept);
  }
  lists.seen = std::uint32_t(blocked.size());
  lists.blocked.reserve(blocked.size() + hidden.size());
  lists.blocked.assign(blocked.begin(), blocked.end());
  lists.blocked.insert(lists.blocked.end(), hidden.begin(), hidden.end());
  for (std::size_t part = 0; part < 2; ++part) {
    lists.bits[part].assign((sphere_.size() + 63) / 64, 0);
    for (const Blocked& b : part == 0 ? blocked : hidden) {
      lists.bits[part][b.direction / 64] |= std::uint64_t(1) << (b.direction % 64);
    }
  }
  return lists;
}

float BakedShadow::Lists::DifferenceTo(const Lists& other) const {
  int differ = 0;
  for (std::size_t part = 0; part < 2; ++part) {
    for (std::size_t k = 0; k < bits[part].size(); ++k) {
      differ += std::popcount(bits[part][k] ^ other.bits[part][k]);
    }
  }
  return float(differ) / float(std::max(above, 1u));
}

std::size_t BakedShadow::Follow(const EmbreeScene& scene,
                                const std::vector<Eigen::Vector3f>& vertices, std::size_t most) {
  struct Moved {
    float weight;
    std::uint32_t touched;
    Eigen::Vector3f to;
  };
  std::vector<Moved> moved;
  for (std::uint32_t i = 0; i < touched_.size(); ++i) {
    const Touched& point = touched_[i];
    const float w[3] = {1 - point.u - point.v, point.u, point.v};
    Eigen::Vector3f to = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) to += w[k] * vertices[std::size_t(point.vertices[k])];
    const float by = (to - point.baked_at).norm();
    if (by < std::max(kMoved_mm, kMovedShare * point.to_frame_mm)) continue;
    moved.push_back({by / point.to_frame_mm * float(point.lists.blocked.size()), i, to});
  }
  if (moved.size() > most) {
    const auto last = moved.begin() + std::ptrdiff_t(most);
    std::nth_element(moved.begin(), last, moved.end(), [](const Moved& a, const Moved& b) {
      return a.weight != b.weight ? a.weight > b.weight : a.touched < b.touched;
    });
    moved.erase(last, moved.end());
  }
  std::atomic<bool> other_buried = false;
  tbb::parallel_for(std::size_t(0), moved.size(), [&](std::size_t k) {
    Touched& point = touched_[moved[k].touched];
    LatticePoint at = lattice_.points()[point.point];
    at.position = point.baked_at = moved[k].to;
    const bool buried = point.lists.buried;
    point.lists = ListBlocked(scene, at, point.vertices);
    if (point.lists.buried != buried) other_buried = true;
  });
  if (other_buried) FindNeighbours();
  return moved.size();
}

void BakedShadow::FindNeighbours() {
  const std::vector<LatticePoint>& points = lattice_.points();
  for (Touched& point : touched_) {
    if (!point.lists.buried) continue;
    float nearest = std::numeric_limits<float>::infinity();
    for (const Touched& other : touched_) {
      if (other.lists.buried) continue;
      const float distance =
          (points[other.point].position - points[point.point].position).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      point.like = other.point;
    }
  }
}

void BakedShadow::FindHidden(const EmbreeScene& scene, const LatticePoint& at,
                             const Eigen::Vector3i& corners, const std::vector<Blocked>& blocked,
                             std::vector<std::uint8_t>& hidden) {
  const Eigen::Vector3f origin = at.position + kFaceLift_mm * at.normal;
  hidden.resize(blocked.size());
  for (int k = 0; k < 3 && !blocked.empty(); ++k) {
    views_->Prepare(scene, sphere_, std::size_t(corners[k]));
  }
  RayPacket packet;
  std::size_t asked[RayPacket::kSize];
  std::size_t filled = 0;
  const auto trace = [&] {
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) packet.Choose(k, k < filled);
    scene.Occluded16(RaySet::kHead, packet);
    for (std::size_t k = 0; k < filled; ++k) hidden[asked[k]] = packet.far[k] < 0;
    filled = 0;
  };
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    const std::size_t direction = blocked[i].direction;
    const FaceViews::View view = views_->FromTriangle(corners, direction);
    hidden[i] = view == FaceViews::View::kHidden;
    if (view != FaceViews::View::kUnknown) continue;
    packet.Set(filled, origin, sphere_[direction]);
    asked[filled] = i;
    if (++filled == RayPacket::kSize) trace();
  }
  if (filled > 0) trace();
}

void BakedShadow::BakeOpenLight(const TriangleMesh& face,
                                const std::vector<Eigen::Vector3f>& sphere) {
  std::vector<Harmonics> harmonics;
  for (const Eigen::Vector3f& d : sphere) harmonics.push_back(EvaluateHarmonics(d));
  const float solid_angle = float(4 * kPi) / float(sphere.size());
  open_.resize(face.positions.size());
  std::vector<std::uint8_t> wanted(open_.size(), 0);
  for (const Touched& point : touched_) {
    for (int k = 0; k < 3; ++k) wanted[std::size_t(point.vertices[k])] = 1;
  }
  tbb::parallel_for(std::size_t(0), open_.size(), [&](std::size_t i) {
    if (!wanted[i]) return;
    const Eigen::Vector3f normal = face.normals[i].cast<float>();
    Open& point = open_[i];
    float open = 0, total = 0;
    for (std::size_t k = 0; k < sphere.size(); ++k) {
      const float cosine = sphere[k].dot(normal);
      if (!(cosine > 0)) continue;
      const bool past_face = !views_ || views_->FromVertex(i, k) != FaceViews::View::kHidden;
      total += cosine;
      if (past_face) open += cosine;
      for (std::size_t j = 0; j < kHarmonics; ++j) {
        const float term = solid_angle * cosine * harmonics[k][j];
        point.all[j] += term;
        if (past_face) point.seen[j] += term;
      }
    }
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
    Eigen::Vector4f seen = Eigen::Vector4f::Zero(), all = Eigen::Vector4f::Zero();
    for (std::size_t j = 0; j < kHarmonics; ++j) {
      seen += open_[i].seen[j] * light.harmonics[j];
      all += open_[i].all[j] * light.harmonics[j];
    }
    lights[i] = {seen.head<3>(), all.head<3>()};
  });
  // Ringing of the harmonics could leave less light than the list has lost.
  const auto ratio = [](float open, float lost) {
    const float whole = std::max(open, lost);
    return whole > 0 ? 1 - lost / whole : 1.0f;
  };
  // Four floats a cell: one load and one multiplication for the three channels.
  std::vector<Eigen::Vector4f> cells(light.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] << light.cells[i], 0;
  const auto lost = [&](const Blocked* k, const Blocked* end) -> Eigen::Vector3f {
    Eigen::Vector4f even = Eigen::Vector4f::Zero(), odd = Eigen::Vector4f::Zero();
    for (; end - k > 1; k += 2) {
      even += float(k[0].cosine) * cells[k[0].direction];
      odd += float(k[1].cosine) * cells[k[1].direction];
    }
    if (k < end) even += float(k->cosine) * cells[k->direction];
    return (even + odd).head<3>() / kCosineUnits;
  };
  std::vector<Eigen::Vector3f> ratios(lattice_.points().size(), Eigen::Vector3f::Ones());
  tbb::parallel_for(std::size_t(0), touched_.size(), [&](std::size_t i) {
    const Touched& point = touched_[i];
    if (point.lists.buried) return;
    const Blocked* const first = point.lists.blocked.data();
    const Eigen::Vector3f lost_seen = lost(first, first + point.lists.seen);
    const Eigen::Vector3f lost_hidden =
        lost(first + point.lists.seen, first + point.lists.blocked.size());
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
  for (const Touched& point : touched_) {
    if (point.lists.buried) ratios[point.point] = ratios[point.like];
  }
  for (const FaceLattice::Between& b : means_) {
    ratios[b.point] = (ratios[b.one] + ratios[b.other]) / 2;
  }
  return ratios;
}

}  // namespace lorgnette
