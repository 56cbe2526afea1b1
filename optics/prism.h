// SPDX-License-Identifier: Apache-2.0
// Prism by position: Prentice's rule and its exact counterpart by rays, decentration that makes an
// ordered prism, imbalance of a pair, slab-off. (Prism by grinding: optics/back_surface.h.)
//
// Prisms are vectors in the lens frame's x, y (optics/ray.h), prism dioptres, toward the base.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/result.h"
#include "optics/front_form.h"
#include "optics/lens.h"

namespace lorgnette {

// Base in (+) and up (+) as an order writes them, in the lens frame, and back.
Eigen::Vector2d PrismInLensFrame(Eye eye, double prism_in, double prism_up);
double PrismIn(Eye eye, const Eigen::Vector2d& prism);

// Prentice: -F r. r in mm from the optical centre; thin, first order.
Eigen::Vector2d PrenticePrism(const Eigen::Matrix2d& power_D, const Eigen::Vector2d& r_mm);
// The same by an exact ray parallel to the axis through the front surface over r.
std::optional<Eigen::Vector2d> PrismAt(const Lens& lens, double index, const Eigen::Vector2d& r_mm);

// Where on a lens without ground prism the prism is the one ordered: the lens is then mounted with
// that point where its optical centre would have been. Newton on the traced prism, to
// kDecentrationTolerance_D. Fails where no point within `max_mm` has it (no power in the prism's
// direction, or too little) and says what is possible.
inline constexpr double kDecentrationTolerance_D = 1e-10;
Result<Eigen::Vector2d> DecenterForPrism(const Lens& lens, const Eigen::Vector2d& prism,
                                         double max_mm);

// An order's prism split into what a decentration of at most `max_mm` gives exactly and what has to
// be ground: all of the one or all of the other.
struct PrismPlan {
  Eigen::Vector2d reference_point_mm{0, 0};  // from the optical centre; zero when ground
  Eigen::Vector2d ground{0, 0};              // zero when decentred
};
PrismPlan PlanPrism(const Lens& lens_without_prism, const Eigen::Vector2d& prism, double max_mm);

// Vertical imbalance of a pair where both eyes look `drop_mm` below the optical centres: base up of
// the right lens less that of the left. nullopt where a lens has ended.
std::optional<double> VerticalImbalance(const Lens& right, const Lens& left, double drop_mm);

// Slab-off: base-up prism below a horizontal line of one lens, that of the more minus power there.
struct SlabOff {
  Eye eye = Eye::kRight;
  double prism = 0;  // base up; 0 where the imbalance is below the limit
};
inline constexpr double kLeastSlabOff = 1.5;  // imbalance below it is borne
std::optional<SlabOff> PlanSlabOff(const Lens& right, const Lens& left, double drop_mm);

}  // namespace lorgnette
