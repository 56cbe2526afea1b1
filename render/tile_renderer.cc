// SPDX-License-Identifier: Apache-2.0
#include "render/tile_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "optics/lens_kernel.h"
#include "optics/trace.h"
#include "render/embree_scene.h"
#include "render/ray_bundle.h"

namespace lorgnette {
namespace {

// Whether a straight ray (lens frame) may touch the glass before `far`: it meets the box around it
// and does not stay beside the contour on its way through.
bool MayTouch(const LensSolid& solid, const Eigen::Vector3f& origin,
              const Eigen::Vector3f& direction, float far) {
  float t0 = 0, t1 = far;
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / direction[k];
    float a = (float(solid.low()[k]) - origin[k]) * inverse;
    float b = (float(solid.high()[k]) - origin[k]) * inverse;
    if (a > b) std::swap(a, b);
    t0 = std::max(t0, a);
    t1 = std::min(t1, b);
  }
  if (!(t0 <= t1)) return false;
  const Eigen::Vector3f middle = origin + 0.5f * (t0 + t1) * direction;
  const float half_way = 0.5f * (t1 - t0) * direction.head<2>().norm();
  return solid.contour().OutsideBy(double(middle.x()), double(middle.y())) <= double(half_way);
}

Eigen::Vector3f Mirrored(const Eigen::Vector3f& d, const Eigen::Vector3f& normal) {
  return d - 2 * d.dot(normal) * normal;
}

}  // namespace

// A ray through both surfaces away from the edge wall.
struct TileRenderer::Regular {
  std::uint32_t sample;
  std::uint32_t ray;  // index into Batch::in
  bool near_rim;      // its way inside may meet the frame
  // Shares of the pixel: mirrored by the first surface; gone through both; mirrored by the second.
  Eigen::Vector3f enter, through, back;
  Eigen::Vector3f entered;  // has passed the first surface
  Eigen::Vector3f first_point, first_normal, inside, second_point, second_normal, exit;
};

// Where a ray goes that the second surface sent back.
enum class BackWay : std::uint8_t {
  kOut,       // through the first surface
  kOutByRim,  // the same, unless the frame's reach into the glass lies between
  kWall,      // to the ground edge wall, unless the frame lies between
  kExact,     // anywhere
};

struct TileRenderer::Batch {
  RayBundle primary;
  std::vector<std::uint8_t>
      lens_of;  // one a sample: 0 none, 1 right, 2 left, 3 to be traced exactly
  // Lens kernel, lens frame.
  RayColumns in, exit, first, inside, second;
  std::vector<std::uint8_t> status;
  std::vector<float> enter, leave;
  std::vector<std::uint32_t> sample_of;
  std::vector<Regular> regular;
  // Internal reflection at the back.
  RayColumns back_in, back_hit, back_out;
  std::vector<std::uint8_t> back_status;
  std::vector<float> back_reflectance;
  std::vector<BackWay> back_way;
  // Head space.
  RayBundle rim, main, front_reflection, back_reflection;
  std::vector<std::uint32_t> main_of, front_of, back_of;
  std::vector<Eigen::Vector3f> back_weight;
  // Mirrored by the frame: where they end, of samples or of a bundle's rays.
  RayBundle gloss;
  std::vector<std::uint32_t> gloss_of;
  std::vector<std::optional<GlossEnd>> gloss_ends;
  // Dispersion.
  std::vector<std::uint32_t> parted;  // indices into main
  RayColumns colour_in, colour_exit;
  std::vector<std::uint8_t> colour_status;
  RayBundle colour;
};

TileRenderer::TileRenderer(const HeadScene& head, const RayFollower& follower, const Camera& camera,
                           const Eigen::Isometry3d& camera_from_head)
    : head_(head),
      follower_(follower),
      camera_(camera),
      head_from_camera_(camera_from_head.rotation().transpose().cast<float>()),
      eye_(camera_from_head.inverse().translation()) {}

