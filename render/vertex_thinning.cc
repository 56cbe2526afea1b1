// SPDX-License-Identifier: Apache-2.0
#include "render/vertex_thinning.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"

namespace lorgnette {
namespace {

constexpr double kApart_mm = 1.5;
const double kAlikeCosine = std::cos(RadiansFromDegrees(6));

// The neighbours alike to each vertex, one list after the other.
class Alike {
 public:
  explicit Alike(const TriangleMesh& mesh) : first_(mesh.positions.size() + 1, 0) {
    const auto for_edges = [&](const auto& visit) {
      for (const Eigen::Vector3i& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
          const auto a = std::size_t(t[k]), b = std::size_t(t[(k + 1) % 3]);
          if (mesh.normals[a].dot(mesh.normals[b]) < kAlikeCosine) continue;
          if ((mesh.positions[a] - mesh.positions[b]).norm() > kApart_mm) continue;
          visit(a, b);
          visit(b, a);
        }
      }
    };
    for_edges([&](std::size_t a, std::size_t) { ++first_[a + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    others_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_edges([&](std::size_t a, std::size_t b) { others_[next[a]++] = std::uint32_t(b); });
  }
  const std::uint32_t* begin(std::size_t i) const { return others_.data() + first_[i]; }
  const std::uint32_t* end(std::size_t i) const { return others_.data() + first_[i + 1]; }

 private:
  std::vector<std::uint32_t> first_, others_;
};

}  // namespace

VertexThinning::VertexThinning(const TriangleMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  LG_CHECK_EQ(mesh.normals.size(), count);
  const Alike alike(mesh);
  constexpr std::uint32_t kNot = ~0u;
  std::vector<std::uint32_t> place(count, kNot);
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_one = std::any_of(alike.begin(i), alike.end(i),
                                     [&](std::uint32_t other) { return place[other] != kNot; });
    if (has_one) continue;
    place[i] = std::uint32_t(kept_.size());
    kept_.push_back(std::uint32_t(i));
  }
  sources_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (place[i] != kNot) {
      sources_[i] = {place[i], place[i], 1};
      continue;
    }
    const auto way = [&](std::uint32_t other) -> Eigen::Vector3d {
      return mesh.positions[other] - mesh.positions[i];
    };
    std::uint32_t one = kNot, other = kNot;
    double least = 1;  // cosine between the two ways
    for (const std::uint32_t* a = alike.begin(i); a != alike.end(i); ++a) {
      if (place[*a] == kNot) continue;
      if (one == kNot) one = other = *a;
      for (const std::uint32_t* b = a + 1; b != alike.end(i); ++b) {
        if (place[*b] == kNot || *b == *a) continue;
        const double cosine = way(*a).dot(way(*b)) / (way(*a).norm() * way(*b).norm());
        if (!(cosine < least)) continue;
        least = cosine;
        one = *a;
        other = *b;
      }
    }
    // The nearer counts for more.
    const double to_one = way(one).norm(), to_other = way(other).norm();
    const double share = to_one + to_other > 0 ? to_other / (to_one + to_other) : 0.5;
    sources_[i] = {place[one], place[other], float(share)};
  }
}

std::vector<Eigen::Vector3f> VertexThinning::Expanded(
    const std::vector<Eigen::Vector3f>& of_kept) const {
  LG_CHECK_EQ(of_kept.size(), kept_.size());
  std::vector<Eigen::Vector3f> all(sources_.size());
  constexpr std::size_t kVerticesATask = 8192;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all.size(), kVerticesATask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const Source& s = sources_[i];
                        all[i] = s.share * of_kept[s.one] + (1 - s.share) * of_kept[s.other];
                      }
                    });
  return all;
}

}  // namespace lorgnette
