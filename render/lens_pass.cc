// SPDX-License-Identifier: Apache-2.0
#include "render/lens_pass.h"

#include <algorithm>
#include <cmath>

#include "optics/lens_kernel.h"
#include "optics/trace.h"
#include "render/embree_scene.h"

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

LensPass::LensPass(const HeadScene& head, const RayFollower& follower, const Camera& camera,
                   const Eigen::Vector3d& eye, std::size_t lens, TileBatch& batch,
                   std::vector<CameraSample>& samples, std::vector<PixelState>& pixels)
    : head_(head),
      follower_(follower),
      camera_(camera),
      eye_(eye),
      lens_(lens),
      batch_(batch),
      samples_(samples),
      pixels_(pixels),
      solid_(head.lenses[lens]),
      look_(follower.look(lens)),
      refracts_(follower.effects(lens)[Effect::kRefraction]),
      index_(follower.index(lens)),
      bend_(refracts_ ? index_ : 1),
      rim_depth_(head.rim_depth_mm[lens]),
      lens_from_head_(solid_.lens_from_head().linear().cast<float>()),
      head_from_lens_(solid_.head_from_lens().linear().cast<float>()),
      lens_in_head_(solid_.head_from_lens().translation().cast<float>()) {}

void LensPass::Enter() {
  batch_.regular.clear();
  if (ThroughKernel()) SortOut();
}

void LensPass::Shade() {
  if (batch_.regular.empty()) return;
  Divide();
  SendBack();
  Gather();
}

float LensPass::MirroredShare(const RayColumns& rays, const RayColumns& normals,
                              std::size_t k) const {
  const double cosine = std::abs(double(rays.vector(k).dot(normals.vector(k))));
  return float(FresnelReflectance(std::min(cosine, 1.0), 1 / index_));
}

bool LensPass::ThroughKernel() {
  // Rays start near the glass, so that single precision keeps its digits there.
  const Eigen::Vector3d eye_in_lens = solid_.lens_from_head() * eye_;
  shift_ = float(
      std::max(0.0, eye_in_lens.norm() - std::max(solid_.low().norm(), solid_.high().norm()) - 10));
  const Eigen::Vector3f origin_in_lens = eye_in_lens.cast<float>();
  batch_.sample_of.clear();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Eigen::Vector3f d = lens_from_head_ * batch_.primary.directions[i];
    const SceneHit& hit = batch_.primary.hits[i];
    if (MayTouch(solid_, origin_in_lens, d, hit.hit() ? hit.distance : kEndless)) {
      batch_.sample_of.push_back(std::uint32_t(i));
    }
  }
  const std::size_t n = batch_.sample_of.size();
  if (n == 0) return false;
  for (RayColumns* c : {&batch_.in, &batch_.exit, &batch_.first, &batch_.inside, &batch_.second}) {
    c->Resize(n);
  }
  batch_.status.resize(n);
  batch_.enter.resize(n);
  batch_.leave.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3f d = lens_from_head_ * batch_.primary.directions[batch_.sample_of[k]];
    const Eigen::Vector3d p = eye_in_lens + double(shift_) * d.cast<double>();
    batch_.in.Set(k, p.cast<float>(), d);
  }
  RayArrays<float> first = batch_.first.view(), inside = batch_.inside.view(),
                   second = batch_.second.view();
  LensBatchOutput<float> out{batch_.exit.view(), batch_.status.data()};
  out.first = &first;
  out.inside = &inside;
  out.second = &second;
  out.first_reflectance = batch_.enter.data();
  out.second_reflectance = batch_.leave.data();
  TraceLensBatch(solid_.lens(), bend_, batch_.in.const_view(), n, out);
  for (std::size_t k = 0; k < n && !refracts_; ++k) {
    batch_.enter[k] = MirroredShare(batch_.in, batch_.first, k);
    batch_.leave[k] = MirroredShare(batch_.in, batch_.second, k);
  }
  return true;
}

