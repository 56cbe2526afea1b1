// SPDX-License-Identifier: Apache-2.0
#include "render/effect_plan.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/linear_algebra.h"
#include "optics/media.h"
#include "optics/trace.h"
#include "render/color.h"
#include "render/colour_bands.h"
#include "render/head_scene.h"
#include "render/picture_view.h"

namespace lorgnette {
namespace {

constexpr int kGrid = 14;  // samples of a lens along each side of its box
// Samples stand for what lies between them.
constexpr double kShiftMargin = 1.15, kRadianceMargin = 1.25;
constexpr double kDarkMargin = 0.5;  // pixels between the samples may be darker than they
// Processor time of a lens sample with the effect, ns: rough figures, not measured by effect;
// they tell cheap from dear and decide nothing.
constexpr double kRay_ns = 260, kExactRay_ns = 2600;

// What the samples of one lens say.
struct LensSurvey {
  long visible = 0;      // samples that the camera sees
  double share_px = 0;   // pixels that a sample stands for
  double near_edge = 0;  // share of the samples beside the edge
  double refraction_px = 0, dispersion_px = 0;
  // How much wider or narrower the edge wall looks, pixels.
  double refraction_wall_px = 0, dispersion_wall_px = 0;
  Eigen::Vector3f front{0, 0, 0}, back{0, 0, 0}, rings{0, 0, 0}, bounces{0, 0, 0};
  Eigen::Vector3f coating{0, 0, 0};
  Eigen::Vector3f tint{0, 0, 0};
  Eigen::Vector3f darkest{1e9f, 1e9f, 1e9f}, brightest{0, 0, 0};
};

// Code values between a level and the same with a change either way, from the darkest level where
// it may happen: the display's curve is steepest there.
double CodeChange(const Eigen::Vector3f& change, const Eigen::Vector3f& darkest) {
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    const double level = kDarkMargin * std::max(0.0, double(darkest[c]));
    if (level >= 1) continue;
    const double above = std::min(1.0, level + std::abs(double(change[c])));
    most = std::max(most, 255 * (SrgbFromLinear(above) - SrgbFromLinear(std::min(level, 1.0))));
  }
  return most;
}

Eigen::Vector3f PictureAt(const InputPicture& input, const Eigen::Vector2d& p) {
  const int x = std::clamp(int(std::floor(p.x())), 0, input.width() - 1);
  const int y = std::clamp(int(std::floor(p.y())), 0, input.height() - 1);
  return input.Pixel(x, y);
}

class Surveyor {
 public:
  Surveyor(const HeadScene& head, const PictureView& view, const InputPicture& input,
           const Camera& camera, const Eigen::Isometry3d& camera_from_head)
      : head_(head),
        view_(view),
        input_(input),
        camera_(camera),
        camera_from_head_(camera_from_head),
        eye_(camera_from_head.inverse().translation()),
        world_from_head_(
            (head.options.world_from_camera * camera_from_head.rotation()).cast<float>()) {
    // Any light that a ray could find: the brightest of the environment and of the picture.
    brightest_ = float(head.options.environment_scale) * head.brightest.greatest();
    picture_brightest_ = input.Brightest();
    brightest_ = brightest_.cwiseMax(picture_brightest_);
  }

  LensSurvey Survey(std::size_t lens) const {
    LensSurvey survey;
    const LensSolid& solid = head_.lenses[lens];
    const Eigen::Vector2d low = solid.contour().low(), high = solid.contour().high();
    const Eigen::Vector2d cell = (high - low) / kGrid;
    for (int j = 0; j < kGrid; ++j) {
      for (int i = 0; i < kGrid; ++i) {
        // Nearly to the very edge: deviation is greatest there.
        const Eigen::Vector2d q =
            low + Eigen::Vector2d((i + 0.5) * cell.x() * kGrid / (kGrid - 0.2),
                                  (j + 0.5) * cell.y() * kGrid / (kGrid - 0.2));
        if (solid.contour().Contains(q.x(), q.y())) Add(lens, q, survey);
      }
    }
    const double scale_px = PixelsPerMm(solid);
    survey.share_px = cell.x() * cell.y() * scale_px * scale_px;
    return survey;
  }

