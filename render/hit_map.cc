// SPDX-License-Identifier: Apache-2.0
#include "render/hit_map.h"

#include <tbb/parallel_for.h>

#include "optics/trace.h"
#include "render/compositor.h"

namespace lorgnette {
namespace {

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

ImageRgbaF TraceHitMap(const HeadScene& head, const Camera& camera,
                       const Eigen::Isometry3d& camera_from_head) {
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
      const SceneHit direct = trace(RaySet::kAll, ray, kEndless);
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
      if (!exit || glass->hit.face == SolidFace::kWall || leave->face == SolidFace::kWall ||
          leave->face == glass->hit.face) {
        write(HitCode::kEdge);
        continue;
      }
      const Ray leaving{m * leave->point, m.linear() * exit->normalized()};
      const SceneHit end = trace(RaySet::kAll, leaving, kEndless);
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

}  // namespace lorgnette