void LensPass::SortOut() {
  const ContourIndex& contour = solid_.contour();
  const double bevel = head_.options.bevel_mm;
  for (std::size_t k = 0; k < batch_.sample_of.size(); ++k) {
    const std::uint32_t i = batch_.sample_of[k];
    if (batch_.lens_of[i] == kExactly) continue;
    const Eigen::Vector3f p1 = batch_.first.point(k), p2 = batch_.inside.point(k);
    const ContourIndex::Place at1 = contour.Locate(double(p1.x()), double(p1.y()));
    const ContourIndex::Place at2 = contour.Locate(double(p2.x()), double(p2.y()));
    const auto status = RayStatus(batch_.status[k]);
    const bool inside = at1.inside && at2.inside;
    const bool through = status == RayStatus::kOk && inside;
    const bool total = status == RayStatus::kTotalInternalReflection && inside;
    const float entry = shift_ + (p1 - batch_.in.point(k)).norm();
    const SceneHit& hit = batch_.primary.hits[i];
    const bool forward = batch_.in.columns[5][k] > 0;
    // Glass beside which the first surface is met, if any, begins behind it with the wall.
    const bool in_groove = !through && forward && batch_.first.columns[5][k] > 0 && hit.hit() &&
                           hit.object == SceneObject::kFrame && at1.clearance < bevel &&
                           double(hit.distance) < double(entry) + bevel;
    if (in_groove) continue;
    const std::optional<float> to_wall =
        through || total || !forward ? std::nullopt : WayToWall(k, at1, at2);
    if ((!through && !total && !to_wall) || batch_.lens_of[i] != 0 || !forward) {
      batch_.lens_of[i] = kExactly;
      continue;
    }
    if (hit.hit() && hit.distance < entry) continue;
    batch_.lens_of[i] = std::uint8_t(lens_ + 1);
    LensRay r;
    r.sample = i;
    r.ray = std::uint32_t(k);
    r.near_rim = to_wall || at1.clearance < rim_depth_ || at2.clearance < rim_depth_;
    r.way = to_wall ? LensWay::kToWall : total ? LensWay::kTotal : LensWay::kThrough;
    r.inside_mm = to_wall.value_or((p2 - p1).norm());
    r.first_point = p1;
    r.first_normal = batch_.first.vector(k);
    r.inside = batch_.inside.vector(k);
    r.second_point = to_wall ? Eigen::Vector3f(p1 + *to_wall * r.inside) : p2;
    r.second_normal = batch_.second.vector(k);
    r.exit = batch_.exit.vector(k);
    Share(batch_.enter[k], batch_.leave[k], batch_.in.vector(k), r);
    batch_.regular.push_back(r);
  }
}

std::optional<float> LensPass::WayToWall(std::size_t k, const ContourIndex::Place& at1,
                                         const ContourIndex::Place& at2) const {
  const std::uint8_t status = batch_.status[k];
  const bool known = status == std::uint8_t(RayStatus::kOk) ||
                     status == std::uint8_t(RayStatus::kTotalInternalReflection);
  if (!known || !at1.inside || at2.inside || head_.options.finish.edge != EdgeFinish::kGround) {
    return std::nullopt;
  }
  const Eigen::Vector3f from = batch_.first.point(k), along = batch_.inside.vector(k);
  const auto crossing =
      solid_.contour().FirstCrossing(from.head<2>().cast<double>(), along.head<2>().cast<double>(),
                                     0, double((batch_.inside.point(k) - from).norm()));
  if (!crossing) return std::nullopt;
  return float(crossing->t);
}