  const Eigen::Vector3f& brightest() const { return brightest_; }

 private:
  double PixelsPerMm(const LensSolid& solid) const {
    const double z = (camera_from_head_ * solid.head_from_lens().translation()).z();
    return z > 1 ? camera_.fx / z : 0;
  }

  Eigen::Vector3f EnvironmentMost(const LensSolid& solid, const Eigen::Vector3d& d) const {
    const Eigen::Vector3f world =
        world_from_head_ * (solid.head_from_lens().linear() * d).cast<float>();
    return float(head_.options.environment_scale) * head_.brightest.Near(world);
  }

  // Where a ray of head space reads the picture: on the head, or on the plane behind it.
  std::optional<Eigen::Vector2d> Reads(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) const {
    const SceneHit hit = head_.scene.Intersect(RaySet::kHead, origin.cast<float>(),
                                               direction.cast<float>(), 0, 1e9f);
    Eigen::Vector3d point;
    if (hit.hit()) {
      point = camera_from_head_ * Eigen::Vector3d(origin + double(hit.distance) * direction);
    } else {
      const Eigen::Vector3d o = camera_from_head_ * origin;
      const Eigen::Vector3d d = camera_from_head_.linear() * direction;
      if (d.z() <= 1e-6) return std::nullopt;
      point = o + (double(view_.background_depth()) - o.z()) / d.z() * d;
    }
    if (point.z() <= 1) return std::nullopt;
    return camera_.Project(point);
  }

  void Add(std::size_t lens, const Eigen::Vector2d& q, LensSurvey& survey) const {
    const LensSolid& solid = head_.lenses[lens];
    const auto jet = solid.lens().front.Jet(q.x(), q.y());
    if (!jet) return;
    const Eigen::Vector3d target = solid.head_from_lens() * Eigen::Vector3d(q.x(), q.y(), jet->z);
    const Eigen::Vector3d in_camera = camera_from_head_ * target;
    if (in_camera.z() <= 1) return;
    const Eigen::Vector2d pixel = camera_.Project(in_camera);
    // A lens beside the picture has no pixels; its border counts as far as a sample reaches.
    const double reach = 3 + 0.1 * PixelsPerMm(solid) * (solid.high() - solid.low()).norm();
    if (pixel.x() < -reach || pixel.y() < -reach || pixel.x() > input_.width() + reach ||
        pixel.y() > input_.height() + reach) {
      return;
    }
    ++survey.visible;
    const Eigen::Vector3d d_head = (target - eye_).normalized();
    const Ray ray{solid.lens_from_head() * eye_, solid.lens_from_head().linear() * d_head};
    const Ray near{ray.origin + ((target - eye_).norm() - 40) * ray.direction, ray.direction};
    const double index = solid.lens().medium.index_d;
    const LensTrace trace = TraceThrough(solid.lens(), near, index);
    const LensLook& look = head_.looks[lens];
    const bool beside_edge = solid.contour().Clearance(q.x(), q.y()) < head_.rim_depth_mm[lens] + 4;
    survey.near_edge += beside_edge;
    if (ray.direction.z() <= 0 || trace.status != RayStatus::kOk) {
      // Seen from behind, or on a way of its own: no estimate, everything counts.
      survey.refraction_px = survey.dispersion_px = 1e3;
      survey.front = survey.back = survey.rings = survey.bounces = brightest_;
      survey.tint = survey.coating = brightest_;
      return;
    }
    const auto reads = [&](const LensTrace& t) {
      return Reads(solid.head_from_lens() * t.exit.origin,
                   solid.head_from_lens().linear() * t.exit.direction);
    };
    const auto at = reads(trace);
    const auto wall_px = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::abs(a.head<2>().norm() / a.z() - b.head<2>().norm() / b.z()) *
             (trace.second.point - trace.first.point).norm() * PixelsPerMm(solid);
    };
    if (beside_edge) {
      survey.refraction_wall_px =
          std::max(survey.refraction_wall_px, wall_px(near.direction, trace.inside_direction));
    }
    const Eigen::Vector2d place = at.value_or(Eigen::Vector2d(1e4, 1e4));
    survey.refraction_px = std::max(survey.refraction_px, (place - pixel).norm());
    for (const double nm : {kChannel_nm[0], kChannel_nm[2]}) {
      const LensTrace other = TraceThrough(solid.lens(), near, IndexAt(solid.lens().medium, nm));
      if (beside_edge && other.status == RayStatus::kOk) {
        survey.dispersion_wall_px = std::max(
            survey.dispersion_wall_px, wall_px(trace.inside_direction, other.inside_direction));
      }
      const auto p = other.status == RayStatus::kOk ? reads(other) : std::nullopt;
      if (!p || !at) continue;
      const double shift = (*p - place).norm();
      // Over an outline the two colours end at different depths: not a shift of the picture.
      if (shift < kOutlineJump_px) survey.dispersion_px = std::max(survey.dispersion_px, shift);
    }
    const Eigen::Vector3f seen = PictureAt(input_, place);
    survey.darkest = survey.darkest.cwiseMin(seen);
    survey.brightest = survey.brightest.cwiseMax(seen);

