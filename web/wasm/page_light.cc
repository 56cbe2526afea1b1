// SPDX-License-Identifier: Apache-2.0
#include "page_light.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "optics/luminous.h"
#include "optics/tint.h"

namespace lorgnette::page {

const Mirror& Mirror::Of(CoatKind coat, double index) {
  static std::optional<Mirror> last;
  if (!last || last->coat_ != coat || last->index_ != index) last = Mirror(coat, index);
  return *last;
}

Mirror::Mirror(CoatKind coat, double index) : coat_(coat), index_(index) {
  for (int i = 0; i < kMirrorNodes; ++i) {
    const Spectrum spectrum = CoatReflectance(coat, index, double(i) / (kMirrorNodes - 1));
    nodes_[std::size_t(i)] << LuminousFraction(spectrum), LinearRgbUnderD65(spectrum);
  }
}

Eigen::Vector4d Mirror::At(double cos_incident) const {
  const double at = std::clamp(cos_incident, 0.0, 1.0) * (kMirrorNodes - 1);
  const auto k = std::min(std::size_t(at), std::size_t(kMirrorNodes - 2));
  return nodes_[k] + (at - double(k)) * (nodes_[k + 1] - nodes_[k]);
}
double Mirror::Luminous(double cos_incident) const { return At(cos_incident)[0]; }
Eigen::Vector3d Mirror::Rgb(double cos_incident) const {
  return At(cos_incident).tail<3>().cwiseMax(0);
}

double CosineOutside(double cos_inside, double index) {
  const double sine2 = index * index * (1 - cos_inside * cos_inside);
  return sine2 < 1 ? std::sqrt(1 - sine2) : -1;
}

double Passed(const Mirror& mirror, double cos_front, double cos_back, double glass) {
  const double front = mirror.Luminous(cos_front), back = mirror.Luminous(cos_back);
  return (1 - front) * glass * (1 - back) / (1 - front * back * glass * glass);
}

}  // namespace lorgnette::page
