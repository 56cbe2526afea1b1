// SPDX-License-Identifier: Apache-2.0
#include "render/compositor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/units.h"
#include "optics/trace.h"
#include "render/head_scene.h"
#include "render/ray_follower.h"
#include "render/tile_mask.h"
#include "render/tile_renderer.h"

namespace lorgnette {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Dominant wavelengths of the Rec.709 primaries (their chromaticities against D65's), and the width
// of a channel's band when it takes several.
constexpr double kChannel_nm[3] = {611.4, 549.1, 464.2};
constexpr double kBand_nm = 50;

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

// What the samples of one pixel sum to.
struct PixelSum {
  Eigen::Vector3f inserted{0, 0, 0}, direct{0, 0, 0};
  bool lens = false, frame = false, changed = false;
  float frame_share = 0;

  void Add(const CameraSample& s, float share) {
    using Kind = CameraSample::Kind;
    const bool through = s.kind == Kind::kLensToHead || s.kind == Kind::kLensElsewhere;
    lens |= through;
    frame |= s.kind == Kind::kFrame;
    if (s.kind == Kind::kFrame) frame_share += share * (1 - s.direct.maxCoeff());
    changed |= through || s.kind == Kind::kFrame || (s.direct.array() != 1.0f).any();
    inserted += share * s.inserted;
    direct += share * s.direct;
  }
};

// A tile's pixels of the picture: rectangle of at most kTileSide a side.
struct TileArea {
  int x0, y0, x1, y1;
};

// Samples of the pixels that `wanted` names (all of them when it is empty), side x side a pixel,
// those of one place inside their pixels together.
void PlaceSamples(const TileArea& area, int side, const std::vector<bool>& wanted,
                  std::vector<CameraSample>& samples) {
  samples.clear();
  for (int s = 0; s < side * side; ++s) {
    const float dx = (float(s % side) + 0.5f) / float(side);
    const float dy = (float(s / side) + 0.5f) / float(side);
    // Blocks of 4 x 4 pixels: one packet.
    for (int by = area.y0; by < area.y1; by += 4) {
      for (int bx = area.x0; bx < area.x1; bx += 4) {
        for (int y = by; y < std::min(by + 4, area.y1); ++y) {
          for (int x = bx; x < std::min(bx + 4, area.x1); ++x) {
            const int pixel = (y - area.y0) * kTileSide + (x - area.x0);
            if (!wanted.empty() && !wanted[std::size_t(pixel)]) continue;
            CameraSample sample;
            sample.x = float(x) + dx;
            sample.y = float(y) + dy;
            sample.pixel = std::uint16_t(pixel);
            samples.push_back(sample);
          }
        }
      }
    }
  }
}

// Pixels on the frame, and those whose neighbourhood meets different things.
std::vector<bool> PixelsToRefine(const TileArea& area, int width, int height,
                                 const std::vector<CameraSample::Kind>& kinds) {
  std::vector<bool> wanted(std::size_t(kTileSide) * kTileSide, false);
  const auto kind = [&](int x, int y) {
    return kinds[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
                 std::size_t(std::clamp(x, 0, width - 1))];
  };
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const CameraSample::Kind own = kind(x, y);
      bool refine = own == CameraSample::Kind::kFrame || own == CameraSample::Kind::kLensElsewhere;
      for (int dy = -1; dy <= 1 && !refine; ++dy) {
        for (int dx = -1; dx <= 1 && !refine; ++dx) refine = kind(x + dx, y + dy) != own;
      }
      wanted[std::size_t((y - area.y0) * kTileSide + (x - area.x0))] = refine;
    }
  }
  return wanted;
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

void Compositor::SetCameraLook(const CameraLook& look) { scene_->head.options.camera_look = look; }

void Compositor::SetEnvironmentScale(double scale) {
  scene_->head.options.environment_scale = scale;
}

ImageRgbF Compositor::Render(const ImageRgbF& input, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, RenderCounts* counts,
                             const PictureEffects* effects) const {
  LG_CHECK_EQ(input.width, camera.width);
  LG_CHECK_EQ(input.height, camera.height);
  const CompositorOptions& options = scene_->head.options;
  const PictureEffects drawn = effects != nullptr ? *effects : PictureEffects::Of(options.effects);
  const bool match = drawn.rest[Effect::kGrain];
  std::vector<float> frame_share;
  if (match) frame_share.assign(input.data.size() / 3, 0);
  ImageRgbF output;
  if (drawn.Any(Effect::kDispersion)) {
    output =
        RenderBands(input, camera, camera_from_head, drawn, counts, match ? &frame_share : nullptr);
  } else {
    output = RenderPass(input, camera, camera_from_head, drawn, std::nullopt, counts,
                        match ? &frame_share : nullptr);
  }
  if (match) {
    // A seed of the pose: another frame has other grain, another run the same.
    std::uint32_t seed = 2166136261u;
    for (const double v : camera_from_head.matrix().reshaped()) {
      seed = (seed ^ std::uint32_t(std::int64_t(v * 1e6))) * 16777619u;
    }
    ApplyCameraLook(options.camera_look, frame_share, seed, output);
  }
  return output;
}

// One picture a wavelength; a channel is the mean of those in its own band.
ImageRgbF Compositor::RenderBands(const ImageRgbF& input, const Camera& camera,
                                  const Eigen::Isometry3d& camera_from_head,
                                  const PictureEffects& effects, RenderCounts* counts,
                                  std::vector<float>* frame_share) const {
  ImageRgbF output(input.width, input.height);
  std::vector<bool> changed(output.data.size(), false);
  const int bands = scene_->head.options.wavelengths / 3;
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < bands; ++k) {
      const double at_nm = kChannel_nm[c] + kBand_nm * ((k + 0.5) / bands - 0.5);
      const bool middle = c == 1 && k == bands / 2;
      const ImageRgbF pass = RenderPass(input, camera, camera_from_head, effects, at_nm,
                                        middle ? counts : nullptr, middle ? frame_share : nullptr);
      for (std::size_t i = std::size_t(c); i < output.data.size(); i += 3) {
        changed[i] = changed[i] || pass.data[i] != input.data[i];
        output.data[i] += pass.data[i];
      }
    }
  }
  for (std::size_t i = 0; i < output.data.size(); ++i) {
    output.data[i] = changed[i] ? output.data[i] / float(bands) : input.data[i];
  }
  return output;
}

