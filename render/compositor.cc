// SPDX-License-Identifier: Apache-2.0
#include "render/compositor.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/units.h"
#include "render/adaptive_samples.h"
#include "render/color.h"
#include "render/embree_scene.h"
#include "render/head_scene.h"
#include "render/hit_map.h"
#include "render/ray_follower.h"
#include "render/screen_scene.h"
#include "render/tile_mask.h"
#include "render/tile_renderer.h"

namespace lorgnette {
namespace {

// What the samples of one pixel sum to.
struct PixelSum {
  Eigen::Vector3f inserted{0, 0, 0}, direct{0, 0, 0};
  bool lens = false, frame = false, changed = false;
  float frame_share = 0;

  void Add(const CameraSample& s, float share) {
    using Kind = CameraSample::Kind;
    const bool through = s.kind == Kind::kLensToHead || s.kind == Kind::kLensToBackground ||
                         s.kind == Kind::kLensElsewhere;
    lens |= through;
    frame |= s.kind == Kind::kFrame;
    if (s.kind == Kind::kFrame) frame_share += share * (1 - s.direct.maxCoeff());
    changed |= through || s.kind == Kind::kFrame || (s.direct.array() != 1.0f).any();
    inserted += share * s.inserted;
    direct += share * s.direct;
  }
};

}  // namespace

struct Compositor::Scene {
  HeadScene head;
  bool face_has_moved = false;
};

Compositor::Compositor(std::unique_ptr<Scene> scene) : scene_(std::move(scene)) {}
Compositor::Compositor(Compositor&&) noexcept = default;
Compositor::~Compositor() = default;

Result<Compositor> Compositor::Create(const Eyewear& eyewear, const TriangleMesh& face,
                                      const TriangleMesh& occluder, const Environment& environment,
                                      const CompositorOptions& options) {
  LG_ASSIGN(HeadScene head, HeadScene::Build(eyewear, face, occluder, environment, options));
  return Compositor(std::make_unique<Scene>(Scene{std::move(head), false}));
}

void Compositor::UpdateFace(const std::vector<Eigen::Vector3f>& vertices) {
  HeadScene& head = scene_->head;
  LG_CHECK_EQ(vertices.size(), head.face_vertices.size());
  head.face_vertices = vertices;
  std::copy(vertices.begin(), vertices.end(), head.visible.vertices.begin());
  head.scene.MoveFace(vertices);
  if (!head.baked_shadow) return;
  // The first face differs from the one at rest everywhere at once.
  const std::size_t most = scene_->face_has_moved ? std::size_t(head.options.rebaked_points)
                                                  : head.baked_shadow->touched_count();
  head.baked_shadow->Follow(head.scene, vertices, most);
  scene_->face_has_moved = true;
}

void Compositor::SetCameraLook(const CameraLook& look) { scene_->head.options.camera_look = look; }

void Compositor::SetEnvironmentScale(double scale) {
  scene_->head.options.environment_scale = scale;
}

// Where the pixels of a picture go; of those that nobody puts, the input's stay.
class Compositor::Canvas {
 public:
  // A part of the picture in linear light, whose first pixel is the picture's (x0, y0).
  Canvas(ImageRgbF& linear, int x0, int y0) : linear_(&linear), x0_(x0), y0_(y0) {}
  explicit Canvas(ImageRgb8& display) : display_(&display) {}
  // Receives the frame's share of each pixel of the linear part.
  std::vector<float>* frame_share = nullptr;

  void Put(int x, int y, const Eigen::Vector3f& light) {
    if (linear_ != nullptr) {
      std::copy_n(light.data(), 3, linear_->at(x - x0_, y - y0_));
    } else {
      CodesFromLinear(light.data(), 3, display_->at(x, y));
    }
  }
  // Pixels beside each other, three values each.
  void PutRow(int x, int y, const float* light, std::size_t pixels) {
    if (linear_ != nullptr) {
      std::copy_n(light, 3 * pixels, linear_->at(x - x0_, y - y0_));
    } else {
      CodesFromLinear(light, 3 * pixels, display_->at(x, y));
    }
  }
  void PutFrameShare(int x, int y, float share) {
    if (frame_share == nullptr) return;
    (*frame_share)[std::size_t(y - y0_) * std::size_t(linear_->width) + std::size_t(x - x0_)] =
        share;
  }

