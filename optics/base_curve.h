// SPDX-License-Identifier: Apache-2.0
// The front curve of a lens, by rule. Powers are true ones at the lens' own index.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/units.h"

namespace lorgnette {

enum class BaseCurveRule { kVogel, kTscherning };

// Vogel's rule: spherical equivalent + 6 D for plus lenses, half of it + 6 D for minus lenses, kept
// to kFlattestRuleCurve_D or steeper. Source: docs/optics.md, "Form".
inline constexpr double kFlattestRuleCurve_D = 0.5;
Diopters VogelBaseCurve(Diopters spherical_equivalent);

// Tscherning's ellipse: the front powers that free a thin lens of oblique astigmatism to third
// order, for an eye turning `stop_mm` behind it and a distant object.
//   (n+2) F1^2 - [(n+2) F + 2 (n^2-1) Z] F1 + n [F + (n-1) Z]^2 = 0,  Z = 1 / stop
// nullopt where there is none: beyond about -23 and +7 D.
struct TscherningForms {
  Diopters ostwalt, wollaston;  // the flatter and the steeper one
};
std::optional<TscherningForms> Tscherning(Diopters power, double index, double stop_mm = 27);

// Power that a surfacing tool or lens clock calibrated for `tool_index` shows for a surface whose
// true power at `index` is `power`: the curvature is what both share.
inline constexpr double kToolIndex = 1.530;
Diopters ToolPower(Diopters power, double index, double tool_index = kToolIndex);

// Steepest curve that still has a real front surface with a margin over a lens of this radius: the
// sag's slope angle there stays below asin(kSteepestRimSine).
inline constexpr double kSteepestRimSine = 0.85;
Diopters SteepestBaseCurve(double rim_radius_mm, double index);

// A manufacturer-style chart: for each medium the base curve to take, by spherical equivalent.
struct BaseCurveChart {
  struct Row {
    double upper_se_D = 0;  // the row serves spherical equivalents up to this one
    double base_D = 0;
  };
  struct MediumRows {
    std::string medium;
    double index = 0;       // the powers are true at this index
    std::vector<Row> rows;  // ascending; the last one serves everything above
  };
  std::string name;
  std::vector<MediumRows> media;

  // By name, or else by the nearest index; the chart's power is converted to `index` by keeping
  // the radius. Fails when the chart is empty.
  Result<Diopters> Choose(const std::string& medium, double index,
                          Diopters spherical_equivalent) const;
};

// {"name": "..", "media": [{"medium": "CR-39", "index": 1.498, "upper_se": [-9, ..], "base": [0.5,
// ..]}]}; `base` has one entry more than `upper_se`, or as many.
Result<BaseCurveChart> ParseBaseCurveChart(const std::string& json_text, const std::string& name);

// Best form by rays: of `bases_D` the one with the least root mean square of sagittal and
// tangential errors at kBestFormGaze_deg of eye rotation, distant object, eye turning 27 mm behind
// the back vertex. Thickness as labs make it: `min_center_mm` for minus lenses, and for plus ones
// 1 + F 32.5^2 / (2000 (n - 1)) mm.
inline constexpr double kBestFormGaze_deg = 30;
Diopters BestFormBaseCurve(Diopters power, double index, double min_center_mm,
                           const std::vector<double>& bases_D);
// RMS of S' - F and T' - F of that lens, D; nullopt where the eye's rays do not pass.
std::optional<double> FormError(Diopters power, Diopters base, double index, double min_center_mm);

// The chart so computed for every standard medium: rows at every 0.5 D of spherical equivalent from
// -15 to +8, bases in 0.5 D steps from 0.5 to 12, no more than 2 D steeper than Vogel's for minus
// lenses. Between -1.5 and +1.5 D, where no form errs visibly, the rows are interpolated.
BaseCurveChart ComputeBestFormChart();
std::string WriteBaseCurveChart(const BaseCurveChart& chart);

}  // namespace lorgnette
