// SPDX-License-Identifier: Apache-2.0
#include "tracking/focal_prior.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/units.h"
#include "tracking/face_model.h"

namespace lorgnette {
namespace {

constexpr double kFieldLogSigma = 0.45, kDistanceLogSigma = 0.3;

}  // namespace

double TypicalFocal(int width, int height, double pd_mm,
                    const std::vector<const FaceLandmarks*>& landmarks) {
  std::vector<double>
      spans;  // px between the pupils; depth is in the same unit, so turns matter not
  for (const FaceLandmarks* face : landmarks) {
    if (face != nullptr) spans.push_back(PupilsOf(face->points).distance());
  }
  LG_CHECK(!spans.empty());
  const auto middle = spans.begin() + long(spans.size() / 2);
  std::nth_element(spans.begin(), middle, spans.end());
  const double by_field =
      std::max(width, height) / 2.0 / std::tan(RadiansFromDegrees(kTypicalFieldDeg) / 2);
  const double by_distance = kTypicalDistanceMm * *middle / pd_mm;
  const double field_weight = 1 / (kFieldLogSigma * kFieldLogSigma);
  const double distance_weight = 1 / (kDistanceLogSigma * kDistanceLogSigma);
  return std::exp((field_weight * std::log(by_field) + distance_weight * std::log(by_distance)) /
                  (field_weight + distance_weight));
}

}  // namespace lorgnette
