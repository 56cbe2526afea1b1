// SPDX-License-Identifier: Apache-2.0
#include "render/lobe_mean.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lobe_mean.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, by Highway's rule.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lorgnette::lobe {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, LobeSource::kOver>;

// sums: three channels and the weight.
void Sum(const LobeSource& source, const LobeKernel& kernel, const Eigen::Vector3f& d,
         float* sums) {
  const D tag;
  const hn::RebindToSigned<D> whole;
  const float cos_cut = kernel.cos_cut();
  const auto cut = hn::Set(tag, cos_cut), scale = hn::Set(tag, kernel.scale());
  const auto last = hn::Set(tag, float(LobeKernel::kSteps)), zero = hn::Zero(tag);
  const auto dx = hn::Set(tag, d.x()), dz = hn::Set(tag, d.z());
  auto red = zero, green = zero, blue = zero, weight = zero;
  const float horizontal = std::sqrt(d.x() * d.x() + d.z() * d.z());
  const float middle = source.ColumnAt(std::atan2(-d.x(), d.z()));
  const int width = source.width;
  for (std::size_t y = 0; y < source.rows.size(); ++y) {
    const LobeSource::Row& row = source.rows[y];
    // The best any column of this row can do.
    const float best = horizontal * row.cos_lat, wanted = cos_cut - d.y() * row.sin_lat;
    if (best < wanted) continue;
    // Columns that can reach the cut lie this far to either side; one more for the last, which may
    // be narrower than the others.
    const float away =
        wanted <= -best ? float(width) : std::acos(wanted / best) * source.columns_a_radian + 2;
    const bool all = 2 * away + 1 >= float(width);
    const int leftmost = all ? 0 : int(std::floor(middle - away));
    const int beyond = all ? width : int(std::ceil(middle + away)) + 1;
    const std::size_t count = std::size_t(std::min(beyond - leftmost, width));
    const std::size_t first = std::size_t(leftmost < 0 ? leftmost + width : leftmost);
    const float* map[3];
    for (std::size_t c = 0; c < 3; ++c) {
      map[c] = source.channels[c].data() + y * source.stride() + first;
    }
    const auto up = hn::Set(tag, d.y() * row.sin_lat), across = hn::Set(tag, row.cos_lat);
    const auto solid_angle = hn::Set(tag, row.weight);
    for (std::size_t k = 0; k < count; k += hn::Lanes(tag)) {
      const auto along = hn::MulAdd(dx, hn::LoadU(tag, source.minus_sin_lon.data() + first + k),
                                    hn::Mul(dz, hn::LoadU(tag, source.cos_lon.data() + first + k)));
      const auto cosine = hn::MulAdd(across, along, up);
      const auto counts = hn::And(hn::Ge(cosine, cut), hn::FirstN(tag, count - k));
      const auto at = hn::Min(hn::Max(hn::Mul(hn::Sub(cosine, cut), scale), zero), last);
      const auto step = hn::ConvertTo(whole, at);
      const auto low = hn::GatherIndex(tag, kernel.values(), step);
      const auto high = hn::GatherIndex(tag, kernel.values() + 1, step);
      const auto value = hn::MulAdd(hn::Sub(at, hn::ConvertTo(tag, step)), hn::Sub(high, low), low);
      const auto w = hn::IfThenElseZero(counts, hn::Mul(solid_angle, value));
      red = hn::MulAdd(w, hn::LoadU(tag, map[0] + k), red);
      green = hn::MulAdd(w, hn::LoadU(tag, map[1] + k), green);
      blue = hn::MulAdd(w, hn::LoadU(tag, map[2] + k), blue);
      weight = hn::Add(weight, w);
    }
  }
  const hn::Vec<D> all[4] = {red, green, blue, weight};
  for (int k = 0; k < 4; ++k) sums[k] = hn::GetLane(hn::SumOfLanes(tag, all[k]));
}

}  // namespace HWY_NAMESPACE
}  // namespace lorgnette::lobe
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace lorgnette {
namespace lobe {
namespace {

HWY_EXPORT(Sum);

}  // namespace
}  // namespace lobe

LobeKernel::LobeKernel(double exponent, double cos_cut)
    : cos_cut_(float(cos_cut)), scale_(float(kSteps / (1 - cos_cut))) {
  for (int i = 0; i <= kSteps; ++i) {
    values_.push_back(float(std::pow(cos_cut + (1 - cos_cut) * i / kSteps, exponent)));
  }
  values_.push_back(values_.back());
}

Eigen::Vector3f LobeMean(const LobeSource& source, const LobeKernel& kernel,
                         const Eigen::Vector3f& d) {
  float sums[4];
  HWY_DYNAMIC_DISPATCH(lobe::Sum)(source, kernel, d, sums);
  if (!(sums[3] > 0)) return Eigen::Vector3f::Zero();
  return Eigen::Vector3f(sums[0], sums[1], sums[2]) / sums[3];
}

}  // namespace lorgnette

#endif  // HWY_ONCE
