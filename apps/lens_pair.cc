// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_pair.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "optics/magnification.h"
#include "optics/paraxial.h"
#include "optics/prism.h"

namespace lorgnette {
namespace {

// Mean of both meridians, distant object.
double MeanMagnification(const MadeLens& made) {
  const LensDesign& design = made.design;
  return 0.5 * SpectacleMagnification(SystemOf(design.lens),
                                      design.order.vertex_distance_mm + kEntrancePupilDepth_mm)
                   .trace();
}

IseikonicEye EyeOf(const MadeLens& made) {
  const LensDesign& design = made.design;
  IseikonicEye eye;
  eye.back_vertex_power = Diopters(0.5 * SystemOf(design.lens).BackVertexPower().trace());
  eye.pupil_mm = design.order.vertex_distance_mm + kEntrancePupilDepth_mm;
  eye.base_curve = design.front_power;
  eye.thickness_mm = design.lens.center_thickness_mm;
  return eye;
}

}  // namespace

Result<Iseikonic> MakeIseikonic(const std::vector<MadeLens>& lenses, double ratio,
                                std::vector<LensOrder>& orders) {
  if (!(ratio >= 0.8 && ratio <= 1.25)) {
    return UsageError(fmt::format("--iseikonic: got {}, want 0.8..1.25", ratio));
  }
  IseikonicOrder wanted;
  wanted.right = EyeOf(lenses[0]);
  wanted.left = EyeOf(lenses[1]);
  wanted.index = lenses[0].design.lens.medium.index_d;
  wanted.ratio = ratio;
  Iseikonic made;
  made.ratio_wanted = ratio;
  LG_ASSIGN(made.pair, DesignIseikonicPair(wanted));
  const IseikonicLens* designed[] = {&made.pair.right, &made.pair.left};
  for (std::size_t i = 0; i < 2; ++i) {
    orders[i].base_curve = designed[i]->base_curve;
    orders[i].center_thickness_mm = designed[i]->thickness_mm;
  }
  return made;
}

nlohmann::ordered_json PairJson(const std::vector<MadeLens>& lenses, double drop_mm,
                                const std::optional<Iseikonic>& iseikonic) {
  using Json = nlohmann::ordered_json;
  const Lens &right = lenses[0].design.lens, &left = lenses[1].design.lens;
  Json json = {{"reading_drop_mm", drop_mm}};
  const auto imbalance = VerticalImbalance(right, left, drop_mm);
  json["vertical_imbalance"] = imbalance ? Json(*imbalance) : Json(nullptr);
  json["slab_off"] = nullptr;
  const auto slab = PlanSlabOff(right, left, drop_mm);
  if (slab && slab->prism > 0) {
    json["slab_off"] = {{"eye", slab->eye == Eye::kRight ? "right" : "left"},
                        {"prism_up", slab->prism}};
  }
  json["magnification_ratio"] = MeanMagnification(lenses[0]) / MeanMagnification(lenses[1]);
  if (iseikonic) {
    json["iseikonic"] = {{"ratio_wanted", iseikonic->ratio_wanted},
                         {"ratio_before", iseikonic->pair.ratio_before},
                         {"ratio", iseikonic->pair.ratio}};
  }
  return json;
}

std::string PairText(const std::vector<MadeLens>& lenses, double drop_mm,
                     const std::optional<Iseikonic>& iseikonic) {
  const Lens &right = lenses[0].design.lens, &left = lenses[1].design.lens;
  std::string text = "Pair\n";
  const auto imbalance = VerticalImbalance(right, left, drop_mm);
  const auto slab = PlanSlabOff(right, left, drop_mm);
  if (imbalance) {
    text += fmt::format("  vertical imbalance {:g} mm below the centres: {:+.2f} prism D{}\n",
                        drop_mm, *imbalance,
                        slab && slab->prism > 0
                            ? fmt::format(", slab-off {:.2f} base up on the {} lens", slab->prism,
                                          slab->eye == Eye::kRight ? "right" : "left")
                            : std::string());
  }
  text += fmt::format("  magnification, right over left: {:.5f}",
                      MeanMagnification(lenses[0]) / MeanMagnification(lenses[1]));
  if (iseikonic) {
    text += fmt::format(" (before the iseikonic design {:.5f})", iseikonic->pair.ratio_before);
  }
  return text + "\n";
}

}  // namespace lorgnette