void LensPass::Share(float enter, float leave, const Eigen::Vector3f& direction, LensRay& r) const {
  const EffectSet& on = follower_.effects(lens_);
  const auto plain = [](float reflectance) {
    return SurfaceLook::Power{Eigen::Vector3f::Constant(reflectance),
                              Eigen::Vector3f::Constant(1 - reflectance)};
  };
  SurfaceLook::Power first = look_.front.bare()
                                 ? plain(enter)
                                 : look_.front.FromAir(std::abs(direction.dot(r.first_normal)));
  SurfaceLook::Power second = look_.back.bare()
                                  ? plain(leave)
                                  : look_.back.FromGlass(std::abs(r.exit.dot(r.second_normal)));
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
      look_.tint.clear() ? first.passed
                         : first.passed.cwiseProduct(look_.tint.Between(
                               r.first_point.cast<double>(), r.second_point.cast<double>()));
  r.through = r.way == LensWay::kToWall ? inside : inside.cwiseProduct(second.passed);
  r.back = r.way == LensWay::kTotal ? inside : inside.cwiseProduct(second.reflected);
}

void LensPass::Divide() {
  // The frame may reach into the glass along the rim.
  batch_.rim.Clear();
  for (const LensRay& r : batch_.regular) {
    if (!r.near_rim) continue;
    batch_.rim.Add(ToHead(r.first_point), head_from_lens_ * r.inside, r.inside_mm);
  }
  batch_.rim.Trace(head_.scene, RaySet::kFrame);

  batch_.main.Clear();
  batch_.front_reflection.Clear();
  batch_.back_reflection.Clear();
  batch_.main_of.clear();
  batch_.front_of.clear();
  batch_.back_of.clear();
  std::size_t rim_next = 0;
  const Eigen::Vector3f ground = follower_.GroundEdge();
  for (std::size_t k = 0; k < batch_.regular.size(); ++k) {
    LensRay& r = batch_.regular[k];
    CameraSample& sample = samples_[r.sample];
    sample.direct.setZero();
    const Eigen::Vector3f d = lens_from_head_ * batch_.primary.directions[r.sample];
    if (r.enter.maxCoeff() > 0) {
      batch_.front_of.push_back(std::uint32_t(k));
      batch_.front_reflection.Add(ToHead(r.first_point),
                                  head_from_lens_ * Mirrored(d, r.first_normal));
    }
    if (r.near_rim) {
      const std::size_t j = rim_next++;
      if (const SceneHit& hit = batch_.rim.hits[j]; hit.hit()) {
        const Eigen::Vector3f& in_glass = batch_.rim.directions[j];
        const Eigen::Vector3f point = batch_.rim.origins[j] + hit.distance * in_glass;
        sample.kind = CameraSample::Kind::kFrame;
        sample.inserted +=
            r.entered.cwiseProduct(follower_.Frame(hit, point, in_glass, follower_.EndAt(hit)));
        continue;
      }
    }
    if (r.way == LensWay::kTotal) {
      sample.kind = CameraSample::Kind::kLensElsewhere;
      batch_.back_of.push_back(std::uint32_t(k));
      continue;
    }
    if (r.way == LensWay::kToWall) {
      sample.kind = CameraSample::Kind::kLensElsewhere;
      sample.inserted += r.through.cwiseProduct(ground);
      continue;
    }
    batch_.main_of.push_back(std::uint32_t(k));
    batch_.main.Add(ToHead(r.second_point), head_from_lens_ * r.exit);
    if (r.back.maxCoeff() > 0) batch_.back_of.push_back(std::uint32_t(k));
  }
}

