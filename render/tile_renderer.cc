// SPDX-License-Identifier: Apache-2.0
#include "render/tile_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "optics/trace.h"
#include "render/embree_scene.h"
#include "render/lens_pass.h"
#include "render/tile_batch.h"

namespace lorgnette {
namespace {

constexpr float kFlat = 0.25f;  // turn of the frame's normal over a pixel, radians

}  // namespace

TileRenderer::TileRenderer(const HeadScene& head, const RayFollower& follower,
                           const ScreenScene& screen, const Camera& camera,
                           const Eigen::Isometry3d& camera_from_head)
    : head_(head),
      follower_(follower),
      screen_(screen),
      camera_(camera),
      head_from_camera_(camera_from_head.rotation().transpose().cast<float>()),
      eye_(camera_from_head.inverse().translation()) {}

void TileRenderer::TracePrimary(std::size_t tile, const std::vector<CameraSample>& samples,
                                TileBatch& batch) const {
  const Eigen::Vector3f eye = eye_.cast<float>();
  const float inverse_fx = float(1 / camera_.fx), inverse_fy = float(1 / camera_.fy);
  if (screen_.complete) {
    batch.raster.Trace(head_.visible, screen_, tile, samples, batch.primary.hits);
  }
  batch.primary.Resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f d((samples[i].x - float(camera_.cx)) * inverse_fx,
                            (samples[i].y - float(camera_.cy)) * inverse_fy, 1);
    const float length = d.norm();
    batch.primary.Set(i, eye, head_from_camera_ * (d / length));
    if (screen_.complete) batch.primary.hits[i].distance *= length;
  }
  if (!screen_.complete) batch.primary.Trace(head_.scene, RaySet::kAll);
}

void TileRenderer::Direct(std::size_t i, const TileBatch& batch, std::vector<CameraSample>& samples,
                          std::vector<PixelState>& pixels) const {
  CameraSample& sample = samples[i];
  const Eigen::Vector3f& origin = batch.primary.origins[i];
  const Eigen::Vector3f& direction = batch.primary.directions[i];
  SceneHit hit = batch.primary.hits[i];
  if (!hit.hit()) return;
  Eigen::Vector3f point = origin + hit.distance * direction;
  Eigen::Vector3f passed = Eigen::Vector3f::Ones();
  if (hit.object == SceneObject::kFrame) {
    passed = follower_.FramePasses(hit, point, direction);
    if (passed.minCoeff() < 1) {
      sample.kind = CameraSample::Kind::kFrame;
      const std::optional<GlossEnd>& own = batch.gloss_ends[i];
      sample.inserted =
          follower_.Frame(hit, point, direction, own ? own : pixels[sample.pixel].frame_gloss);
    }
    if (passed.maxCoeff() > 0) {
      hit = head_.scene.Intersect(RaySet::kHead, origin, direction, 0, kEndless);
      point = origin + hit.distance * direction;
    }
  }
  sample.direct = passed;
  if (passed.maxCoeff() > 0 && hit.hit()) {
    if (sample.kind == CameraSample::Kind::kBackground) sample.kind = CameraSample::Kind::kHead;
    sample.direct = passed.cwiseProduct(follower_.FaceRatio(hit, point, pixels[sample.pixel]));
  }
}

// Where the frame, seen directly, mirrors: one ray a pixel where it is flat, one a sample else.
void TileRenderer::TraceGloss(TileBatch& batch, const std::vector<CameraSample>& samples,
                              std::vector<PixelState>& pixels) const {
  batch.gloss.Clear();
  batch.gloss_of.clear();
  batch.gloss_ends.assign(samples.size(), std::nullopt);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SceneHit& hit = batch.primary.hits[i];
    if (hit.object != SceneObject::kFrame || batch.lens_of[i] != 0) continue;
    const bool flat = follower_.TurnAt(hit) < kFlat;
    PixelState& pixel = pixels[samples[i].pixel];
    if (flat && pixel.frame_gloss) continue;
    const Eigen::Vector3f& direction = batch.primary.directions[i];
    const Eigen::Vector3f point = batch.primary.origins[i] + hit.distance * direction;
    const auto ray = follower_.GlossOf(hit, point, direction);
    if (!ray) continue;
    if (flat) pixel.frame_gloss = GlossEnd{};
    batch.gloss.Add(ray->origin, ray->direction);
    batch.gloss_of.push_back(std::uint32_t(i));
  }
  batch.gloss.Trace(head_.scene, RaySet::kAll);
  for (std::size_t j = 0; j < batch.gloss_of.size(); ++j) {
    const std::uint32_t i = batch.gloss_of[j];
    const GlossEnd end = follower_.EndAt(batch.gloss.hits[j]);
    batch.gloss_ends[i] = end;
    if (follower_.TurnAt(batch.primary.hits[i]) < kFlat) pixels[samples[i].pixel].frame_gloss = end;
  }
}