    const double cosine = std::min(1.0, std::abs(near.direction.dot(trace.first.normal)));
    const double cosine_out =
        std::min(1.0, std::abs(trace.exit.direction.dot(trace.second.normal)));
    const float bare_front = float(FresnelReflectance(cosine, 1 / index));
    const float bare_back = float(FresnelReflectance(cosine_out, 1 / index));
    const auto reflected = [](const SurfaceLook& s, float bare, double c, bool from_air) {
      if (s.bare()) return Eigen::Vector3f(Eigen::Vector3f::Constant(bare));
      return from_air ? s.FromAir(float(c)).reflected : s.FromGlass(float(c)).reflected;
    };
    const Eigen::Vector3f r1 = reflected(look.front, bare_front, cosine, true);
    const Eigen::Vector3f r2 = reflected(look.back, bare_back, cosine_out, false);
    const Eigen::Vector3f tint = look.tint.Between(trace.first.point, trace.second.point);

    const Eigen::Vector3f mirrored =
        EnvironmentMost(solid, Reflect(near.direction, trace.first.normal));
    survey.front = survey.front.cwiseMax(r1.cwiseProduct(mirrored.cwiseMax(seen)));
    // Back reflection: to the first surface and out.
    Eigen::Vector3f beyond = brightest_;
    const Ray turned{trace.second.point, Reflect(trace.inside_direction, trace.second.normal)};
    if (const auto out = solid.Leave(turned); out && out->face == SolidFace::kFront) {
      if (const auto d = Refract(turned.direction, out->normal, index)) {
        beyond = EnvironmentMost(solid, d->normalized());
      }
    }
    survey.back = survey.back.cwiseMax(r2.cwiseProduct(tint).cwiseProduct(beyond.cwiseMax(seen)));
    if (beside_edge) {
      survey.rings =
          survey.rings.cwiseMax(r2.cwiseProduct(tint).cwiseProduct(EdgeLight().cwiseMax(seen)));
    }
    // A second reflection, at the front, sends the light back toward the head, where it finds what
    // the picture shows; beside the edge it may find the light of the edge.
    survey.bounces =
        survey.bounces.cwiseMax(r2.cwiseProduct(reflected(look.front, bare_front, cosine, false))
                                    .cwiseProduct(beside_edge ? EdgeLight() : picture_brightest_));
    survey.coating = survey.coating.cwiseMax(
        (r1 - Eigen::Vector3f::Constant(bare_front))
            .cwiseAbs()
            .cwiseProduct(mirrored.cwiseMax(seen)) +
        (r2 - Eigen::Vector3f::Constant(bare_back)).cwiseAbs().cwiseProduct(beyond.cwiseMax(seen)));
    survey.tint = survey.tint.cwiseMax(
        (Eigen::Vector3f::Ones() - tint).cwiseProduct(seen.cwiseMax(mirrored)));
  }