ImageRgbF Compositor::RenderPass(const ImageRgbF& input, const Camera& camera,
                                 const Eigen::Isometry3d& camera_from_head,
                                 const PictureEffects& effects, std::optional<double> wavelength_nm,
                                 RenderCounts* counts, std::vector<float>* frame_share) const {
  const HeadScene& head = scene_->head;
  const RayFollower follower(head, input, camera, camera_from_head, effects, wavelength_nm);
  const TileRenderer renderer(head, follower, camera, camera_from_head);
  const TileMask mask = MarkTiles(head, camera, camera_from_head);
  const int side = head.options.samples_per_side;
  const bool adaptive = head.options.adaptive && side > 1;

  ImageRgbF output = input;
  std::vector<RenderCounts> counts_of(mask.content.size());
  // Adaptive: what the ray through each pixel's centre met.
  std::vector<CameraSample::Kind> kinds;
  if (adaptive) {
    kinds.assign(std::size_t(input.width) * std::size_t(input.height),
                 CameraSample::Kind::kBackground);
  }
  const auto render_tile = [&](std::size_t tile, bool refine) {
    const std::uint8_t content = mask.content[tile];
    if (content == 0) return;
    const int column = int(tile) % mask.columns, row = int(tile) / mask.columns;
    const TileArea area{column * kTileSide, row * kTileSide,
                        std::min((column + 1) * kTileSide, input.width),
                        std::min((row + 1) * kTileSide, input.height)};
    std::vector<bool> wanted;
    if (refine) {
      if (content == kTileShadow) return;
      wanted = PixelsToRefine(area, input.width, input.height, kinds);
      if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return;
    }
    // The face's own pixels need no second sample: equation (2) is taken once a pixel.
    const int here = content == kTileShadow || (adaptive && !refine) ? 1 : side;
    thread_local std::vector<CameraSample> samples;
    PlaceSamples(area, here, wanted, samples);
    std::vector<PixelState> states(std::size_t(kTileSide) * kTileSide);
    for (const CameraSample& s : samples) {
      const std::uint32_t x = std::uint32_t(s.x), y = std::uint32_t(s.y);
      states[s.pixel].seed = y * 7919u + x * 104729u;
    }
    renderer.Trace(samples, content, states);
    std::vector<PixelSum> sums(states.size());
    const float share = 1.0f / float(here * here);
    for (const CameraSample& s : samples) sums[s.pixel].Add(s, share);
    RenderCounts& count = counts_of[tile];
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t pixel = std::size_t((y - area.y0) * kTileSide + (x - area.x0));
        if (!wanted.empty() && !wanted[pixel]) continue;
        const PixelSum& sum = sums[pixel];
        if (!refine) {
          count.lens_pixels += sum.lens;
          count.frame_pixels += sum.frame;
          count.shadowed_pixels += sum.changed && !sum.lens && !sum.frame;
        }
        count.filled_samples += states[pixel].filled;
        if (frame_share != nullptr) {
          (*frame_share)[std::size_t(y) * std::size_t(input.width) + std::size_t(x)] =
              sum.frame_share;
        }
        float* out = output.at(x, y);
        const float* own = input.at(x, y);
        for (int c = 0; c < 3; ++c) {
          out[c] = sum.changed ? sum.inserted[c] + sum.direct[c] * own[c] : own[c];
        }
      }
    }
    if (adaptive && !refine) {
      for (const CameraSample& s : samples) {
        kinds[std::size_t(s.y) * std::size_t(input.width) + std::size_t(s.x)] = s.kind;
      }
    }
  };
  tbb::parallel_for(std::size_t(0), mask.content.size(),
                    [&](std::size_t tile) { render_tile(tile, false); });
  if (adaptive) {
    tbb::parallel_for(std::size_t(0), mask.content.size(),
                      [&](std::size_t tile) { render_tile(tile, true); });
  }
  if (counts != nullptr) {
    *counts = {};
    for (const RenderCounts& c : counts_of) {
      counts->lens_pixels += c.lens_pixels;
      counts->frame_pixels += c.frame_pixels;
      counts->shadowed_pixels += c.shadowed_pixels;
      counts->filled_samples += c.filled_samples;
    }
  }
  return output;
}

EffectPlan Compositor::Plan(const ImageRgbF& input, const Camera& camera,
                            const Eigen::Isometry3d& camera_from_head,
                            const EffectChoice& choice) const {
  // The follower only lends its view of the picture: no shadow is lit for it.
  const RayFollower follower(scene_->head, input, camera, camera_from_head,
                             PictureEffects::Of(EffectSet::None()));
  return PlanEffects(scene_->head, follower, input, camera, camera_from_head, choice);
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
      if (!exit || glass->hit.face == SolidFace::kWall || leave->face == SolidFace::kWall ||
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
                            head.face_normals, head.face_triangles, 1e4);
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
