// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/units.h"
#include "render/environment.h"

namespace lorgnette {
namespace {

// Texels of the octahedral map, without its border: 2.5 a deviation of the lobe cos^n, which is
// 1 / sqrt(n), and no more than the narrow lobes of light cells need.
constexpr double kMapTexelsADeviation = 2.5;
constexpr unsigned kLeastSide = 8, kMostSide = 64;

int MapSide(double exponent) {
  const double wanted = kPi * kMapTexelsADeviation * std::sqrt(std::max(exponent, 1.0));
  return int(std::clamp(std::bit_ceil(unsigned(std::min(wanted, 1e6))), kLeastSide, kMostSide));
}

// The environment is first reduced to a width that gives the lobe cos^n, of deviation 1 / sqrt(n),
// two texels a deviation.
constexpr double kTexelsADeviation = 2;
constexpr unsigned kLeastSourceWidth = 32, kMostSourceWidth = 256;

int SourceWidth(double exponent) {
  const double wanted = 2 * kPi * kTexelsADeviation * std::sqrt(std::max(exponent, 1.0));
  return int(std::clamp(std::bit_ceil(unsigned(std::min(wanted, 1e6))), kLeastSourceWidth,
                        kMostSourceWidth));
}

// Octahedral coordinates in [-1, 1] of a direction, and back.
Eigen::Vector2f Fold(const Eigen::Vector3f& d) {
  const float scale = 1.0f / (std::abs(d.x()) + std::abs(d.y()) + std::abs(d.z()));
  const float x = d.x() * scale, y = d.y() * scale;
  if (d.z() >= 0) return {x, y};
  return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y)};
}

Eigen::Vector3f Unfold(float x, float y) {
  // Past the square's edge the map continues as its own mirror image about the edge's middle.
  if (std::abs(x) > 1) {
    x = std::copysign(2 - std::abs(x), x);
    y = -y;
  }
  if (std::abs(y) > 1) {
    y = std::copysign(2 - std::abs(y), y);
    x = -x;
  }
  Eigen::Vector3f d(x, y, 1 - std::abs(x) - std::abs(y));
  if (d.z() < 0) {
    const float folded_x = std::copysign(1 - std::abs(y), x);
    const float folded_y = std::copysign(1 - std::abs(x), y);
    d.x() = folded_x;
    d.y() = folded_y;
  }
  return d.normalized();
}

// One row of texels of the reduced environment: they share their elevation and solid angle.
struct SourceRow {
  float sin_lat, cos_lat, weight;
};

struct Source {
  ImageRgbF map;
  std::vector<SourceRow> rows;
  std::vector<Eigen::Vector2f> columns;  // -sin lon, cos lon
  float columns_a_radian = 1;            // of longitude

  // The column, in fractions, whose middle lies at a longitude.
  float ColumnAt(float lon) const { return (lon + float(kPi)) * columns_a_radian - 0.5f; }
};

// The map on a grid fine enough for the kernel, where its own has fewer texels.
ImageRgbF Interpolated(const Environment& environment, int width, int height) {
  const Environment grid(ImageRgbF(width, height));
  ImageRgbF map(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector3f light = environment.Radiance(grid.Direction(x + 0.5, y + 0.5));
      std::copy(light.data(), light.data() + 3, map.at(x, y));
    }
  }
  return map;
}

Source Reduce(const Environment& environment, int width) {
  std::optional<ImageRgbF> finer;
  if (environment.map().width < width || environment.map().height < width / 2) {
    finer = Interpolated(environment, width, width / 2);
  }
  const ImageRgbF& in = finer ? *finer : environment.map();
  const int factor = std::max(1, in.width / width);
  Source out;
  out.map = ImageRgbF((in.width + factor - 1) / factor, (in.height + factor - 1) / factor);
  out.rows.resize(std::size_t(out.map.height));
  tbb::parallel_for(0, out.map.height, [&](int y) {
    const int y1 = std::min((y + 1) * factor, in.height);
    for (int x = 0; x < out.map.width; ++x) {
      const int x1 = std::min((x + 1) * factor, in.width);
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int v = y * factor; v < y1; ++v) {
        for (int u = x * factor; u < x1; ++u) sum += Eigen::Map<const Eigen::Vector3f>(in.at(u, v));
      }
      sum /= float((y1 - y * factor) * (x1 - x * factor));
      std::copy(sum.data(), sum.data() + 3, out.map.at(x, y));
    }
    const double lat = kPi * (0.5 - 0.5 * (y * factor + y1) / in.height);
    out.rows[std::size_t(y)] = {float(std::sin(lat)), float(std::cos(lat)),
                                float(std::cos(lat) * (y1 - y * factor))};
  });
  out.columns_a_radian = float(in.width / (2 * kPi * factor));
  for (int x = 0; x < out.map.width; ++x) {
    const int x1 = std::min((x + 1) * factor, in.width);
    const double lon = 2 * kPi * (0.5 * (x * factor + x1) / in.width - 0.5);
    out.columns.emplace_back(float(-std::sin(lon)), float(std::cos(lon)));
  }
  return out;
}

