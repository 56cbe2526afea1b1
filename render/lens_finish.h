// SPDX-License-Identifier: Apache-2.0
// How a pair of lenses is finished: coats on their surfaces, tint in the glass, the edge; and the
// same as tables of linear Rec.709 light that a ray can afford to look into.
//
// Spectra (optics/thin_film, optics/tint) are weighed by the eye under D65 once; a table's channel
// is then multiplied onto the channel of what the ray meets. Source: docs/rendering.md, "Coats and
// tints". Tested: bare glass is Fresnel's, energy balance of coats without absorption at every
// angle, tables against the spectral sum.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "optics/lens.h"
#include "optics/tint.h"

namespace lorgnette {

// What a ray inside the glass finds at the edge wall.
enum class EdgeFinish {
  kPolished,  // a smooth dielectric: internal reflection goes on
  kGround,    // a matt, whitish wall lit by the mean of the environment
};

// Coats that tint the mirror image, on the front alone: three metals or stacks of quarter waves.
enum class MirrorCoat { kNone, kSilver, kBlue, kGreen, kGold, kRed };

// A tint by its colour, and how much light the glass alone passes (luminous, 0..1, not 0).
struct TintOrder {
  Tint tint;              // strengths as ordered; kSolid: a mm of path
  bool gradient = false;  // full at the top of the lens, none at its bottom (kDip only)
  double luminous = 1;    // at strength 1: kDip the whole lens, kSolid `reference_mm` of path
  double reference_mm = 2;
};

struct LensFinish {
  CoatKind front_coat = CoatKind::kNone, back_coat = CoatKind::kNone;
  MirrorCoat mirror = MirrorCoat::kNone;  // over whatever the front would carry
  std::optional<TintOrder> tint;
  EdgeFinish edge = EdgeFinish::kGround;
};

// `none`, `single`, `v`, `ar` (broadband) on both surfaces; `mirror` (silver), `mirror-blue`,
// `-green`, `-gold`, `-red` with `ar` on the back. FRONT/BACK: one on each (`mirror/none`), mirrors
// on the front only.
Status SetCoating(std::string_view name, LensFinish& finish);
// COLOUR:PERCENT[:dip|solid|gradient]: grey, brown, green, blue, rose or yellow glass that passes
// that much of the light (`brown:40:gradient`); `none`.
Status SetTint(std::string_view text, LensFinish& finish);
// `ground` or `polished`.
Status SetEdge(std::string_view name, LensFinish& finish);

// One surface of the glass at every angle.
class SurfaceLook {
 public:
  struct Power {
    Eigen::Vector3f reflected, passed;
  };
  // coat: as light from the air meets it.
  static SurfaceLook Of(const FilmStack& coat);

  // Plain glass: the scalar Fresnel reflectance is the whole truth.
  bool bare() const { return outside_.empty(); }
  // cosine: in air, of the angle of incidence or refraction.
  Power FromAir(float cosine) const { return At(outside_, cosine); }
  Power FromGlass(float cosine_in_air) const { return At(inside_, cosine_in_air); }

 private:
  static Power At(const std::vector<Power>& table, float cosine);
  std::vector<Power> outside_, inside_;
};

// The tint as a factor of what passes between two points of the glass's boundary (lens frame).
class TintLook {
 public:
  TintLook() = default;
  //   top_mm, bottom_mm  of the lens's shape: where a gradient starts and ends
  TintLook(const TintOrder& order, double top_mm, double bottom_mm);

  bool clear() const { return table_.empty(); }
  Eigen::Vector3f Between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  double Share(double y_mm) const;
  std::vector<Eigen::Vector3f> table_;  // of the strength, from 0 to table_end_
  double table_end_ = 1;
  bool solid_ = false, gradient_ = false;
  double top_mm_ = 0, bottom_mm_ = 0;
};

// All of one lens.
struct LensLook {
  SurfaceLook front, back;
  TintLook tint;
  bool plain() const { return front.bare() && back.bare() && tint.clear(); }
};
LensLook LookOf(const LensFinish& finish, double index, double top_mm, double bottom_mm);

// Reflectance of a finish's front and back surface, from the air, at normal incidence.
Eigen::Vector3f NormalReflectance(const SurfaceLook& surface, double index);
// Whether a second internal reflection of a lens carries enough to be followed at every pixel.
bool FollowsGhosts(const LensLook& look, double index);

}  // namespace lorgnette