void TileRenderer::TracePrimary(RaySet set, Batch& batch,
                                std::vector<CameraSample>& samples) const {
  const Eigen::Vector3f eye = eye_.cast<float>();
  const float inverse_fx = float(1 / camera_.fx), inverse_fy = float(1 / camera_.fy);
  batch.primary.Clear();
  for (const CameraSample& s : samples) {
    const Eigen::Vector3f d((s.x - float(camera_.cx)) * inverse_fx,
                            (s.y - float(camera_.cy)) * inverse_fy, 1);
    batch.primary.Add(eye, (head_from_camera_ * d).normalized());
  }
  batch.primary.Trace(head_.scene, set);
}

void TileRenderer::Direct(std::size_t i, const Batch& batch, std::vector<CameraSample>& samples,
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
void TileRenderer::TraceGloss(Batch& batch, const std::vector<CameraSample>& samples,
                              std::vector<PixelState>& pixels) const {
  constexpr float kFlat = 0.25f;  // turn of the normal over a pixel, radians
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

// Where the frame mirrors the rays of a bundle that meet it, into batch.gloss_ends.
void TileRenderer::TraceGloss(Batch& batch, const RayBundle& rays) const {
  batch.gloss.Clear();
  batch.gloss_of.clear();
  batch.gloss_ends.assign(rays.hits.size(), std::nullopt);
  for (std::size_t j = 0; j < rays.hits.size(); ++j) {
    const SceneHit& hit = rays.hits[j];
    if (hit.object != SceneObject::kFrame) continue;
    const Eigen::Vector3f& direction = rays.directions[j];
    const auto ray = follower_.GlossOf(hit, rays.origins[j] + hit.distance * direction, direction);
    if (!ray) continue;
    batch.gloss.Add(ray->origin, ray->direction);
    batch.gloss_of.push_back(std::uint32_t(j));
  }
  batch.gloss.Trace(head_.scene, RaySet::kAll);
  for (std::size_t k = 0; k < batch.gloss_of.size(); ++k) {
    batch.gloss_ends[batch.gloss_of[k]] = follower_.EndAt(batch.gloss.hits[k]);
  }
}

// The exact way: any entry, in double, one ray at a time.
void TileRenderer::TraceExactly(std::size_t i, const Batch& batch,
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
  if (!PartsColours(glass->lens)) {
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

bool TileRenderer::PartsColours(std::size_t lens) const {
  const EffectSet& on = follower_.effects(lens);
  return on[Effect::kDispersion] && on[Effect::kRefraction];
}

float TileRenderer::Parting(std::size_t lens, const Batch& batch, std::size_t main) const {
  // Colours part in proportion to the bend, as in a thin prism; more where rays graze.
  constexpr float kMargin = 1.5f;
  const Regular& r = batch.regular[batch.main_of[main]];
  const double index = follower_.index(lens);
  double spread = 0;
  for (std::size_t k = 1; k <= follower_.bands().size(); ++k) {
    spread = std::max(spread, std::abs(follower_.index(lens, k) - index) / (index - 1));
  }
  const float bend = (r.exit - batch.in.vector(r.ray)).norm();
  const Eigen::Vector3f& origin = batch.main.origins[main];
  const Eigen::Vector3f& direction = batch.main.directions[main];
  const PictureView& picture = follower_.picture();
  const float from = picture.Depth(origin);
  const float slope = picture.Depth(origin + direction) - from;
  float way = batch.main.hits[main].distance;
  if (!batch.main.hits[main].hit()) {
    if (slope <= 1e-6f) return kEndless;
    way = (picture.background_depth() - from) / slope;
  }
  const float depth = from + way * slope;
  if (depth <= 1) return kEndless;
  return kMargin * float(spread) * bend * (way + (r.second_point - r.first_point).norm()) *
         float(camera_.fx) / depth;
}

void TileRenderer::TraceColours(std::size_t lens, Batch& batch, std::vector<CameraSample>& samples,
                                std::vector<PixelState>& pixels) const {
  const LensSolid& solid = head_.lenses[lens];
  const Eigen::Isometry3f head_from_lens = solid.head_from_lens().cast<float>();
  const std::vector<ColourBand>& bands = follower_.bands();
  const float share = 3 / float(bands.size());
  const std::size_t n = batch.parted.size();
  batch.colour_in.Resize(n);
  batch.colour_exit.Resize(n);
  batch.colour_status.resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::uint32_t ray = batch.regular[batch.main_of[batch.parted[j]]].ray;
    batch.colour_in.Set(j, batch.in.point(ray), batch.in.vector(ray));
  }
  for (std::size_t k = 0; k < bands.size(); ++k) {
    TraceLensBatch(solid.lens(), follower_.index(lens, k + 1), batch.colour_in.const_view(), n,
                   {batch.colour_exit.view(), batch.colour_status.data()});
    batch.colour.Clear();
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t main = batch.parted[j];
      if (batch.colour_status[j] == std::uint8_t(RayStatus::kOk)) {
        batch.colour.Add(head_from_lens * batch.colour_exit.point(j),
                         head_from_lens.linear() * batch.colour_exit.vector(j));
      } else {
        batch.colour.Add(batch.main.origins[main], batch.main.directions[main]);
      }
    }
    batch.colour.Trace(head_.scene, RaySet::kAll);
    const int c = bands[k].channel;
    for (std::size_t j = 0; j < n; ++j) {
      const Regular& r = batch.regular[batch.main_of[batch.parted[j]]];
      CameraSample& sample = samples[r.sample];
      const Eigen::Vector3f colour =
          follower_.AtHit(batch.colour.hits[j], batch.colour.origins[j], batch.colour.directions[j],
                          /*transmitted=*/true, pixels[sample.pixel]);
      sample.inserted[c] += share * r.through[c] * colour[c];
    }
  }
}

// How the light of a ray through both surfaces is shared out. `reflectance` is that of bare glass.
void TileRenderer::Share(std::size_t lens, float enter, float leave,
                         const Eigen::Vector3f& direction, Regular& r) const {
  const EffectSet& on = follower_.effects(lens);
  const LensLook& look = follower_.look(lens);
  const auto plain = [](float reflectance) {
    return SurfaceLook::Power{Eigen::Vector3f::Constant(reflectance),
                              Eigen::Vector3f::Constant(1 - reflectance)};
  };
  SurfaceLook::Power first = look.front.bare()
                                 ? plain(enter)
                                 : look.front.FromAir(std::abs(direction.dot(r.first_normal)));
  SurfaceLook::Power second =
      look.back.bare() ? plain(leave) : look.back.FromGlass(std::abs(r.exit.dot(r.second_normal)));
  // What is not followed is not lost either.
  const auto forgo = [](SurfaceLook::Power& power) {
    power.passed += power.reflected;
    power.reflected.setZero();
  };
  if (!on[Effect::kFrontReflection]) forgo(first);
  if (!on[Effect::kBackReflection]) forgo(second);
  r.enter = first.reflected;
  r.entered = first.passed;
  const Eigen::Vector3f inside =
      look.tint.clear() ? first.passed
                        : first.passed.cwiseProduct(look.tint.Between(
                              r.first_point.cast<double>(), r.second_point.cast<double>()));
  r.through = inside.cwiseProduct(second.passed);
  r.back = inside.cwiseProduct(second.reflected);
}

void TileRenderer::TraceLens(std::size_t lens, Batch& batch, std::vector<CameraSample>& samples,
                             std::vector<PixelState>& pixels) const {
  const LensSolid& solid = head_.lenses[lens];
  // Without refraction rays pass as through air, and mirror as glass does that they enter so.
  const bool refracts = follower_.effects(lens)[Effect::kRefraction];
  const double index = follower_.index(lens), bend = refracts ? index : 1;
  const auto mirrored_share = [&](const RayColumns& rays, const RayColumns& normals,
                                  std::size_t k) {
    const double cosine = std::abs(double(rays.vector(k).dot(normals.vector(k))));
    return float(FresnelReflectance(std::min(cosine, 1.0), 1 / index));
  };
  const Eigen::Matrix3f lens_from_head = solid.lens_from_head().linear().cast<float>();
  const Eigen::Matrix3f head_from_lens = solid.head_from_lens().linear().cast<float>();
  const Eigen::Vector3f lens_in_head = solid.head_from_lens().translation().cast<float>();
  const auto to_head = [&](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return head_from_lens * p + lens_in_head;
  };

  // Rays start near the glass, so that single precision keeps its digits there.
  const Eigen::Vector3d eye_in_lens = solid.lens_from_head() * eye_;
  const float shift = float(
      std::max(0.0, eye_in_lens.norm() - std::max(solid.low().norm(), solid.high().norm()) - 10));
  const Eigen::Vector3f origin_in_lens = eye_in_lens.cast<float>();
  batch.sample_of.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f d = lens_from_head * batch.primary.directions[i];
    const SceneHit& hit = batch.primary.hits[i];
    if (MayTouch(solid, origin_in_lens, d, hit.hit() ? hit.distance : kEndless)) {
      batch.sample_of.push_back(std::uint32_t(i));
    }
  }
  const std::size_t n = batch.sample_of.size();
  if (n == 0) return;
  for (RayColumns* c : {&batch.in, &batch.exit, &batch.first, &batch.inside, &batch.second}) {
    c->Resize(n);
  }
  batch.status.resize(n);
  batch.enter.resize(n);
  batch.leave.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3f d = lens_from_head * batch.primary.directions[batch.sample_of[k]];
    const Eigen::Vector3d p = eye_in_lens + double(shift) * d.cast<double>();
    batch.in.Set(k, p.cast<float>(), d);
  }
  RayArrays<float> first = batch.first.view(), inside = batch.inside.view(),
                   second = batch.second.view();
  LensBatchOutput<float> out{batch.exit.view(), batch.status.data()};
  out.first = &first;
  out.inside = &inside;
  out.second = &second;
  out.first_reflectance = batch.enter.data();
  out.second_reflectance = batch.leave.data();
  TraceLensBatch(solid.lens(), bend, batch.in.const_view(), n, out);
  for (std::size_t k = 0; k < n && !refracts; ++k) {
    batch.enter[k] = mirrored_share(batch.in, batch.first, k);
    batch.leave[k] = mirrored_share(batch.in, batch.second, k);
  }

  // Sort out: straight through both surfaces, certainly beside the glass, or neither.
  const ContourIndex& contour = solid.contour();
  const double rim = head_.rim_depth_mm[lens], bevel = head_.options.bevel_mm;
  batch.regular.clear();
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t i = batch.sample_of[k];
    if (batch.lens_of[i] == 3) continue;
    const Eigen::Vector3f p1 = batch.first.point(k), p2 = batch.inside.point(k);
    const ContourIndex::Place at1 = contour.Locate(double(p1.x()), double(p1.y()));
    const ContourIndex::Place at2 = contour.Locate(double(p2.x()), double(p2.y()));
    const bool through =
        batch.status[k] == std::uint8_t(RayStatus::kOk) && at1.inside && at2.inside;
    const float entry = shift + (p1 - batch.in.point(k)).norm();
    const SceneHit& hit = batch.primary.hits[i];
    const bool forward = batch.in.columns[5][k] > 0;
    // Glass beside which the first surface is met, if any, begins behind it with the wall.
    const bool in_groove = !through && forward && batch.first.columns[5][k] > 0 && hit.hit() &&
                           hit.object == SceneObject::kFrame && at1.clearance < bevel &&
                           double(hit.distance) < double(entry) + bevel;
    if (in_groove) continue;
    if (!through || batch.lens_of[i] != 0 || !forward) {
      batch.lens_of[i] = 3;
      continue;
    }
    if (hit.hit() && hit.distance < entry) continue;
    batch.lens_of[i] = std::uint8_t(lens + 1);
    Regular r;
    r.sample = i;
    r.ray = std::uint32_t(k);
    r.near_rim = at1.clearance < rim || at2.clearance < rim;
    r.first_point = p1;
    r.first_normal = batch.first.vector(k);
    r.inside = batch.inside.vector(k);
    r.second_point = p2;
    r.second_normal = batch.second.vector(k);
    r.exit = batch.exit.vector(k);
    Share(lens, batch.enter[k], batch.leave[k], batch.in.vector(k), r);
    batch.regular.push_back(r);
  }

  // The frame may reach into the glass along the rim.
  batch.rim.Clear();
  for (const Regular& r : batch.regular) {
    if (!r.near_rim) continue;
    batch.rim.Add(to_head(r.first_point), head_from_lens * r.inside,
                  (r.second_point - r.first_point).norm());
  }
  batch.rim.Trace(head_.scene, RaySet::kFrame);

  const LensLook& look = follower_.look(lens);
  batch.main.Clear();
  batch.front_reflection.Clear();
  batch.back_reflection.Clear();
  batch.main_of.clear();
  batch.front_of.clear();
  batch.back_of.clear();
  std::size_t rim_next = 0;
  for (std::size_t k = 0; k < batch.regular.size(); ++k) {
    Regular& r = batch.regular[k];
    CameraSample& sample = samples[r.sample];
    sample.direct.setZero();
    const Eigen::Vector3f d = lens_from_head * batch.primary.directions[r.sample];
    if (r.enter.maxCoeff() > 0) {
      batch.front_of.push_back(std::uint32_t(k));
      batch.front_reflection.Add(to_head(r.first_point),
                                 head_from_lens * Mirrored(d, r.first_normal));
    }
    if (r.near_rim) {
      const std::size_t j = rim_next++;
      if (const SceneHit& hit = batch.rim.hits[j]; hit.hit()) {
        const Eigen::Vector3f& in_glass = batch.rim.directions[j];
        const Eigen::Vector3f point = batch.rim.origins[j] + hit.distance * in_glass;
        sample.kind = CameraSample::Kind::kFrame;
        sample.inserted +=
            r.entered.cwiseProduct(follower_.Frame(hit, point, in_glass, follower_.EndAt(hit)));
        continue;
      }
    }
    batch.main_of.push_back(std::uint32_t(k));
    batch.main.Add(to_head(r.second_point), head_from_lens * r.exit);
    if (r.back.maxCoeff() > 0) batch.back_of.push_back(std::uint32_t(k));
  }

  // Back reflection: from the second surface to the first, and out.
  const std::size_t m = batch.back_of.size();
  for (RayColumns* c : {&batch.back_in, &batch.back_hit, &batch.back_out}) c->Resize(m);
  batch.back_status.resize(m);
  batch.back_reflectance.resize(m);
  for (std::size_t j = 0; j < m; ++j) {
    const Regular& r = batch.regular[batch.back_of[j]];
    batch.back_in.Set(j, r.second_point, Mirrored(r.inside, r.second_normal));
  }
  RayArrays<float> back_out = batch.back_out.view();
  FaceBatchOutput<float> face{batch.back_hit.view(), batch.back_status.data()};
  face.refracted = &back_out;
  face.reflectance = batch.back_reflectance.data();
  if (m > 0) {
    TraceFaceBatch(solid.lens(), LensFace::kFront, bend, batch.back_in.const_view(), m, face);
  }
  for (std::size_t j = 0; j < m && !refracts; ++j) {
    batch.back_reflectance[j] = mirrored_share(batch.back_in, batch.back_hit, j);
  }
  // A ray that passes the contour before it meets the front has met the wall, unless the back
  // surface bends into its way. On its way there, or to the front near the rim, it may meet the
  // frame.
  const bool ground = head_.options.finish.edge == EdgeFinish::kGround &&
                      solid.back_bulges_inward() && look.tint.clear() &&
                      follower_.effects(lens)[Effect::kRings];
  batch.rim.Clear();
  batch.back_way.clear();
  for (std::size_t j = 0; j < m; ++j) {
    const Eigen::Vector3f p = batch.back_hit.point(j);
    const Eigen::Vector3f& from = batch.regular[batch.back_of[j]].second_point;
    const Eigen::Vector3f along = batch.back_in.vector(j);
    const ContourIndex::Place at = contour.Locate(double(p.x()), double(p.y()));
    const bool leaves = batch.back_status[j] == std::uint8_t(RayStatus::kOk);
    if (leaves && at.clearance >= rim) {
      batch.back_way.push_back(BackWay::kOut);
      continue;
    }
    if (leaves && at.inside) {
      batch.back_way.push_back(BackWay::kOutByRim);
      batch.rim.Add(to_head(from), head_from_lens * along, (p - from).norm());
      continue;
    }
    batch.back_way.push_back(BackWay::kExact);
    if (!ground || at.inside || batch.back_status[j] == std::uint8_t(RayStatus::kMissesSurface)) {
      continue;
    }
    const auto crossing =
        contour.FirstCrossing(from.head<2>().cast<double>(), along.head<2>().cast<double>(), 0,
                              double((p - from).norm()));
    if (!crossing) continue;
    batch.back_way.back() = BackWay::kWall;
    batch.rim.Add(to_head(from), head_from_lens * along, float(crossing->t));
  }
  batch.rim.Trace(head_.scene, RaySet::kFrame);
  const Eigen::Vector3f wall = follower_.GroundEdge();
  batch.back_weight.clear();
  std::size_t kept = 0;
  rim_next = 0;
  for (std::size_t j = 0; j < m; ++j) {
    const std::uint32_t k = batch.back_of[j];
    const Regular& r = batch.regular[k];
    Eigen::Vector3f weight = r.back;
    const Eigen::Vector3f p = batch.back_hit.point(j);
    CameraSample& sample = samples[r.sample];
    const BackWay way = batch.back_way[j];
    if (way == BackWay::kWall || way == BackWay::kOutByRim) {
      const std::size_t at = rim_next++;
      if (const SceneHit& hit = batch.rim.hits[at]; hit.hit()) {
        const Eigen::Vector3f& direction = batch.rim.directions[at];
        const Eigen::Vector3f point = batch.rim.origins[at] + hit.distance * direction;
        sample.inserted +=
            weight.cwiseProduct(follower_.Frame(hit, point, direction, follower_.EndAt(hit)));
        continue;
      }
    }
    if (way == BackWay::kWall) {
      sample.inserted += weight.cwiseProduct(wall);
    } else if (way == BackWay::kExact) {
      const double most = double(weight.maxCoeff());
      if (most < head_.options.least_weight || !follower_.effects(lens)[Effect::kRings]) continue;
      const Ray chain{r.second_point.cast<double>(),
                      batch.back_in.vector(j).cast<double>().normalized()};
      sample.inserted +=
          weight.cwiseProduct(follower_.Inside(lens, chain, most, 2, pixels[sample.pixel]));
    } else {
      if (!look.tint.clear()) {
        weight =
            weight.cwiseProduct(look.tint.Between(r.second_point.cast<double>(), p.cast<double>()));
      }
      if (look.front.bare()) {
        // What the front sends back once more ends near where the transmitted ray does.
        const Eigen::Vector3f again = batch.back_reflectance[j] * weight;
        batch.regular[k].through += again;
        weight -= again;
      }
      batch.back_of[kept++] = k;
      batch.back_weight.push_back(weight);
      batch.back_reflection.Add(to_head(p), head_from_lens * batch.back_out.vector(j));
    }
  }
  batch.back_of.resize(kept);

  batch.main.Trace(head_.scene, RaySet::kAll);
  batch.front_reflection.Trace(head_.scene, RaySet::kAll);
  batch.back_reflection.Trace(head_.scene, RaySet::kAll);
  const auto add = [&](std::uint32_t k, const RayBundle& bundle, std::size_t j,
                       const Eigen::Vector3f& weight, bool transmitted) {
    CameraSample& sample = samples[batch.regular[k].sample];
    sample.inserted += weight.cwiseProduct(
        follower_.AtHit(bundle.hits[j], bundle.origins[j], bundle.directions[j], transmitted,
                        pixels[sample.pixel], batch.gloss_ends[j]));
  };
  const bool other_lens_near = head_.lenses.size() > 1 && follower_.lenses_overlap();
  const bool colours = PartsColours(lens);
  batch.parted.clear();
  TraceGloss(batch, batch.main);
  for (std::size_t j = 0; j < batch.main_of.size(); ++j) {
    const std::uint32_t k = batch.main_of[j];
    const Regular& r = batch.regular[k];
    CameraSample& sample = samples[r.sample];
    const SceneHit& hit = batch.main.hits[j];
    pixels[sample.pixel].minification = follower_.minification(lens);
    sample.kind = hit.object == SceneObject::kFace ? CameraSample::Kind::kLensToHead
                  : hit.hit()                      ? CameraSample::Kind::kLensElsewhere
                                                   : CameraSample::Kind::kLensToBackground;
    if (other_lens_near) {
      const Ray leaving{batch.main.origins[j].cast<double>(),
                        batch.main.directions[j].cast<double>().normalized()};
      if (follower_.FirstGlass(leaving)) {
        sample.inserted += r.through.cwiseProduct(follower_.Outside(
            leaving, double(r.through.maxCoeff()), 1, true, pixels[sample.pixel]));
        continue;
      }
    }
    if (colours && double(Parting(lens, batch, j)) > follower_.dispersion_from_px(lens)) {
      batch.parted.push_back(std::uint32_t(j));
      continue;
    }
    add(k, batch.main, j, r.through, true);
  }
  if (!batch.parted.empty()) TraceColours(lens, batch, samples, pixels);
  TraceGloss(batch, batch.front_reflection);
  for (std::size_t j = 0; j < batch.front_of.size(); ++j) {
    add(batch.front_of[j], batch.front_reflection, j, batch.regular[batch.front_of[j]].enter,
        false);
  }
  TraceGloss(batch, batch.back_reflection);
  for (std::size_t j = 0; j < batch.back_of.size(); ++j) {
    add(batch.back_of[j], batch.back_reflection, j, batch.back_weight[j], true);
  }
}