void LensPass::SendBack() {
  // Back reflection: from the second surface to the first, and out.
  const std::size_t m = batch_.back_of.size();
  for (RayColumns* c : {&batch_.back_in, &batch_.back_hit, &batch_.back_out}) c->Resize(m);
  batch_.back_status.resize(m);
  batch_.back_reflectance.resize(m);
  for (std::size_t j = 0; j < m; ++j) {
    const LensRay& r = batch_.regular[batch_.back_of[j]];
    batch_.back_in.Set(j, r.second_point, Mirrored(r.inside, r.second_normal));
  }
  RayArrays<float> back_out = batch_.back_out.view();
  FaceBatchOutput<float> face{batch_.back_hit.view(), batch_.back_status.data()};
  face.refracted = &back_out;
  face.reflectance = batch_.back_reflectance.data();
  if (m > 0) {
    TraceFaceBatch(solid_.lens(), LensFace::kFront, bend_, batch_.back_in.const_view(), m, face);
  }
  for (std::size_t j = 0; j < m && !refracts_; ++j) {
    batch_.back_reflectance[j] = MirroredShare(batch_.back_in, batch_.back_hit, j);
  }
  // A ray that passes the contour before it meets the front has met the wall, unless the back
  // surface bends into its way. On its way there, or to the front near the rim, it may meet the
  // frame.
  const bool ground = head_.options.finish.edge == EdgeFinish::kGround &&
                      solid_.back_bulges_inward() && look_.tint.clear();
  // Total reflection is no effect of its own: there is nothing else that the ray could do.
  const auto shows_edge = [&](const LensRay& r) {
    return follower_.effects(lens_)[Effect::kRings] || r.way == LensWay::kTotal;
  };
  batch_.rim.Clear();
  batch_.back_way.clear();
  for (std::size_t j = 0; j < m; ++j) {
    const Eigen::Vector3f p = batch_.back_hit.point(j);
    const Eigen::Vector3f& from = batch_.regular[batch_.back_of[j]].second_point;
    const Eigen::Vector3f along = batch_.back_in.vector(j);
    const ContourIndex::Place at = solid_.contour().Locate(double(p.x()), double(p.y()));
    const bool leaves = batch_.back_status[j] == std::uint8_t(RayStatus::kOk);
    if (leaves && at.clearance >= rim_depth_) {
      batch_.back_way.push_back(BackWay::kOut);
      continue;
    }
    if (leaves && at.inside) {
      batch_.back_way.push_back(BackWay::kOutByRim);
      batch_.rim.Add(ToHead(from), head_from_lens_ * along, (p - from).norm());
      continue;
    }
    batch_.back_way.push_back(BackWay::kExact);
    if (!ground || !shows_edge(batch_.regular[batch_.back_of[j]]) || at.inside ||
        batch_.back_status[j] == std::uint8_t(RayStatus::kMissesSurface)) {
      continue;
    }
    const auto crossing = solid_.contour().FirstCrossing(from.head<2>().cast<double>(),
                                                         along.head<2>().cast<double>(), 0,
                                                         double((p - from).norm()));
    if (!crossing) continue;
    batch_.back_way.back() = BackWay::kWall;
    batch_.rim.Add(ToHead(from), head_from_lens_ * along, float(crossing->t));
  }
  batch_.rim.Trace(head_.scene, RaySet::kFrame);
  const Eigen::Vector3f wall = follower_.GroundEdge();
  batch_.back_weight.clear();
  std::size_t kept = 0, rim_next = 0;
  for (std::size_t j = 0; j < m; ++j) {
    const std::uint32_t k = batch_.back_of[j];
    const LensRay& r = batch_.regular[k];
    Eigen::Vector3f weight = r.back;
    const Eigen::Vector3f p = batch_.back_hit.point(j);
    CameraSample& sample = samples_[r.sample];
    const BackWay way = batch_.back_way[j];
    if (way == BackWay::kWall || way == BackWay::kOutByRim) {
      const std::size_t at = rim_next++;
      if (const SceneHit& hit = batch_.rim.hits[at]; hit.hit()) {
        const Eigen::Vector3f& direction = batch_.rim.directions[at];
        const Eigen::Vector3f point = batch_.rim.origins[at] + hit.distance * direction;
        sample.inserted +=
            weight.cwiseProduct(follower_.Frame(hit, point, direction, follower_.EndAt(hit)));
        continue;
      }
    }
    if (way == BackWay::kWall) {
      sample.inserted += weight.cwiseProduct(wall);
    } else if (way == BackWay::kExact) {
      const double most = double(weight.maxCoeff());
      if (most < head_.options.least_weight || !shows_edge(r)) continue;
      const Ray chain{r.second_point.cast<double>(),
                      batch_.back_in.vector(j).cast<double>().normalized()};
      sample.inserted +=
          weight.cwiseProduct(follower_.Inside(lens_, chain, most, 2, pixels_[sample.pixel]));
    } else {
      if (!look_.tint.clear()) {
        weight = weight.cwiseProduct(
            look_.tint.Between(r.second_point.cast<double>(), p.cast<double>()));
      }
      if (look_.front.bare() && r.way != LensWay::kTotal) {
        // What the front sends back once more ends near where the transmitted ray does.
        const Eigen::Vector3f again = batch_.back_reflectance[j] * weight;
        batch_.regular[k].through += again;
        weight -= again;
      }
      batch_.back_of[kept++] = k;
      batch_.back_weight.push_back(weight);
      batch_.back_reflection.Add(ToHead(p), head_from_lens_ * batch_.back_out.vector(j));
    }
  }
  batch_.back_of.resize(kept);
}

