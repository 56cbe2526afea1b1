// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "optics/design.h"

namespace lorgnette::test {

// An order of defaults but for its power (D) and axis (degrees).
inline LensOrder PowerOrder(double sphere, double cylinder = 0, double axis = 180) {
  LensOrder order;
  order.rx.sphere = Diopters(sphere);
  order.rx.cylinder = Diopters(cylinder);
  order.rx.axis = AxisDegrees(axis);
  return order;
}

// The same in a medium of n = 1.6, in a round blank.
inline LensOrder Order160(double sphere, double cylinder = 0, double axis = 180,
                          double diameter_mm = 50) {
  LensOrder order = PowerOrder(sphere, cylinder, axis);
  order.medium = {"1.60", 1.6, 42, 1.30};
  order.diameter_mm = diameter_mm;
  return order;
}

}  // namespace lorgnette::test