  // The brightest that an internal reflection at the edge can show.
  Eigen::Vector3f EdgeLight() const { return brightest_; }

  static constexpr double kOutlineJump_px = 30;
  const HeadScene& head_;
  const PictureView& view_;
  const InputPicture& input_;
  const Camera& camera_;
  Eigen::Isometry3d camera_from_head_;
  Eigen::Vector3d eye_;
  Eigen::Matrix3f world_from_head_;
  Eigen::Vector3f brightest_{0, 0, 0}, picture_brightest_{0, 0, 0};
};

// The greatest relative change of the light that a lens passes on to skin behind it: what it keeps
// back, or what it gathers, (1 - d F)^-2 at d behind it.
float LensLightShare(const HeadScene& head) {
  constexpr double kFarthestSkin_m = 0.03;
  double most = 0;
  for (std::size_t i = 0; i < head.lenses.size(); ++i) {
    const Lens& lens = head.lenses[i].lens();
    const Eigen::Matrix2d bend = (lens.medium.index_d - 1) * 1000 *
                                 (lens.front.VertexCurvature() - lens.back.VertexCurvature());
    const double power =
        SymmetricEigenvalues(bend).cwiseAbs().maxCoeff() * (bend.trace() < 0 ? -1 : 1);
    const double gathered = std::pow(std::max(0.1, 1 - kFarthestSkin_m * power), -2.0);
    const double index = lens.medium.index_d;
    const auto passed = [&](const SurfaceLook& s) {
      return double((Eigen::Vector3f::Ones() - NormalReflectance(s, index)).minCoeff());
    };
    const double dimmed = passed(head.looks[i].front) * passed(head.looks[i].back) *
                          double(head.looks[i].tint.Between({0, 0, 0}, {0, 0, 2}).minCoeff());
    most = std::max({most, std::abs(gathered * dimmed - 1), 1 - dimmed});
  }
  return float(std::min(most, 1e3));
}

// Decides one region: the smallest estimates are left out first, until their sum fills the budget.
// Returns the shift that is left of the budget, pixels.
double Decide(std::vector<EffectDecision*> region, const EffectChoice& choice) {
  std::sort(region.begin(), region.end(), [&](const EffectDecision* a, const EffectDecision* b) {
    const auto size = [&](const EffectDecision* d) {
      return std::max(d->shift_px / choice.budget.shift_px,
                      d->code_values / choice.budget.code_values);
    };
    return size(a) < size(b);
  });
  double shift = 0, codes = 0;
  for (EffectDecision* d : region) {
    const EffectWish wish = choice.wish[std::size_t(d->effect)];
    if (wish != EffectWish::kEstimate) {
      d->on = wish == EffectWish::kOn;
      d->reason = d->on ? "asked for" : "not asked for";
      continue;
    }
    d->on = shift + d->shift_px > choice.budget.shift_px ||
            codes + d->code_values > choice.budget.code_values;
    if (!d->on) {
      shift += d->shift_px;
      codes += d->code_values;
    }
    const bool alone =
        d->shift_px > choice.budget.shift_px || d->code_values > choice.budget.code_values;
    d->reason = !d->on  ? "below the budget"
                : alone ? "above the budget"
                        : "above the budget together with what is left out";
  }
  return std::max(0.0, choice.budget.shift_px - shift);
}

}  // namespace