void LensPass::Gather() {
  batch_.main.Trace(head_.scene, RaySet::kAll);
  batch_.front_reflection.Trace(head_.scene, RaySet::kAll);
  batch_.back_reflection.Trace(head_.scene, RaySet::kAll);
  const auto add = [&](std::uint32_t k, const RayBundle& bundle, std::size_t j,
                       const Eigen::Vector3f& weight, bool transmitted) {
    CameraSample& sample = samples_[batch_.regular[k].sample];
    sample.inserted += weight.cwiseProduct(
        follower_.AtHit(bundle.hits[j], bundle.origins[j], bundle.directions[j], transmitted,
                        pixels_[sample.pixel], batch_.gloss_ends[j]));
  };
  const bool other_lens_near = head_.lenses.size() > 1 && follower_.lenses_overlap();
  const bool colours = follower_.parts_colours(lens_);
  batch_.parted.clear();
  TraceGloss(batch_.main);
  for (std::size_t j = 0; j < batch_.main_of.size(); ++j) {
    const std::uint32_t k = batch_.main_of[j];
    const LensRay& r = batch_.regular[k];
    CameraSample& sample = samples_[r.sample];
    const SceneHit& hit = batch_.main.hits[j];
    pixels_[sample.pixel].minification = follower_.minification(lens_);
    sample.kind = hit.object == SceneObject::kFace ? CameraSample::Kind::kLensToHead
                  : hit.hit()                      ? CameraSample::Kind::kLensElsewhere
                                                   : CameraSample::Kind::kLensToBackground;
    if (other_lens_near) {
      const Ray leaving{batch_.main.origins[j].cast<double>(),
                        batch_.main.directions[j].cast<double>().normalized()};
      if (follower_.FirstGlass(leaving)) {
        sample.inserted += r.through.cwiseProduct(follower_.Outside(
            leaving, double(r.through.maxCoeff()), 1, true, pixels_[sample.pixel]));
        continue;
      }
    }
    if (colours && double(Parting(j)) > follower_.dispersion_from_px(lens_)) {
      batch_.parted.push_back(std::uint32_t(j));
      continue;
    }
    add(k, batch_.main, j, r.through, true);
  }
  if (!batch_.parted.empty()) TraceColours();
  TraceGloss(batch_.front_reflection);
  for (std::size_t j = 0; j < batch_.front_of.size(); ++j) {
    add(batch_.front_of[j], batch_.front_reflection, j, batch_.regular[batch_.front_of[j]].enter,
        false);
  }
  TraceGloss(batch_.back_reflection);
  for (std::size_t j = 0; j < batch_.back_of.size(); ++j) {
    add(batch_.back_of[j], batch_.back_reflection, j, batch_.back_weight[j], true);
  }
}