void TileRenderer::Trace(std::vector<CameraSample>& samples, std::uint8_t content,
                         std::vector<PixelState>& pixels) const {
  thread_local Batch batch;
  // A straight ray meets the frame in its tiles only.
  const RaySet set = content & kTileFrame ? RaySet::kAll : RaySet::kHead;
  TracePrimary(set, batch, samples);
  batch.lens_of.assign(samples.size(), 0);
  const std::uint8_t lens_bits[2] = {kTileRightLens, kTileLeftLens};
  for (std::size_t lens = 0; lens < head_.lenses.size(); ++lens) {
    if (!(content & lens_bits[lens])) continue;
    const EffectSet& on = follower_.effects(lens);
    const bool ghosts = on[Effect::kBounces] && follower_.follows_ghosts(lens);
    if (!ghosts && (content & (kTileRightLens | kTileLeftLens)) == lens_bits[lens]) {
      TraceLens(lens, batch, samples, pixels);
    } else {
      // Both lenses in one tile, ghosts of mirrors: seldom, and not worth a batch.
      std::fill(batch.lens_of.begin(), batch.lens_of.end(), std::uint8_t(3));
    }
  }
  TraceGloss(batch, samples, pixels);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (batch.lens_of[i] == 3) {
      TraceExactly(i, batch, samples, pixels);
    } else if (batch.lens_of[i] == 0) {
      Direct(i, batch, samples, pixels);
    }
  }
}

}  // namespace lorgnette