Result<EffectChoice> ParseEffects(std::string_view text) {
  EffectChoice choice;
  bool first = true;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    const auto fill = [&](EffectWish wish) { choice.wish.fill(wish); };
    if (first && word == "auto") {
      fill(EffectWish::kEstimate);
    } else if (first && word == "all") {
      fill(EffectWish::kOn);
    } else if (first && word == "none") {
      fill(EffectWish::kOff);
    } else if (first && word == "paper") {
      const EffectSet paper = EffectSet::Paper();
      for (int i = 0; i < kEffectCount; ++i) {
        choice.wish[std::size_t(i)] = paper[Effect(i)] ? EffectWish::kOn : EffectWish::kOff;
      }
    } else if (!first && word.size() > 1 && (word[0] == '+' || word[0] == '-')) {
      const auto effect = FindEffect(word.substr(1));
      if (!effect) {
        std::string names;
        for (int i = 0; i < kEffectCount; ++i) {
          names += (i > 0 ? ", " : "") + std::string(EffectName(Effect(i)));
        }
        return UsageError(
            fmt::format("--effects: got `{}`, want one of {}", word.substr(1), names));
      }
      choice.wish[std::size_t(*effect)] = word[0] == '+' ? EffectWish::kOn : EffectWish::kOff;
    } else {
      return UsageError(fmt::format(
          "--effects: got `{}`, want auto, paper, all or none, then +NAME or -NAME", word));
    }
    first = false;
    if (comma == std::string_view::npos) return choice;
    text.remove_prefix(comma + 1);
  }
}