 private:
  ImageRgbF* linear_ = nullptr;
  int x0_ = 0, y0_ = 0;
  ImageRgb8* display_ = nullptr;
};

// One picture, as the passes over it share it.
struct Compositor::Sitting {
  Sitting(const HeadScene& head, const InputPicture& picture, ScreenScene projected,
          const Camera& from, const Eigen::Isometry3d& pose)
      : input(picture),
        screen(std::move(projected)),
        camera(from),
        camera_from_head(pose),
        view(input, camera, camera_from_head, head.scene, head.face_vertices, head.face_normals,
             head.face_triangles,
             head.options.background_depth_mm.value_or(camera_from_head.translation().z() +
                                                       head.options.background_distance_mm)) {}
  InputPicture input;
  ScreenScene screen;
  Camera camera;
  Eigen::Isometry3d camera_from_head;
  PictureView view;
};

Compositor::Sitting Compositor::Sit(const ImageRgb8& input, const Camera& camera,
                                    const Eigen::Isometry3d& camera_from_head) const {
  ScreenScene screen = ProjectScene(scene_->head, camera, camera_from_head);
  // Refracted rays mostly read near by; what lies farther is decoded when it is read.
  const PixelBox box = Grown(screen.mask.Bounds(), 4 * kTileSide);
  return {scene_->head, InputPicture(input, box), std::move(screen), camera, camera_from_head};
}

ImageRgbF Compositor::Render(const ImageRgbF& input, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, RenderCounts* counts,
                             const PictureEffects* effects) const {
  const HeadScene& head = scene_->head;
  const Sitting sitting(head, input, ProjectScene(head, camera, camera_from_head), camera,
                        camera_from_head);
  ImageRgbF output = input;
  DrawLinear(sitting, effects != nullptr ? *effects : PictureEffects::Of(head.options.effects),
             counts, output, 0, 0);
  return output;
}

ImageRgb8 Compositor::Render(const ImageRgb8& input, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, RenderCounts* counts,
                             const PictureEffects* effects) const {
  ImageRgb8 output;
  tbb::task_group copying;
  copying.run([&] { output = input; });
  const Sitting sitting = Sit(input, camera, camera_from_head);
  copying.wait();
  DrawDisplay(sitting,
              effects != nullptr ? *effects : PictureEffects::Of(scene_->head.options.effects),
              counts, output);
  return output;
}

ImageRgb8 Compositor::Render(const ImageRgb8& input, const Camera& camera,
                             const Eigen::Isometry3d& camera_from_head, const EffectChoice& choice,
                             EffectPlan& plan, RenderCounts* counts) const {
  ImageRgb8 output;
  tbb::task_group copying;
  copying.run([&] { output = input; });
  const Sitting sitting = Sit(input, camera, camera_from_head);
  plan = PlanEffects(scene_->head, sitting.view, sitting.input, camera, camera_from_head, choice);
  copying.wait();
  DrawDisplay(sitting, plan.effects, counts, output);
  return output;
}

void Compositor::DrawLinear(const Sitting& sitting, const PictureEffects& effects,
                            RenderCounts* counts, ImageRgbF& picture, int x0, int y0) const {
  Canvas canvas(picture, x0, y0);
  std::vector<float> frame_share;
  const bool match = effects.rest[Effect::kGrain];
  if (match) {
    frame_share.assign(picture.data.size() / 3, 0);
    canvas.frame_share = &frame_share;
  }
  const RenderCounts met = Draw(sitting, effects, canvas);
  if (counts != nullptr) *counts = met;
  if (!match) return;
  // A seed of the pose: another frame has other grain, another run the same.
  std::uint32_t seed = 2166136261u;
  for (const double v : sitting.camera_from_head.matrix().reshaped()) {
    seed = (seed ^ std::uint32_t(std::int64_t(v * 1e6))) * 16777619u;
  }
  ApplyCameraLook(scene_->head.options.camera_look, frame_share, seed, x0, y0, picture);
}

void Compositor::DrawDisplay(const Sitting& sitting, const PictureEffects& effects,
                             RenderCounts* counts, ImageRgb8& output) const {
  if (!effects.rest[Effect::kGrain]) {
    Canvas canvas(output);
    const RenderCounts met = Draw(sitting, effects, canvas);
    if (counts != nullptr) *counts = met;
    return;
  }
  // Blur and grain work in linear light, on the part that changes.
  const int border = CameraLookReach(scene_->head.options.camera_look);
  const PixelBox box =
      Clipped(Grown(sitting.screen.mask.Bounds(), border), output.width, output.height);
  if (box.empty()) return;
  ImageRgbF part(box.x1 - box.x0, box.y1 - box.y0);
  tbb::parallel_for(0, part.height, [&](int y) {
    LinearFromCodes(output.at(box.x0, box.y0 + y), 3 * std::size_t(part.width), part.at(0, y));
  });
  DrawLinear(sitting, effects, counts, part, box.x0, box.y0);
  tbb::parallel_for(0, part.height, [&](int y) {
    CodesFromLinear(part.at(0, y), 3 * std::size_t(part.width), output.at(box.x0, box.y0 + y));
  });
}

RenderCounts Compositor::Draw(const Sitting& sitting, const PictureEffects& effects,
                              Canvas& canvas) const {
  const InputPicture& input = sitting.input;
  const TileMask& mask = sitting.screen.mask;
  const Camera& camera = sitting.camera;
  const Eigen::Isometry3d& camera_from_head = sitting.camera_from_head;
  LG_CHECK_EQ(input.width(), camera.width);
  LG_CHECK_EQ(input.height(), camera.height);
  std::vector<std::size_t> tiles;
  for (std::size_t i = 0; i < mask.content.size(); ++i) {
    if (mask.content[i] != 0) tiles.push_back(i);
  }
  if (tiles.empty()) return {};
  const HeadScene& head = scene_->head;
  const RayFollower follower(head, sitting.view, camera, camera_from_head, effects);
  const TileRenderer renderer(head, follower, sitting.screen, camera, camera_from_head);
  const int width = input.width(), height = input.height();
  const int side = head.options.samples_per_side;
  const bool adaptive = head.options.adaptive && side > 1;

  std::vector<RenderCounts> counts_of(tiles.size());
  // One pixel more than is drawn, so that its border is met by what lies beside it.
  const PixelBox box = Clipped(Grown(mask.Bounds(), 1), width, height);
  std::vector<Glance> glances(adaptive ? std::size_t(box.x1 - box.x0) * std::size_t(box.y1 - box.y0)
                                       : 0);
  const auto glance = [&](int x, int y) -> Glance& {
    return glances[std::size_t(y - box.y0) * std::size_t(box.x1 - box.x0) +
                   std::size_t(x - box.x0)];
  };
  const auto put_shadow = [&](std::size_t i) {
    const std::size_t tile = tiles[i];
    const PixelBox area = mask.Area(tile, width, height);
    thread_local std::vector<CameraSample> samples;
    thread_local std::vector<PixelState> states(PixelFlags().size());  // says nothing of a shadow
    thread_local std::vector<Eigen::Vector3f> factor;
    thread_local std::vector<CameraSample::Kind> kind;
    PixelFlags wanted;
    for (int y = 0; y < kTileSide; ++y) {
      for (int x = 0; x < kTileSide; ++x) wanted[TileIndex(x, y)] = OnShadowGrid(x, y);
    }
    factor.assign(wanted.size(), Eigen::Vector3f::Ones());
    kind.assign(wanted.size(), CameraSample::Kind::kBackground);
    for (const bool grid : {true, false}) {
      if (!grid) FillShadowGrid(area, factor, kind, wanted);
      PlaceSamples(area, 1, &wanted, samples);
      renderer.Trace(tile, samples, states);
      for (const CameraSample& s : samples) {
        factor[s.pixel] = s.direct;
        kind[s.pixel] = s.kind;
      }
    }
    const std::size_t across = std::size_t(area.x1 - area.x0);
    Eigen::Matrix<float, 3, kTileSide> light;
    for (int y = area.y0; y < area.y1; ++y) {
      const std::size_t first = TileIndex(0, y - area.y0);
      bool changed = false;
      for (std::size_t x = 0; x < across; ++x) {
        const Eigen::Vector3f& f = factor[first + x];
        glance(area.x0 + int(x), y) = Glance::AtInput(kind[first + x], f);
        const bool darker = f.x() != 1 || f.y() != 1 || f.z() != 1;
        counts_of[i].shadowed_pixels += darker;
        changed = changed || darker;
        light.col(Eigen::Index(x)) = f.cwiseProduct(input.Pixel(area.x0 + int(x), y));
      }
      if (changed) canvas.PutRow(area.x0, y, light.data(), across);
    }
  };
  const auto render_tile = [&](std::size_t i, bool refine) {
    const std::size_t tile = tiles[i];
    const std::uint8_t content = mask.content[tile];
    if (content == kTileShadow && adaptive && head.baked_shadow) {
      if (!refine) put_shadow(i);
      return;
    }
    const PixelBox area = mask.Area(tile, width, height);
    PixelFlags wanted;
    if (refine) {
      if (content == kTileShadow) return;
      wanted = PixelsToRefine(area, box, glances);
      if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return;
    }
    // The face's own pixels need no second sample: equation (2) is taken once a pixel.
    const int here = content == kTileShadow || (adaptive && !refine) ? 1 : side;
    thread_local std::vector<CameraSample> samples;
    thread_local std::vector<PixelState> states;
    thread_local std::vector<PixelSum> sums;
    PlaceSamples(area, here, refine ? &wanted : nullptr, samples);
    states.resize(wanted.size());
    sums.resize(wanted.size());
    for (const CameraSample& s : samples) {
      states[s.pixel] = PixelState{};
      sums[s.pixel] = PixelSum{};
      const std::uint32_t x = std::uint32_t(s.x), y = std::uint32_t(s.y);
      states[s.pixel].seed = y * 7919u + x * 104729u;
      states[s.pixel].side = std::uint8_t(here);
    }
    PixelFlags edges{};
    const bool wait = adaptive && !refine && content != kTileShadow;
    renderer.Trace(tile, samples, states, wait ? &edges : nullptr);
    const float share = 1.0f / float(here * here);
    for (const CameraSample& s : samples) sums[s.pixel].Add(s, share);
    RenderCounts& count = counts_of[i];
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t pixel = TileIndex(x - area.x0, y - area.y0);
        if (refine ? !wanted[pixel] : edges[pixel]) continue;
        const PixelSum& sum = sums[pixel];
        if (!refine || glance(x, y).edge) {
          count.lens_pixels += sum.lens;
          count.frame_pixels += sum.frame;
          count.shadowed_pixels += sum.changed && !sum.lens && !sum.frame;
        }
        count.filled_samples += states[pixel].filled;
        canvas.PutFrameShare(x, y, sum.frame_share);
        // A refined pixel may have been changed by its first sample alone.
        if (!sum.changed && !refine) continue;
        const Eigen::Vector3f own = input.Pixel(x, y);
        canvas.Put(x, y, sum.changed ? sum.inserted + sum.direct.cwiseProduct(own) : own);
      }
    }
    if (adaptive && !refine) {
      for (const CameraSample& s : samples) {
        glance(int(s.x), int(s.y)) = Glance::At(s, edges[s.pixel]);
      }
    }
  };
  tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) { render_tile(i, false); });
  if (adaptive) {
    tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t i) { render_tile(i, true); });
  }
  RenderCounts sum;
  for (const RenderCounts& c : counts_of) {
    sum.lens_pixels += c.lens_pixels;
    sum.frame_pixels += c.frame_pixels;
    sum.shadowed_pixels += c.shadowed_pixels;
    sum.filled_samples += c.filled_samples;
  }
  return sum;
}

EffectPlan Compositor::Plan(const InputPicture& input, const Camera& camera,
                            const Eigen::Isometry3d& camera_from_head,
                            const EffectChoice& choice) const {
  const HeadScene& head = scene_->head;
  const Sitting sitting(head, input, {}, camera, camera_from_head);
  return PlanEffects(head, sitting.view, input, camera, camera_from_head, choice);
}

ImageRgbaF Compositor::HitMap(const Camera& camera,
                              const Eigen::Isometry3d& camera_from_head) const {
  return TraceHitMap(scene_->head, camera, camera_from_head);
}

double Compositor::MatchExposure(const InputPicture& input, const Camera& camera,
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
