// SPDX-License-Identifier: Apache-2.0
#include "render/picture_view.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace lorgnette {
namespace {

constexpr float kVisibilityLift_mm = 0.6f;
// Skin seen more obliquely shares its pixels with what lies behind the silhouette.
constexpr float kGrazing = 0.2f;

// Runs `make` once. A thread that waits for the parallel loops in it takes up no other tile's work,
// which could ask for the same thing again.
template <typename Make>
void Once(std::once_flag& flag, Make&& make) {
  std::call_once(flag, [&] { tbb::this_task_arena::isolate(make); });
}

}  // namespace

PictureView::PictureView(const InputPicture& input, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_head, const EmbreeScene& scene,
                         const std::vector<Eigen::Vector3f>& face_vertices,
                         const std::vector<Eigen::Vector3f>& face_normals,
                         const std::vector<Eigen::Vector3i>& face_triangles,
                         double background_depth_mm)
    : input_(input),
      camera_(camera),
      rotation_(camera_from_head.rotation().cast<float>()),
      translation_(camera_from_head.translation().cast<float>()),
      eye_(camera_from_head.inverse().translation().cast<float>()),
      scene_(scene),
      vertices_(face_vertices),
      normals_(face_normals),
      triangles_(face_triangles),
      background_depth_(float(background_depth_mm)) {}

Eigen::Vector2f PictureView::Project(const Eigen::Vector3f& head_point) const {
  const Eigen::Vector3f p = rotation_ * head_point + translation_;
  const float inverse = 1 / p.z();
  return {float(camera_.fx) * p.x() * inverse + float(camera_.cx),
          float(camera_.fy) * p.y() * inverse + float(camera_.cy)};
}

bool PictureView::CameraSees(const Eigen::Vector3f& point) const {
  const Eigen::Vector3f to_eye = eye_ - point;
  const float distance = to_eye.norm();
  return !scene_.Occluded(RaySet::kHead, point, to_eye / distance, kVisibilityLift_mm, distance);
}

bool PictureView::Faces(const Eigen::Vector3i& t, const SceneHit& hit,
                        const Eigen::Vector3f& point) const {
  const Eigen::Vector3f normal = (1 - hit.u - hit.v) * normals_[std::size_t(t[0])] +
                                 hit.u * normals_[std::size_t(t[1])] +
                                 hit.v * normals_[std::size_t(t[2])];
  return normal.normalized().dot((eye_ - point).normalized()) >= kGrazing;
}

Eigen::Vector3f PictureView::Head(const SceneHit& hit, const Eigen::Vector3f& point,
                                  long& filled) const {
  const Eigen::Vector2f p = Project(point);
  if (hit.object == SceneObject::kFace) {
    Once(face_once_, [&] { FillFace(); });
    const Eigen::Vector3i& t = triangles_[hit.triangle];
    const bool vertices_seen = vertex_seen_[std::size_t(t[0])] && vertex_seen_[std::size_t(t[1])] &&
                               vertex_seen_[std::size_t(t[2])];
    if (!InsidePicture(p) || (!vertices_seen && (!Faces(t, hit, point) || !CameraSees(point)))) {
      ++filled;
      return (1 - hit.u - hit.v) * vertex_colours_[std::size_t(t[0])] +
             hit.u * vertex_colours_[std::size_t(t[1])] +
             hit.v * vertex_colours_[std::size_t(t[2])];
    }
  }
  return SampleSharp(input_, p.x(), p.y());
}

bool PictureView::Background(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                             float footprint_px, Eigen::Vector3f& colour, long& filled) const {
  const Eigen::Vector3f o = rotation_ * origin + translation_;
  const Eigen::Vector3f d = rotation_ * direction;
  if (d.z() <= 1e-6f) return false;
  const float t = (background_depth_ - o.z()) / d.z();
  if (t <= 0) return false;
  const Eigen::Vector3f at = o + t * d;
  const Eigen::Vector2f p(float(camera_.fx) * at.x() / at.z() + float(camera_.cx),
                          float(camera_.fy) * at.y() / at.z() + float(camera_.cy));
  const Eigen::Vector3f point = rotation_.transpose() * (at - translation_);
  const Eigen::Vector3f sight = point - eye_;
  const float distance = sight.norm();
  if (InsidePicture(p) && !scene_.Occluded(RaySet::kHead, eye_, sight / distance, 0, distance)) {
    colour = SampleMean(input_, p.x(), p.y(), footprint_px);
    return true;
  }
  Once(background_once_, [&] { FillBackground(); });
  ++filled;
  colour = background_.front().Sample(p.x(), p.y());
  return true;
}

const std::vector<Eigen::Vector3f>& PictureView::vertex_colours() const {
  Once(face_once_, [&] { FillFace(); });
  return vertex_colours_;
}

const Eigen::Vector3f& PictureView::face_brightest() const {
  Once(face_once_, [&] { FillFace(); });
  return face_brightest_;
}

const Eigen::Vector3f& PictureView::face_mean() const {
  Once(face_once_, [&] { FillFace(); });
  return face_mean_;
}