EffectPlan PlanEffects(const HeadScene& head, const PictureView& view, const InputPicture& input,
                       const Camera& camera, const Eigen::Isometry3d& camera_from_head,
                       const EffectChoice& choice) {
  const Surveyor surveyor(head, view, input, camera, camera_from_head);
  EffectPlan plan;
  std::vector<LensSurvey> surveys(head.lenses.size());
  // What the face shows is read beside: the decisions below ask for it.
  tbb::parallel_invoke(
      [&] {
        tbb::parallel_for(std::size_t(0), surveys.size(),
                          [&](std::size_t lens) { surveys[lens] = surveyor.Survey(lens); });
      },
      [&] { view.face_brightest(); });
  const double samples =
      double(head.options.samples_per_side) * double(head.options.samples_per_side);
  for (std::size_t lens = 0; lens < head.lenses.size(); ++lens) {
    const LensSurvey& s = surveys[lens];
    const EffectRegion region = lens == 0 ? EffectRegion::kRightLens : EffectRegion::kLeftLens;
    const double lens_px = double(s.visible) * s.share_px;
    const double ray_ms = 1e-6 * samples * lens_px * kRay_ns;
    const double edge_ms = 1e-6 * samples * s.near_edge * s.share_px * kExactRay_ns;
    const auto add = [&](Effect effect, double shift_px, const Eigen::Vector3f& radiance,
                         double cost_ms) {
      EffectDecision d{effect, region, 0, 0, cost_ms, true, {}};
      if (s.visible > 0) {
        d.shift_px = kShiftMargin * shift_px;
        d.code_values = kRadianceMargin * CodeChange(radiance, s.darkest);
      }
      plan.decisions.push_back(d);
    };
    const Eigen::Vector3f none = Eigen::Vector3f::Zero();
    // A wall of light against the skin, by the share of a pixel that it gains or loses.
    const Eigen::Vector3f wall =
        s.brightest.cwiseMax(float(head.options.environment_scale) * head.environment_mean);
    add(Effect::kRefraction, s.refraction_px, float(s.refraction_wall_px) * wall, ray_ms);
    add(Effect::kDispersion, std::max(s.dispersion_px, s.dispersion_wall_px), none, 2 * ray_ms);
    add(Effect::kFrontReflection, 0, s.front, ray_ms);
    add(Effect::kBackReflection, 0, s.back, ray_ms);
    add(Effect::kRings, 0, s.rings, edge_ms);
    add(Effect::kBounces, 0, s.bounces,
        FollowsGhosts(head.looks[lens], head.lenses[lens].lens().medium.index_d) ? 10 * ray_ms
                                                                                 : edge_ms);
    const bool coated = !head.looks[lens].front.bare() || !head.looks[lens].back.bare();
    add(Effect::kCoating, 0, coated ? s.coating : none, 0.05 * ray_ms);
    add(Effect::kTint, 0, head.looks[lens].tint.clear() ? none : s.tint, 0.05 * ray_ms);
  }
  // Skin and frame. The darkest skin is not looked for: a shadow may take all there is.
  const Eigen::Vector3f& skin = view.face_brightest();
  const bool shadows = head.options.shadow != ShadowMode::kNone;
  const auto add = [&](Effect effect, double codes, double cost_ms) {
    plan.decisions.push_back({effect, EffectRegion::kRest, 0, codes, cost_ms, true, {}});
  };
  add(Effect::kShadow, shadows ? CodeChange(skin, Eigen::Vector3f::Zero()) : 0, 2);
  double lens_light = 0;
  if (head.options.shadow == ShadowMode::kGathered) {
    lens_light = CodeChange(LensLightShare(head) * skin, skin);
  }
  add(Effect::kLensLight, lens_light, 8000);
  Eigen::Vector3f gloss = Eigen::Vector3f::Zero();
  for (const FrameMaterial& material : head.frame.materials) {
    // Toward grazing everything mirrors.
    if (!material.specular.isZero()) gloss = Eigen::Vector3f::Ones();
  }
  add(Effect::kGloss,
      CodeChange(
          gloss.cwiseProduct(float(head.options.environment_scale) * head.brightest.greatest()),
          Eigen::Vector3f::Zero()),
      1);
  // Blur moves half of an edge's contrast to either side; a frame is dark on skin.
  const CameraLook& look = head.options.camera_look;
  const double blur_codes =
      AddedBlur(look) > kLeastBlur_px ? 0.5 * CodeChange(skin, Eigen::Vector3f::Zero()) : 0;
  add(Effect::kGrain, std::max(look.grain_codes, blur_codes), 3);

  for (const EffectRegion region :
       {EffectRegion::kRightLens, EffectRegion::kLeftLens, EffectRegion::kRest}) {
    std::vector<EffectDecision*> here;
    for (EffectDecision& d : plan.decisions) {
      if (d.region == region) here.push_back(&d);
    }
    const double left_px = Decide(here, choice);
    if (region != EffectRegion::kRest &&
        choice.wish[std::size_t(Effect::kDispersion)] == EffectWish::kEstimate) {
      plan.effects.dispersion_from_px[int(region)] = left_px;
    }
  }
  for (const EffectDecision& d : plan.decisions) {
    EffectSet& set = d.region == EffectRegion::kRightLens  ? plan.effects.lens[0]
                     : d.region == EffectRegion::kLeftLens ? plan.effects.lens[1]
                                                           : plan.effects.rest;
    set.Set(d.effect, d.on);
  }
  return plan;
}

std::string EffectPlanJson(const EffectPlan& plan) {
  constexpr const char* kRegions[] = {"right lens", "left lens", "rest"};
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto rounded = [](double v) { return std::round(v * 1e3) / 1e3; };
  for (const EffectDecision& d : plan.decisions) {
    list.push_back({{"effect", EffectName(d.effect)},
                    {"region", kRegions[int(d.region)]},
                    {"shift_px", rounded(d.shift_px)},
                    {"code_values", rounded(d.code_values)},
                    {"on", d.on},
                    {"reason", d.reason},
                    {"cost_ms", rounded(d.cost_ms)}});
  }
  return list.dump(2);
}

}  // namespace lorgnette
