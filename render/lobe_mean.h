// SPDX-License-Identifier: Apache-2.0
// Means of a lat-long map under a lobe cos^n about a direction. Internal to render/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/units.h"

namespace lorgnette {

// A lat-long map by columns of the processor's width: what the mean of a lobe reads.
struct LobeSource {
  // Texels of one row share their elevation and solid angle.
  struct Row {
    float sin_lat, cos_lat, weight;
  };
  static constexpr std::size_t kOver = 16;  // floats that may be read past a row's end

  int width = 0;
  std::vector<Row> rows;
  float columns_a_radian = 1;  // of longitude
  // By column, twice around and kOver more, so that lobes across the seam are whole: -sin and cos
  // of its longitude, and, a row after the other, the map's channels.
  std::vector<float> minus_sin_lon, cos_lon;
  std::vector<float> channels[3];

  std::size_t stride() const { return 2 * std::size_t(width) + kOver; }
  // The column, in fractions, whose middle lies at a longitude.
  float ColumnAt(float lon) const { return (lon + float(kPi)) * columns_a_radian - 0.5f; }
};

// cos^exponent from cos_cut to 1, linear between 1025 cosines: to 2e-5 of the peak.
class LobeKernel {
 public:
  LobeKernel(double exponent, double cos_cut);
  static constexpr int kSteps = 1024;
  float cos_cut() const { return cos_cut_; }
  float scale() const { return scale_; }  // steps a unit of the cosine
  // At the steps, and once more past the last.
  const float* values() const { return values_.data(); }

 private:
  float cos_cut_, scale_;
  std::vector<float> values_;
};

// Mean under the kernel about the unit direction d; zero where no texel lies within its cut.
Eigen::Vector3f LobeMean(const LobeSource& source, const LobeKernel& kernel,
                         const Eigen::Vector3f& d);

}  // namespace lorgnette
