// SPDX-License-Identifier: Apache-2.0
// What a command line may ask of a lens beside its sheet: an eye that turns, a camera before it, a
// focimeter, maps, and what it does to light. Each adds keys to the lens' JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "apps/lens_options.h"
#include "apps/lens_orders.h"
#include "optics/lens_sheet.h"

namespace lorgnette {

struct LensQuestions {
  std::optional<double> camera_mm, depth_mm, height_mm;
  std::vector<double> gaze_deg;  // theta, phi
  double stop_mm = 27;
  std::vector<double> focimeter_mm;  // x, y on the back surface
  double aperture_mm = 2.5;          // radius of the focimeter's pupil
  std::optional<double> map_deg;     // half angle
};

void AddQuestionOptions(CLI::App& command, LensQuestions& questions);

// The lens as JSON: its sheet (apps/lens_json.h), how it came about, and every answer.
Result<nlohmann::ordered_json> AnsweredJson(const MadeLens& lens, const LensOptions& options,
                                            const LensQuestions& questions);

// Light through the lens' centre, with its coats and tint.
struct LensLight {
  double luminous_transmittance = 1;
  double luminous_transmittance_edge = 1;     // where it is thickest
  std::optional<int> filter_category;         // nullopt: too dark for any
  double reflectance = 0;                     // luminous, of one surface, normal incidence
  double reflection_x = 0, reflection_y = 0;  // its chromaticity in daylight
  double ghost_power_D = 0, ghost_intensity = 0;
};
Result<LensLight> LightOf(const LensDesign& design, const LensOptions& options);

}  // namespace lorgnette
