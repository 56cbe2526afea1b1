// SPDX-License-Identifier: Apache-2.0
#include "optics/iseikonic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/magnification.h"

namespace lorgnette {
namespace {

Status Check(const IseikonicEye& eye, const IseikonicOrder& order, const char* name) {
  if (!(eye.base_curve.value() > 0 && eye.base_curve <= order.max_base_curve)) {
    return UsageError(fmt::format("iseikonic:{}.base_curve: got {:g}, want above 0, at most {:g}",
                                  name, eye.base_curve.value(), order.max_base_curve.value()));
  }
  if (!(eye.thickness_mm > 0 && eye.thickness_mm <= order.max_thickness_mm)) {
    return UsageError(fmt::format("iseikonic:{}.thickness_mm: got {:g}, want above 0, at most {:g}",
                                  name, eye.thickness_mm, order.max_thickness_mm));
  }
  if (!(PowerFactor(eye.back_vertex_power, eye.pupil_mm) > 0)) {
    return UsageError(fmt::format("iseikonic:{}: {:g} D at {:g} mm puts the image at the pupil",
                                  name, eye.back_vertex_power.value(), eye.pupil_mm));
  }
  return {};
}

IseikonicLens Build(const IseikonicEye& eye, Diopters base_curve, double thickness_mm,
                    double index) {
  const double shape = ShapeFactor(base_curve, thickness_mm, index);
  IseikonicLens lens;
  lens.base_curve = base_curve;
  lens.thickness_mm = thickness_mm;
  lens.back_power = eye.back_vertex_power - shape * base_curve;
  lens.magnification = shape * PowerFactor(eye.back_vertex_power, eye.pupil_mm);
  return lens;
}

// Raises the lens to this magnification; its own limit when that is not enough.
IseikonicLens Raise(const IseikonicEye& eye, double magnification, const IseikonicOrder& order) {
  const double shape = magnification / PowerFactor(eye.back_vertex_power, eye.pupil_mm);
  // tau F1 in D mm: base curve times thickness.
  const double wanted = 1000 * order.index * (1 - 1 / shape);
  const double factor = std::sqrt(wanted / (eye.base_curve.value() * eye.thickness_mm));
  double base = std::min(eye.base_curve.value() * factor, order.max_base_curve.value());
  const double thickness = std::min(wanted / base, order.max_thickness_mm);
  base = std::min(wanted / thickness, order.max_base_curve.value());
  return Build(eye, Diopters(base), thickness, order.index);
}

}  // namespace

Result<IseikonicPair> DesignIseikonicPair(const IseikonicOrder& order) {
  if (!(order.index > 1)) {
    return UsageError(fmt::format("iseikonic:index: got {:g}, want above 1", order.index));
  }
  if (!(order.ratio > 0.5 && order.ratio < 2)) {
    return UsageError(fmt::format("iseikonic:ratio: got {:g}, want 0.5..2", order.ratio));
  }
  LG_RETURN_IF_ERROR(Check(order.right, order, "right"));
  LG_RETURN_IF_ERROR(Check(order.left, order, "left"));

  IseikonicPair pair;
  pair.right = Build(order.right, order.right.base_curve, order.right.thickness_mm, order.index);
  pair.left = Build(order.left, order.left.base_curve, order.left.thickness_mm, order.index);
  pair.ratio_before = pair.right.magnification / pair.left.magnification;
  if (pair.ratio_before < order.ratio) {
    pair.right = Raise(order.right, order.ratio * pair.left.magnification, order);
  } else {
    pair.left = Raise(order.left, pair.right.magnification / order.ratio, order);
  }
  pair.ratio = pair.right.magnification / pair.left.magnification;
  constexpr double kReached = 1e-12;
  if (std::abs(pair.ratio - order.ratio) > kReached) {
    return Failure(fmt::format(
        "iseikonic:ratio: got {:g}, want one that base curves to {:g} D and thicknesses to {:g} mm "
        "allow: from {:.4f} they reach {:.4f}",
        order.ratio, order.max_base_curve.value(), order.max_thickness_mm, pair.ratio_before,
        pair.ratio));
  }
  return pair;
}

}  // namespace lorgnette
