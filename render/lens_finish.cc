// SPDX-License-Identifier: Apache-2.0
#include "render/lens_finish.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "optics/trace.h"

namespace lorgnette {
namespace {

constexpr int kAngles = 128;     // of a surface's table, even in the cosine
constexpr int kStrengths = 160;  // of a tint's table
constexpr double kLongestPath_mm = 40;

Eigen::Vector3f Rgb(const Spectrum& spectrum) {
  return LinearRgbUnderD65(spectrum).cwiseMax(0.0).cwiseMin(1.0).cast<float>();
}

// Silver: a thin film of chromium. The others: high and low quarter waves in turn (2.35 and 1.46)
// about the colour's wavelength.
FilmStack MirrorOn(MirrorCoat coat, double index) {
  FilmStack stack{1, {}, index};
  if (coat == MirrorCoat::kSilver) {
    stack.layers.push_back({3.1, 7, 3.3});
    return stack;
  }
  const double design_nm = coat == MirrorCoat::kBlue    ? 450
                           : coat == MirrorCoat::kGreen ? 530
                           : coat == MirrorCoat::kGold  ? 600
                                                        : 660;
  for (int i = 0; i < 5; ++i) {
    const double n = i % 2 == 0 ? 2.35 : 1.46;
    stack.layers.push_back({n, QuarterWave_nm(n, design_nm), 0});
  }
  return stack;
}

struct NamedColour {
  const char* name;
  std::vector<std::pair<double, double>> absorbance;  // relative
};
const std::vector<NamedColour>& TintColours() {
  static const std::vector<NamedColour> colours = {
      {"grey", {{550, 1.0}}},
      {"brown", {{420, 1.9}, {480, 1.45}, {550, 1.05}, {620, 0.75}, {700, 0.5}}},
      {"green", {{420, 1.6}, {480, 1.2}, {540, 0.85}, {600, 1.1}, {660, 1.3}, {700, 1.1}}},
      {"blue", {{420, 0.45}, {480, 0.6}, {550, 1.05}, {620, 1.35}, {700, 1.2}}},
      {"rose", {{420, 0.8}, {480, 1.2}, {530, 1.5}, {580, 1.0}, {640, 0.45}, {700, 0.3}}},
      {"yellow", {{420, 6.0}, {470, 4.0}, {500, 1.5}, {540, 0.7}, {620, 0.5}}}};
  return colours;
}

// Scales relative absorbances until the glass passes `luminous` of daylight.
Tint Scaled(Tint tint, double luminous, double path_mm) {
  const Tint relative = tint;
  double low = 0, high = 20;
  for (int i = 0; i < 60; ++i) {
    const double scale = 0.5 * (low + high);
    for (std::size_t k = 0; k < tint.absorbance.size(); ++k) {
      tint.absorbance[k].second = scale * relative.absorbance[k].second;
    }
    const double passed =
        LuminousFraction(Sampled([&](double nm) { return tint.Transmittance(nm, path_mm); }));
    (passed > luminous ? low : high) = scale;
  }
  return tint;
}

}  // namespace

Status SetCoating(std::string_view name, LensFinish& finish) {
  const struct {
    std::string_view name;
    CoatKind coat;
    MirrorCoat mirror;
  } known[] = {{"none", CoatKind::kNone, MirrorCoat::kNone},
               {"single", CoatKind::kSingle, MirrorCoat::kNone},
               {"v", CoatKind::kVCoat, MirrorCoat::kNone},
               {"ar", CoatKind::kBroadband, MirrorCoat::kNone},
               {"mirror", CoatKind::kBroadband, MirrorCoat::kSilver},
               {"mirror-blue", CoatKind::kBroadband, MirrorCoat::kBlue},
               {"mirror-green", CoatKind::kBroadband, MirrorCoat::kGreen},
               {"mirror-gold", CoatKind::kBroadband, MirrorCoat::kGold},
               {"mirror-red", CoatKind::kBroadband, MirrorCoat::kRed}};
  const auto find = [&](std::string_view wanted) {
    return std::find_if(std::begin(known), std::end(known),
                        [&](const auto& entry) { return entry.name == wanted; });
  };
  const std::size_t slash = name.find('/');
  const auto front = find(name.substr(0, slash));
  const auto back = slash == std::string_view::npos ? front : find(name.substr(slash + 1));
  if (front == std::end(known) || back == std::end(known)) {
    return UsageError(
        fmt::format("--coating: got `{}`, want none, single, v, ar, mirror, mirror-blue, "
                    "mirror-green, mirror-gold or mirror-red, or FRONT/BACK",
                    name));
  }
  if (slash != std::string_view::npos && back->mirror != MirrorCoat::kNone) {
    return UsageError(
        fmt::format("--coating: got `{}`, want none, single, v or ar on the back", name));
  }
  finish.front_coat = front->coat;
  finish.back_coat = back->coat;
  finish.mirror = front->mirror;
  return {};
}

Status SetTint(std::string_view text, LensFinish& finish) {
  if (text == "none") {
    finish.tint.reset();
    return {};
  }
  const auto wrong = [&] {
    return UsageError(
        fmt::format("--tint: got `{}`, want none or COLOUR:PERCENT[:dip|solid|gradient] with grey, "
                    "brown, green, blue, rose or yellow and 1..100",
                    text));
  };
  const std::size_t first = text.find(':');
  if (first == std::string_view::npos) return wrong();
  const std::string_view colour = text.substr(0, first);
  std::string_view rest = text.substr(first + 1);
  std::string_view kind = "dip";
  if (const std::size_t second = rest.find(':'); second != std::string_view::npos) {
    kind = rest.substr(second + 1);
    rest = rest.substr(0, second);
  }
  double percent = 0;
  const auto parsed = std::from_chars(rest.data(), rest.data() + rest.size(), percent);
  if (parsed.ec != std::errc() || parsed.ptr != rest.data() + rest.size()) return wrong();
  if (!(percent >= 1 && percent <= 100)) return wrong();
  if (kind != "dip" && kind != "solid" && kind != "gradient") return wrong();
  for (const NamedColour& known : TintColours()) {
    if (known.name != colour) continue;
    TintOrder order;
    order.tint.kind = kind == "solid" ? TintKind::kSolid : TintKind::kDip;
    order.tint.absorbance = known.absorbance;
    order.gradient = kind == "gradient";
    order.luminous = percent / 100;
    order.tint = Scaled(order.tint, order.luminous, order.reference_mm);
    finish.tint = order;
    return {};
  }
  return wrong();
}

Status SetEdge(std::string_view name, LensFinish& finish) {
  if (name != "ground" && name != "polished") {
    return UsageError(fmt::format("--edge: got `{}`, want ground or polished", name));
  }
  finish.edge = name == "ground" ? EdgeFinish::kGround : EdgeFinish::kPolished;
  return {};
}

SurfaceLook SurfaceLook::Of(const FilmStack& coat) {
  SurfaceLook look;
  if (coat.layers.empty()) return look;
  const FilmStack reversed = Reversed(coat);
  for (int i = 0; i <= kAngles; ++i) {
    const double cosine = double(i) / kAngles;
    const double sine = std::sqrt(1 - cosine * cosine) / coat.index_after;
    const double inside = std::sqrt(1 - sine * sine);
    const auto power = [&](const FilmStack& stack, double c) {
      // Grazing light from the glass's side is past the critical angle by rounding at most.
      return Power{
          Rgb(Sampled([&](double nm) { return FilmPower(stack, nm, c).reflectance(); })),
          Rgb(Sampled([&](double nm) { return FilmPower(stack, nm, c).transmittance(); }))};
    };
    look.outside_.push_back(power(coat, cosine));
    look.inside_.push_back(i == 0 ? look.outside_.back() : power(reversed, inside));
  }
  return look;
}

SurfaceLook::Power SurfaceLook::At(const std::vector<Power>& table, float cosine) {
  const float at = std::clamp(cosine, 0.0f, 1.0f) * kAngles;
  const int i = std::min(int(at), kAngles - 1);
  const float f = at - float(i);
  const Power& a = table[std::size_t(i)];
  const Power& b = table[std::size_t(i) + 1];
  return {(1 - f) * a.reflected + f * b.reflected, (1 - f) * a.passed + f * b.passed};
}

TintLook::TintLook(const TintOrder& order, double top_mm, double bottom_mm)
    : solid_(order.tint.kind == TintKind::kSolid),
      gradient_(order.gradient),
      top_mm_(top_mm),
      bottom_mm_(bottom_mm) {
  table_end_ = solid_ ? kLongestPath_mm : 1;
  for (int i = 0; i <= kStrengths; ++i) {
    const double strength = table_end_ * i / kStrengths;
    // A dip's absorbance scales with the share of the dye that the ray passes.
    table_.push_back(Rgb(Sampled([&](double nm) {
      return solid_ ? order.tint.Transmittance(nm, strength)
                    : std::pow(order.tint.Transmittance(nm, 0), strength);
    })));
  }
}

double TintLook::Share(double y_mm) const {
  if (!gradient_ || !(top_mm_ > bottom_mm_)) return 1;
  return std::clamp((y_mm - bottom_mm_) / (top_mm_ - bottom_mm_), 0.0, 1.0);
}

Eigen::Vector3f TintLook::Between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  if (table_.empty()) return Eigen::Vector3f::Ones();
  const double strength = solid_ ? (to - from).norm() : 0.5 * (Share(from.y()) + Share(to.y()));
  const float at = float(std::clamp(strength / table_end_, 0.0, 1.0)) * kStrengths;
  const int i = std::min(int(at), kStrengths - 1);
  const float f = at - float(i);
  return (1 - f) * table_[std::size_t(i)] + f * table_[std::size_t(i) + 1];
}

LensLook LookOf(const LensFinish& finish, double index, double top_mm, double bottom_mm) {
  LensLook look;
  look.front =
      SurfaceLook::Of(finish.mirror != MirrorCoat::kNone ? MirrorOn(finish.mirror, index)
                                                         : CoatOn(finish.front_coat, index));
  look.back = SurfaceLook::Of(CoatOn(finish.back_coat, index));
  if (finish.tint) look.tint = TintLook(*finish.tint, top_mm, bottom_mm);
  return look;
}

Eigen::Vector3f NormalReflectance(const SurfaceLook& surface, double index) {
  if (!surface.bare()) return surface.FromAir(1).reflected;
  return Eigen::Vector3f::Constant(float(FresnelReflectance(1, 1 / index)));
}

bool FollowsGhosts(const LensLook& look, double index) {
  constexpr float kLeastGhost = 0.01f;
  return NormalReflectance(look.front, index)
             .cwiseProduct(NormalReflectance(look.back, index))
             .maxCoeff() >= kLeastGhost;
}

}  // namespace lorgnette