// The exact way: any entry, in double, one ray at a time.
void TileRenderer::TraceExactly(std::size_t i, const TileBatch& batch,
                                std::vector<CameraSample>& samples,
                                std::vector<PixelState>& pixels) const {
  CameraSample& sample = samples[i];
  const Eigen::Vector3d d =
      head_from_camera_.cast<double>() * camera_.Direction(double(sample.x), double(sample.y));
  const Ray ray{eye_, d.normalized()};
  const auto glass = follower_.FirstGlass(ray);
  const SceneHit& hit = batch.primary.hits[i];
  const double bevel = head_.options.bevel_mm;
  const bool in_groove = glass && hit.hit() && hit.object == SceneObject::kFrame &&
                         double(hit.distance) < glass->hit.distance + bevel &&
                         (glass->hit.face == SolidFace::kWall ||
                          head_.lenses[glass->lens].contour().Clearance(
                              glass->hit.point.x(), glass->hit.point.y()) < bevel);
  if (!glass || in_groove || (hit.hit() && double(hit.distance) < glass->hit.distance)) {
    Direct(i, batch, samples, pixels);
    return;
  }
  sample.kind = CameraSample::Kind::kLensElsewhere;
  sample.direct.setZero();
  PixelState& pixel = pixels[sample.pixel];
  const auto colour = [&] {
    return follower_.EnterGlass(glass->lens, glass->ray, glass->hit, 1, 0, pixel);
  };
  if (!follower_.parts_colours(glass->lens)) {
    sample.inserted = colour();
    return;
  }
  const std::vector<ColourBand>& bands = follower_.bands();
  for (std::size_t k = 0; k < bands.size(); ++k) {
    pixel.band = std::uint8_t(k + 1);
    sample.inserted[bands[k].channel] += colour()[bands[k].channel] * 3 / float(bands.size());
  }
  pixel.band = 0;
}

void TileRenderer::LeaveOutEdges(std::vector<CameraSample>& samples, TileBatch& batch,
                                 PixelFlags& edges) const {
  using Kind = CameraSample::Kind;
  // Of each pixel; those outside the picture are like the ones beside them.
  constexpr auto kOutside = Kind(0xff);
  std::array<Kind, std::tuple_size_v<PixelFlags>> kinds;
  kinds.fill(kOutside);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SceneHit& hit = batch.primary.hits[i];
    const std::uint8_t lens = batch.lens_of[i];
    kinds[samples[i].pixel] = lens == kExactly                    ? Kind::kLensElsewhere
                              : lens != 0                         ? Kind::kLensToHead  // or past it
                              : hit.object == SceneObject::kFrame ? Kind::kFrame
                              : hit.hit()                         ? Kind::kHead
                                                                  : Kind::kBackground;
    samples[i].turns = kinds[samples[i].pixel] == Kind::kFrame && follower_.TurnAt(hit) >= kFlat;
  }
  for (const LensRay& r : batch.regular) {
    if (r.way != LensWay::kThrough) kinds[samples[r.sample].pixel] = Kind::kLensElsewhere;
  }
  // Whether it holds of one of a pixel's neighbours in the tile.
  const auto beside = [&](std::size_t pixel, auto&& holds) {
    const int x = int(pixel) % kTileSide, y = int(pixel) / kTileSide;
    return (x > 0 && holds(TileIndex(x - 1, y))) ||
           (x + 1 < kTileSide && holds(TileIndex(x + 1, y))) ||
           (y > 0 && holds(TileIndex(x, y - 1))) ||
           (y + 1 < kTileSide && holds(TileIndex(x, y + 1)));
  };
  // What glass shows is what decides about the pixels around it.
  for (const CameraSample& s : samples) {
    const Kind kind = kinds[s.pixel];
    edges[s.pixel] =
        kind == Kind::kLensElsewhere ||
        (ClassOf(kind) != SampleClass::kGlass && beside(s.pixel, [&](std::size_t other) {
           return kinds[other] != kOutside && ClassOf(kinds[other]) != ClassOf(kind);
         }));
  }
  // Beside its edge, of which no more is known yet, a frame that turns has another brightness.
  const PixelFlags sharp = edges;
  for (const CameraSample& s : samples) {
    edges[s.pixel] = edges[s.pixel] || (s.turns && beside(s.pixel, [&](std::size_t other) {
                                          return sharp[other] && kinds[other] == Kind::kFrame;
                                        }));
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!edges[samples[i].pixel]) continue;
    samples[i].kind = kinds[samples[i].pixel];
    batch.lens_of[i] = kLeftOut;
  }
  std::erase_if(batch.regular,
                [&](const LensRay& r) { return batch.lens_of[r.sample] == kLeftOut; });
}

void TileRenderer::Trace(std::size_t tile, std::vector<CameraSample>& samples,
                         std::vector<PixelState>& pixels, PixelFlags* edges) const {
  thread_local TileBatch batch;
  const std::uint8_t content = screen_.mask.content[tile];
  TracePrimary(tile, samples, batch);
  batch.lens_of.assign(samples.size(), 0);
  batch.regular.clear();
  std::optional<LensPass> pass;
  bool whole = true;  // batches tell of every sample what it meets
  const std::uint8_t lens_bits[2] = {kTileRightLens, kTileLeftLens};
  for (std::size_t lens = 0; lens < head_.lenses.size(); ++lens) {
    if (!(content & lens_bits[lens])) continue;
    const EffectSet& on = follower_.effects(lens);
    const bool ghosts = on[Effect::kBounces] && follower_.follows_ghosts(lens);
    if (!ghosts && (content & (kTileRightLens | kTileLeftLens)) == lens_bits[lens]) {
      pass.emplace(head_, follower_, camera_, eye_, lens, batch, samples, pixels);
      pass->Enter();
    } else {
      // Both lenses in one tile, ghosts of mirrors: seldom, and not worth a batch.
      std::fill(batch.lens_of.begin(), batch.lens_of.end(), kExactly);
      whole = false;
    }
  }
  if (edges != nullptr) {
    edges->fill(false);
    if (whole) LeaveOutEdges(samples, batch, *edges);
  }
  if (pass) pass->Shade();
  TraceGloss(batch, samples, pixels);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (batch.lens_of[i] == kExactly) {
      TraceExactly(i, batch, samples, pixels);
    } else if (batch.lens_of[i] == 0) {
      Direct(i, batch, samples, pixels);
    }
  }
}

}  // namespace lorgnette