void PictureView::FillFace() const {
  const std::size_t n = vertices_.size();
  vertex_colours_.assign(n, Eigen::Vector3f::Zero());
  vertex_seen_.assign(n, 0);
  // Sixteen neighbours at a time look for the camera.
  constexpr std::size_t kPacket = RayPacket::kSize;
  tbb::parallel_for(std::size_t(0), (n + kPacket - 1) / kPacket, [&](std::size_t group) {
    const std::size_t first = group * kPacket;
    RayPacket packet;
    Eigen::Vector2f at[kPacket];
    bool any = false;
    for (std::size_t k = 0; k < kPacket; ++k) {
      const std::size_t i = std::min(first + k, n - 1);
      at[k] = Project(vertices_[i]);
      const Eigen::Vector3f to_eye = eye_ - vertices_[i];
      const float distance = to_eye.norm();
      const Eigen::Vector3f sight = to_eye / distance;
      packet.Choose(k, first + k < n && InsidePicture(at[k]) && normals_[i].dot(sight) >= kGrazing);
      any |= packet.valid[k] != 0;
      packet.Set(k, vertices_[i], sight, distance);
      packet.near[k] = kVisibilityLift_mm;
    }
    if (!any) return;
    scene_.Occluded16(RaySet::kHead, packet);
    for (std::size_t k = 0; k < kPacket; ++k) {
      if (!packet.valid[k] || packet.far[k] < 0) continue;
      vertex_seen_[first + k] = 1;
      vertex_colours_[first + k] = SampleBilinear(input_, at[k].x(), at[k].y());
    }
  });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!vertex_seen_[i]) continue;
    sum += vertex_colours_[i].cast<double>();
    face_brightest_ = face_brightest_.cwiseMax(vertex_colours_[i]);
    ++count;
  }
  face_mean_ = Eigen::Vector3f::Constant(0.25f);
  if (count > 0) face_mean_ = (sum / count).cast<float>();

  // Colour spreads over the mesh from what was seen, one ring of vertices a round.
  std::vector<float> weight(vertex_seen_.begin(), vertex_seen_.end());
  std::vector<Eigen::Vector3i> open;  // triangles with a corner that has no colour yet
  const auto complete = [&](const Eigen::Vector3i& t) {
    return weight[std::size_t(t[0])] > 0 && weight[std::size_t(t[1])] > 0 &&
           weight[std::size_t(t[2])] > 0;
  };
  for (const Eigen::Vector3i& t : triangles_) {
    if (!complete(t)) open.push_back(t);
  }
  std::vector<Eigen::Vector3f> next(n, Eigen::Vector3f::Zero());
  std::vector<float> next_weight(n, 0.0f);
  std::vector<std::size_t> reached;
  constexpr int kRounds = 48;
  for (int round = 0; round < kRounds && !open.empty(); ++round) {
    reached.clear();
    for (const Eigen::Vector3i& t : open) {
      for (int a = 0; a < 3; ++a) {
        const std::size_t to = std::size_t(t[a]);
        if (weight[to] > 0) continue;
        for (int b = 1; b < 3; ++b) {
          const std::size_t from = std::size_t(t[(a + b) % 3]);
          if (weight[from] <= 0) continue;
          if (next_weight[to] == 0) reached.push_back(to);
          next[to] += vertex_colours_[from];
          next_weight[to] += 1;
        }
      }
    }
    if (reached.empty()) break;
    for (const std::size_t i : reached) {
      vertex_colours_[i] = next[i] / next_weight[i];
      weight[i] = 1;
    }
    std::erase_if(open, complete);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (weight[i] <= 0) vertex_colours_[i] = face_mean_;
  }
}

void PictureView::FillBackground() const {
  const int step = FilledPicture::StepOf(camera_.height);
  const int width = FilledPicture::ReducedSide(camera_.width, step);
  const int height = FilledPicture::ReducedSide(camera_.height, step);
  // A reduced pixel is background when the rays at its four corners are.
  const int corners = width + 1;
  std::vector<std::uint8_t> hit(std::size_t(corners) * std::size_t(height + 1));
  tbb::parallel_for(0, height + 1, [&](int row) {
    for (int first = 0; first < corners; first += RayPacket::kSize) {
      RayPacket packet;
      for (int k = 0; k < RayPacket::kSize; ++k) {
        const Eigen::Vector3d d = camera_.Direction((first + k) * step, row * step);
        const Eigen::Vector3f head = rotation_.transpose() * d.cast<float>();
        packet.Choose(k, first + k < corners);
        packet.Set(k, eye_, head, background_depth_);
      }
      scene_.Occluded16(RaySet::kHead, packet);
      for (int k = 0; k < RayPacket::kSize && first + k < corners; ++k) {
        hit[std::size_t(row) * std::size_t(corners) + std::size_t(first + k)] = packet.far[k] < 0;
      }
    }
  });
  std::vector<std::uint8_t> known;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const std::uint8_t* corner =
          hit.data() + std::size_t(row) * std::size_t(corners) + std::size_t(column);
      known.push_back(!corner[0] && !corner[1] && !corner[corners] && !corner[corners + 1]);
    }
  }
  background_.emplace_back(input_, known);
}

}  // namespace lorgnette