void LensPass::TraceGloss(const RayBundle& rays) {
  batch_.gloss.Clear();
  batch_.gloss_of.clear();
  batch_.gloss_ends.assign(rays.hits.size(), std::nullopt);
  for (std::size_t j = 0; j < rays.hits.size(); ++j) {
    const SceneHit& hit = rays.hits[j];
    if (hit.object != SceneObject::kFrame) continue;
    const Eigen::Vector3f& direction = rays.directions[j];
    const auto ray = follower_.GlossOf(hit, rays.origins[j] + hit.distance * direction, direction);
    if (!ray) continue;
    batch_.gloss.Add(ray->origin, ray->direction);
    batch_.gloss_of.push_back(std::uint32_t(j));
  }
  batch_.gloss.Trace(head_.scene, RaySet::kAll);
  for (std::size_t k = 0; k < batch_.gloss_of.size(); ++k) {
    batch_.gloss_ends[batch_.gloss_of[k]] = follower_.EndAt(batch_.gloss.hits[k]);
  }
}

float LensPass::Parting(std::size_t main) const {
  // Colours part in proportion to the bend, as in a thin prism; more where rays graze.
  constexpr float kMargin = 1.5f;
  const LensRay& r = batch_.regular[batch_.main_of[main]];
  const double index = follower_.index(lens_);
  double spread = 0;
  for (std::size_t k = 1; k <= follower_.bands().size(); ++k) {
    spread = std::max(spread, std::abs(follower_.index(lens_, k) - index) / (index - 1));
  }
  const float bend = (r.exit - batch_.in.vector(r.ray)).norm();
  const Eigen::Vector3f& origin = batch_.main.origins[main];
  const Eigen::Vector3f& direction = batch_.main.directions[main];
  const PictureView& picture = follower_.picture();
  const float from = picture.Depth(origin);
  const float slope = picture.Depth(origin + direction) - from;
  float way = batch_.main.hits[main].distance;
  if (!batch_.main.hits[main].hit()) {
    if (slope <= 1e-6f) return kEndless;
    way = (picture.background_depth() - from) / slope;
  }
  const float depth = from + way * slope;
  if (depth <= 1) return kEndless;
  return kMargin * float(spread) * bend * (way + (r.second_point - r.first_point).norm()) *
         float(camera_.fx) / depth;
}

void LensPass::TraceColours() {
  const std::vector<ColourBand>& bands = follower_.bands();
  const float share = 3 / float(bands.size());
  const std::size_t n = batch_.parted.size();
  batch_.colour_in.Resize(n);
  batch_.colour_exit.Resize(n);
  batch_.colour_status.resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::uint32_t ray = batch_.regular[batch_.main_of[batch_.parted[j]]].ray;
    batch_.colour_in.Set(j, batch_.in.point(ray), batch_.in.vector(ray));
  }
  for (std::size_t k = 0; k < bands.size(); ++k) {
    TraceLensBatch(solid_.lens(), follower_.index(lens_, k + 1), batch_.colour_in.const_view(), n,
                   {batch_.colour_exit.view(), batch_.colour_status.data()});
    batch_.colour.Clear();
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t main = batch_.parted[j];
      if (batch_.colour_status[j] == std::uint8_t(RayStatus::kOk)) {
        batch_.colour.Add(ToHead(batch_.colour_exit.point(j)),
                          head_from_lens_ * batch_.colour_exit.vector(j));
      } else {
        batch_.colour.Add(batch_.main.origins[main], batch_.main.directions[main]);
      }
    }
    batch_.colour.Trace(head_.scene, RaySet::kAll);
    const int c = bands[k].channel;
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t main = batch_.parted[j];
      const LensRay& r = batch_.regular[batch_.main_of[main]];
      CameraSample& sample = samples_[r.sample];
      const Eigen::Vector3f colour = follower_.AtHit(
          batch_.colour.hits[j], batch_.colour.origins[j], batch_.colour.directions[j],
          /*transmitted=*/true, pixels_[sample.pixel], batch_.gloss_ends[main]);
      sample.inserted[c] += share * r.through[c] * colour[c];
    }
  }
}

}  // namespace lorgnette