// cos^exponent from cos_cut to 1, linear between 1025 cosines: to 2e-5 of the peak.
class Kernel {
 public:
  Kernel(double exponent, double cos_cut)
      : cos_cut_(float(cos_cut)), scale_(float(kSteps / (1 - cos_cut))) {
    for (int i = 0; i <= kSteps; ++i) {
      values_.push_back(float(std::pow(cos_cut + (1 - cos_cut) * i / kSteps, exponent)));
    }
    values_.push_back(values_.back());
  }
  float cos_cut() const { return cos_cut_; }
  float At(float cosine) const {
    const float at = std::min((cosine - cos_cut_) * scale_, float(kSteps));
    const int i = int(at);
    const float* v = &values_[std::size_t(i)];
    return v[0] + (at - float(i)) * (v[1] - v[0]);
  }

 private:
  static constexpr int kSteps = 1024;
  float cos_cut_, scale_;
  std::vector<float> values_;
};

// Mean of the map under the kernel about d.
Eigen::Vector3f Gather(const Source& source, const Eigen::Vector3f& d, const Kernel& kernel) {
  const float cos_cut = kernel.cos_cut();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  const float horizontal = std::sqrt(d.x() * d.x() + d.z() * d.z());
  const float middle = source.ColumnAt(std::atan2(-d.x(), d.z()));
  const int width = source.map.width;
  for (int y = 0; y < source.map.height; ++y) {
    const SourceRow& row = source.rows[std::size_t(y)];
    // The best any column of this row can do.
    const float best = horizontal * row.cos_lat, wanted = cos_cut - d.y() * row.sin_lat;
    if (best < wanted) continue;
    // Columns that can reach the cut lie this far to either side; one more for the last, which may
    // be narrower than the others.
    const float away =
        wanted <= -best ? float(width) : std::acos(wanted / best) * source.columns_a_radian + 2;
    const bool all = 2 * away + 1 >= float(width);
    const int first = all ? 0 : int(std::floor(middle - away));
    const int end = all ? width : int(std::ceil(middle + away)) + 1;
    for (int at = first; at < end; ++at) {
      const int x = at < 0 ? at + width : at < width ? at : at - width;
      const float* texel = source.map.at(x, y);
      const Eigen::Vector2f& column = source.columns[std::size_t(x)];
      const float cosine =
          d.y() * row.sin_lat + row.cos_lat * (d.x() * column.x() + d.z() * column.y());
      if (cosine < cos_cut) continue;
      const float w = row.weight * kernel.At(cosine);
      sum += w * Eigen::Map<const Eigen::Vector3f>(texel);
      weight += w;
    }
  }
  return weight > 0 ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Zero();
}

}  // namespace

BlurredEnvironment::BlurredEnvironment(const Environment& environment, double exponent)
    : side_(MapSide(exponent)), map_(side_ + 2, side_ + 2) {
  const Source source = Reduce(environment, SourceWidth(exponent));
  // Beyond this angle the kernel is below 1/1000 of its peak; at least three source texels wide,
  // so that a kernel finer than the map still finds one.
  const double cut = std::max(1 - std::pow(1e-3, 1 / std::max(exponent, 1e-3)),
                              1 - std::cos(3 * kPi / source.map.height));
  const Kernel kernel(exponent, std::max(1 - cut, 0.0));
  tbb::parallel_for(0, side_ + 2, [&](int y) {
    for (int x = 0; x < side_ + 2; ++x) {
      const Eigen::Vector3f d =
          Unfold(float(2 * (x - 0.5) / side_ - 1), float(2 * (y - 0.5) / side_ - 1));
      const Eigen::Vector3f mean = Gather(source, d, kernel);
      std::copy(mean.data(), mean.data() + 3, map_.at(x, y));
    }
  });
}

BlurredEnvironment BlurredEnvironment::ForCells(const Environment& environment, int cells) {
  // The lobe cos^n has the effective solid angle 2 pi / (n + 1); a cell has 4 pi / cells.
  return BlurredEnvironment(environment, 0.5 * cells - 1);
}

BlurredEnvironment BlurredEnvironment::ForPhong(const Environment& environment, double shininess) {
  return BlurredEnvironment(environment, shininess);
}

Eigen::Vector3f BlurredEnvironment::Radiance(const Eigen::Vector3f& direction) const {
  const Eigen::Vector2f p = Fold(direction);
  const float scale = 0.5f * float(side_);
  const float column = (p.x() + 1) * scale + 0.5f, row = (p.y() + 1) * scale + 0.5f;
  const int x = std::min(int(column), side_), y = std::min(int(row), side_);
  const float fx = column - float(x), fy = row - float(y);
  using Texel = Eigen::Map<const Eigen::Vector3f>;
  return (1 - fy) * ((1 - fx) * Texel(map_.at(x, y)) + fx * Texel(map_.at(x + 1, y))) +
         fy * ((1 - fx) * Texel(map_.at(x, y + 1)) + fx * Texel(map_.at(x + 1, y + 1)));
}

}  // namespace lorgnette
