// SPDX-License-Identifier: Apache-2.0
#include "optics/base_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/json_reader.h"
#include "optics/gaze.h"
#include "optics/media.h"

namespace lorgnette {
namespace {

constexpr double kChartStep_D = 0.5;
constexpr double kSteepestChartCurve_D = 12;
constexpr double kAboveVogel_D = 2;
constexpr double kWeak_D = 1.5;  // below it every form is good and the best one is noise

}  // namespace

Diopters VogelBaseCurve(Diopters spherical_equivalent) {
  const double se = spherical_equivalent.value();
  return Diopters(std::max(se > 0 ? se + 6 : se / 2 + 6, kFlattestRuleCurve_D));
}

std::optional<TscherningForms> Tscherning(Diopters power, double index, double stop_mm) {
  const double n = index, f = power.value(), z = 1000 / stop_mm;
  const double a = n + 2, half_b = 0.5 * ((n + 2) * f + 2 * (n * n - 1) * z);
  const double c = n * (f + (n - 1) * z) * (f + (n - 1) * z);
  const double disc = half_b * half_b - a * c;
  if (!(disc >= 0)) return std::nullopt;
  const double steep = half_b + std::copysign(std::sqrt(disc), half_b);
  if (steep == 0) return TscherningForms{Diopters(0), Diopters(0)};
  const double one = steep / a, other = c / steep;
  return TscherningForms{Diopters(std::min(one, other)), Diopters(std::max(one, other))};
}

Diopters ToolPower(Diopters power, double index, double tool_index) {
  return power * ((tool_index - 1) / (index - 1));
}

Diopters SteepestBaseCurve(double rim_radius_mm, double index) {
  return Diopters::FromPerMm((index - 1) * kSteepestRimSine / rim_radius_mm);
}

Result<Diopters> BaseCurveChart::Choose(const std::string& medium, double index,
                                        Diopters spherical_equivalent) const {
  const MediumRows* best = nullptr;
  for (const MediumRows& rows : media) {
    if (rows.rows.empty()) continue;
    if (rows.medium == medium) {
      best = &rows;
      break;
    }
    if (!best || std::abs(rows.index - index) < std::abs(best->index - index)) best = &rows;
  }
  if (!best) return Failure(fmt::format("base curve chart \"{}\": it has no rows", name));
  for (const Row& row : best->rows) {
    if (spherical_equivalent.value() <= row.upper_se_D || &row == &best->rows.back()) {
      return Diopters(row.base_D * (index - 1) / (best->index - 1));
    }
  }
  return Diopters(best->rows.back().base_D * (index - 1) / (best->index - 1));
}

Result<BaseCurveChart> ParseBaseCurveChart(const std::string& json_text, const std::string& name) {
  LG_ASSIGN(JsonReader json, JsonReader::Parse(json_text, name));
  BaseCurveChart chart;
  chart.name = json.String("name");
  for (JsonReader& medium : json.Objects("media")) {
    BaseCurveChart::MediumRows rows;
    rows.medium = medium.String("medium");
    rows.index = medium.Number("index", 1.3, 2.2);
    const std::vector<double> upper = medium.Numbers("upper_se");
    const std::vector<double> base = medium.Numbers("base");
    if (base.empty() || (base.size() != upper.size() && base.size() != upper.size() + 1)) {
      medium.Fail("base", fmt::format("got {} curves for {} limits, want one more, or as many",
                                      base.size(), upper.size()));
    }
    if (!std::is_sorted(upper.begin(), upper.end())) {
      medium.Fail("upper_se", "not ascending");
    }
    for (std::size_t i = 0; i < base.size(); ++i) {
      if (std::abs(base[i]) > 25) medium.Fail("base", fmt::format("got {}, want -25..25", base[i]));
      rows.rows.push_back({i < upper.size() ? upper[i] : HUGE_VAL, base[i]});
    }
    chart.media.push_back(std::move(rows));
  }
  LG_RETURN_IF_ERROR(json.Finish());
  return chart;
}

std::optional<double> FormError(Diopters power, Diopters base, double index, double min_center_mm) {
  const double f = power.value(), n = index;
  const double t =
      std::max(min_center_mm, f > 0 ? 1 + f * 32.5 * 32.5 / (2000 * (n - 1)) : min_center_mm);
  const double tau = t / 1000 / n;
  Lens lens;
  lens.medium.index_d = n;
  lens.center_thickness_mm = t;
  lens.front = SphereSurface{base.per_mm() / (n - 1)};
  lens.back =
      SphereSurface{Diopters(f - base.value() / (1 - tau * base.value())).per_mm() / (1 - n)};
  const GazeVergence gaze =
      EvaluateGaze(lens, n, EyePose::OnAxis(lens), {RadiansFromDegrees(kBestFormGaze_deg), 0});
  if (gaze.status != RayStatus::kOk) return std::nullopt;
  return std::hypot(gaze.sagittal_D - f, gaze.tangential_D - f) / std::sqrt(2.0);
}

Diopters BestFormBaseCurve(Diopters power, double index, double min_center_mm,
                           const std::vector<double>& bases_D) {
  double best = bases_D.front(), least = HUGE_VAL;
  for (const double base : bases_D) {
    const auto error = FormError(power, Diopters(base), index, min_center_mm);
    if (error && *error < least) {
      least = *error;
      best = base;
    }
  }
  return Diopters(best);
}

BaseCurveChart ComputeBestFormChart() {
  BaseCurveChart chart;
  chart.name = "computed best form, least RMS of S' and T' at 30 degrees";
  for (const MediumEntry& entry : StandardMedia()) {
    const double n = entry.medium.index_d;
    const auto best = [&](double se) {
      // Minus lenses have a second least error on steep, bulging forms that nobody wears.
      const double steepest =
          se < 0 ? VogelBaseCurve(Diopters(se)).value() + kAboveVogel_D : kSteepestChartCurve_D;
      std::vector<double> bases;
      for (double b = kFlattestRuleCurve_D; b <= steepest; b += kChartStep_D) bases.push_back(b);
      return BestFormBaseCurve(Diopters(se), n, entry.min_center_mm, bases).value();
    };
    const double weakest[2] = {best(-kWeak_D), best(kWeak_D)};
    BaseCurveChart::MediumRows rows{entry.medium.name, n, {}};
    for (double se = -15; se <= 8; se += kChartStep_D) {
      const double along = (se + kWeak_D) / (2 * kWeak_D);
      const double base =
          std::abs(se) >= kWeak_D
              ? best(se)
              : kChartStep_D *
                    std::round((weakest[0] + along * (weakest[1] - weakest[0])) / kChartStep_D);
      rows.rows.push_back({se, base});
    }
    chart.media.push_back(std::move(rows));
  }
  return chart;
}

std::string WriteBaseCurveChart(const BaseCurveChart& chart) {
  std::string text = fmt::format("{{\n  \"name\": \"{}\",\n  \"media\": [", chart.name);
  for (const auto& medium : chart.media) {
    std::vector<double> upper, base;
    for (const auto& row : medium.rows) {
      if (std::isfinite(row.upper_se_D)) upper.push_back(row.upper_se_D);
      base.push_back(row.base_D);
    }
    text += fmt::format(
        "{}\n    {{\"medium\": \"{}\", \"index\": {},\n     \"upper_se\": [{}],\n     \"base\": "
        "[{}]}}",
        &medium == &chart.media.front() ? "" : ",", medium.medium, medium.index,
        fmt::join(upper, ", "), fmt::join(base, ", "));
  }
  return text + "\n  ]\n}\n";
}

}  // namespace lorgnette
