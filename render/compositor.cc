// SPDX-License-Identifier: Apache-2.0
#include "render/compositor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/check.h"
#include "base/units.h"
#include "optics/trace.h"
#include "render/head_scene.h"
#include "render/ray_follower.h"

namespace lorgnette {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// First glass on a ray of head space.
struct Entry {
  std::size_t lens;
  Ray ray;  // lens frame
  SolidHit hit;
};
std::optional<Entry> FirstGlass(const HeadScene& head, const Ray& ray) {
  std::optional<Entry> nearest;
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const Eigen::Isometry3d& m = head.lenses[i].lens_from_head();
    const Ray local{m * ray.origin, m.linear() * ray.direction};
    const auto hit = head.lenses[i].Enter(local);
    if (hit && (!nearest || hit->distance < nearest->hit.distance)) nearest = Entry{i, local, *hit};
  }
  return nearest;
}

}  // namespace

struct Compositor::Scene {
  HeadScene head;
};

Compositor::Compositor(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
Compositor::Compositor(Compositor&&) noexcept = default;
Compositor::~Compositor() = default;

Result<Compositor> Compositor::Create(const Eyewear& eyewear, const TriangleMesh& face,
                                      const TriangleMesh& occluder, const Environment& environment,
                                      const CompositorOptions& options) {
  LG_ASSIGN(HeadScene head, HeadScene::Build(eyewear, face, occluder, environment, options));
  return Compositor(std::make_unique<Scene>(Scene{std::move(head)}));
}

void Compositor::UpdateFace(const std::vector<Eigen::Vector3f>& vertices) {
  HeadScene& head = scene_->head;
  LG_CHECK_EQ(vertices.size(), head.face_vertices.size());
  head.face_vertices = vertices;
  head.scene.MoveFace(vertices);
}

void Compositor::SetEnvironmentScale(double scale) {
  scene_->head.options.environment_scale = scale;
}

ImageRgbF Compositor::Render(const ImageRgbF& input, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head,
                             RenderCounts* counts) const {
  LG_CHECK_EQ(input.width, camera.width);
  LG_CHECK_EQ(input.height, camera.height);
  const HeadScene& head = scene_->head;
  const RayFollower follower(head, input, camera, camera_from_head);
  const Eigen::Isometry3d head_from_camera = camera_from_head.inverse();
  const Eigen::Vector3d eye = head_from_camera.translation();
  const int side = head.options.samples_per_side;
  const float share = 1.0f / float(side * side);

  ImageRgbF output = input;
  RenderCounts total;
  std::mutex mutex;
  tbb::parallel_for(0, input.height, [&](int row) {
    RenderCounts here;
    for (int column = 0; column < input.width; ++column) {
      PixelState pixel;
      pixel.seed = std::uint32_t(row) * 7919u + std::uint32_t(column) * 104729u;
      const Eigen::Map<const Eigen::Vector3f> own(input.at(column, row));
      Eigen::Vector3f inserted = Eigen::Vector3f::Zero();
      float direct = 0;  // share of the pixel that sees the head or background as before
      std::optional<Eigen::Vector3f> ratio;
      bool lens = false, frame = false;
      for (int s = 0; s < side * side; ++s) {
        const double x = column + (s % side + 0.5) / side, y = row + (s / side + 0.5) / side;
        const Ray ray{eye, (head_from_camera.linear() * camera.Direction(x, y)).normalized()};
        const Eigen::Vector3f origin = ray.origin.cast<float>();
        const Eigen::Vector3f direction = ray.direction.cast<float>();
        const SceneHit hit = head.scene.Intersect(RaySet::kAll, origin, direction, 0, kInfinity);
        const auto glass = FirstGlass(head, ray);
        if (glass && (!hit.hit() || glass->hit.distance < double(hit.distance))) {
          lens = true;
          inserted += share * follower.EnterGlass(glass->lens, glass->ray, glass->hit, 1, 0, pixel);
          continue;
        }
        float opacity = 0;
        SceneHit skin = hit;
        Eigen::Vector3f point = origin + hit.distance * direction;
        if (hit.object == SceneObject::kFrame) {
          opacity = follower.FrameOpacity(hit, point);
          if (opacity > 0) {
            frame = true;
            inserted += share * opacity * follower.Frame(hit, point, direction);
          }
          if (opacity < 1) {
            skin = head.scene.Intersect(RaySet::kHead, origin, direction, 0, kInfinity);
            point = origin + skin.distance * direction;
          }
        }
        direct += share * (1 - opacity);
        if (opacity < 1 && !ratio && skin.hit()) ratio = follower.FaceRatio(skin, point, pixel);
      }
      const bool shadowed = ratio && (ratio->array() != 1.0f).any();
      here.lens_pixels += lens;
      here.frame_pixels += frame;
      here.shadowed_pixels += shadowed && direct > 0;
      here.filled_samples += pixel.filled;
      if (!lens && !frame && !shadowed) continue;
      Eigen::Vector3f value = direct * own;
      if (shadowed) value = value.cwiseProduct(*ratio);
      value += inserted;
      std::copy(value.data(), value.data() + 3, output.at(column, row));
    }
    const std::lock_guard lock(mutex);
    total.lens_pixels += here.lens_pixels;
    total.frame_pixels += here.frame_pixels;
    total.shadowed_pixels += here.shadowed_pixels;
    total.filled_samples += here.filled_samples;
  });
  if (counts != nullptr) *counts = total;
  return output;
}

ImageRgbaF Compositor::HitMap(const Camera& camera,
                              const Eigen::Isometry3d& camera_from_head) const {
  const HeadScene& head = scene_->head;
  const Eigen::Isometry3d head_from_camera = camera_from_head.inverse();
  ImageRgbaF map(camera.width, camera.height);
  tbb::parallel_for(0, camera.height, [&](int row) {
    for (int column = 0; column < camera.width; ++column) {
      const Ray ray{
          head_from_camera.translation(),
          (head_from_camera.linear() * camera.Direction(column + 0.5, row + 0.5)).normalized()};
      const auto trace = [&](RaySet set, const Ray& r, double far) {
        return head.scene.Intersect(set, r.origin.cast<float>(), r.direction.cast<float>(), 0,
                                    float(far));
      };
      float* out = map.at(column, row);
      const auto write = [&](HitCode code) { out[3] = float(code); };
      const SceneHit direct = trace(RaySet::kAll, ray, kInfinity);
      const auto glass = FirstGlass(head, ray);
      if (!glass || (direct.hit() && double(direct.distance) < glass->hit.distance)) {
        write(!direct.hit()                          ? HitCode::kBackground
              : direct.object == SceneObject::kFrame ? HitCode::kFrame
                                                     : HitCode::kHead);
        continue;
      }
      const LensSolid& solid = head.lenses[glass->lens];
      const double index = solid.lens().medium.index_d;
      const auto in = Refract(glass->ray.direction, glass->hit.normal, 1 / index);
      const Ray inside{glass->hit.point, in->normalized()};
      const auto leave = solid.Leave(inside);
      const Eigen::Isometry3d& m = solid.head_from_lens();
      if (leave &&
          trace(RaySet::kFrame, {m * inside.origin, m.linear() * inside.direction}, leave->distance)
              .hit()) {
        write(HitCode::kFrame);
        continue;
      }
      const auto exit = leave ? Refract(inside.direction, leave->normal, index) : std::nullopt;
      if (!exit || glass->hit.face == LensFace::kWall || leave->face == LensFace::kWall ||
          leave->face == glass->hit.face) {
        write(HitCode::kEdge);
        continue;
      }
      const Ray leaving{m * leave->point, m.linear() * exit->normalized()};
      const SceneHit end = trace(RaySet::kAll, leaving, kInfinity);
      if (!end.hit()) {
        write(HitCode::kLensToBackground);
      } else if (end.object == SceneObject::kFrame) {
        write(HitCode::kFrame);
      } else {
        const Eigen::Vector3d point = leaving.origin + double(end.distance) * leaving.direction;
        for (int k = 0; k < 3; ++k) out[k] = float(point[k]);
        write(glass->lens == 0 ? HitCode::kRightLensToHead : HitCode::kLeftLensToHead);
      }
    }
  });
  return map;
}

double Compositor::MatchExposure(const ImageRgbF& input, const Camera& camera,
                                 const Eigen::Isometry3d& camera_from_head) const {
  constexpr double kSkinAlbedo = 0.4;
  const HeadScene& head = scene_->head;
  const PictureView picture(input, camera, camera_from_head, head.scene, head.face_vertices,
                            head.face_triangles, 1e4);
  const Eigen::Matrix3f world_from_head =
      (head.options.world_from_camera * camera_from_head.rotation()).cast<float>();
  const HeadLight light = LightAt(head.directions, head.cells, world_from_head, 1);
  // Irradiance of the vertices that face the camera, by what lies above each one's tangent plane.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  long count = 0;
  const std::size_t step = std::max<std::size_t>(1, head.face_vertices.size() / 200);
  for (std::size_t i = 0; i < head.face_vertices.size(); i += step) {
    const Eigen::Vector3f& n = head.face_normals[i];
    if (n.dot(picture.eye() - head.face_vertices[i]) <= 0) continue;
    ++count;
    for (std::size_t k = 0; k < head.directions.size(); ++k) {
      sum += (std::max(0.0f, n.dot(head.directions[k])) * light.cells[k]).cast<double>();
    }
  }
  const Eigen::Vector3d luma(0.2126, 0.7152, 0.0722);
  const double expected = count > 0 ? kSkinAlbedo / kPi * luma.dot(sum) / double(count) : 0;
  const double found = luma.dot(picture.face_mean().cast<double>());
  return expected > 0 && found > 0 ? found / expected : 1;
}

}  // namespace lorgnette
