// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/units.h"
#include "render/environment.h"
#include "render/lobe_mean.h"

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

LobeSource Reduce(const Environment& environment, int width) {
  std::optional<ImageRgbF> finer;
  if (environment.map().width < width || environment.map().height < width / 2) {
    finer = Interpolated(environment, width, width / 2);
  }
  const ImageRgbF& in = finer ? *finer : environment.map();
  const int factor = std::max(1, in.width / width);
  LobeSource out;
  out.width = (in.width + factor - 1) / factor;
  const int height = (in.height + factor - 1) / factor;
  out.rows.resize(std::size_t(height));
  out.columns_a_radian = float(in.width / (2 * kPi * factor));
  for (auto& channel : out.channels) channel.assign(out.rows.size() * out.stride(), 0);
  tbb::parallel_for(0, height, [&](int y) {
    const int y1 = std::min((y + 1) * factor, in.height);
    for (int x = 0; x < out.width; ++x) {
      const int x1 = std::min((x + 1) * factor, in.width);
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int v = y * factor; v < y1; ++v) {
        for (int u = x * factor; u < x1; ++u) sum += Eigen::Map<const Eigen::Vector3f>(in.at(u, v));
      }
      sum /= float((y1 - y * factor) * (x1 - x * factor));
      for (std::size_t c = 0; c < 3; ++c) {
        float* row = out.channels[c].data() + std::size_t(y) * out.stride();
        row[x] = row[x + out.width] = sum[Eigen::Index(c)];
      }
    }
    const double lat = kPi * (0.5 - 0.5 * (y * factor + y1) / in.height);
    out.rows[std::size_t(y)] = {float(std::sin(lat)), float(std::cos(lat)),
                                float(std::cos(lat) * (y1 - y * factor))};
  });
  out.minus_sin_lon.assign(out.stride(), 0);
  out.cos_lon.assign(out.stride(), 0);
  for (int x = 0; x < out.width; ++x) {
    const int x1 = std::min((x + 1) * factor, in.width);
    const double lon = 2 * kPi * (0.5 * (x * factor + x1) / in.width - 0.5);
    for (const int at : {x, x + out.width}) {
      out.minus_sin_lon[std::size_t(at)] = float(-std::sin(lon));
      out.cos_lon[std::size_t(at)] = float(std::cos(lon));
    }
  }
  return out;
}

}  // namespace

BlurredEnvironment::BlurredEnvironment(const Environment& environment, double exponent)
    : side_(MapSide(exponent)), map_(side_ + 2, side_ + 2) {
  const LobeSource source = Reduce(environment, SourceWidth(exponent));
  // Beyond this angle the kernel is below 1/1000 of its peak; at least three source texels wide,
  // so that a kernel finer than the map still finds one.
  const double cut = std::max(1 - std::pow(1e-3, 1 / std::max(exponent, 1e-3)),
                              1 - std::cos(3 * kPi / double(source.rows.size())));
  const LobeKernel kernel(exponent, std::max(1 - cut, 0.0));
  tbb::parallel_for(0, side_ + 2, [&](int y) {
    for (int x = 0; x < side_ + 2; ++x) {
      const Eigen::Vector3f d =
          Unfold(float(2 * (x - 0.5) / side_ - 1), float(2 * (y - 0.5) / side_ - 1));
      const Eigen::Vector3f mean = LobeMean(source, kernel, d);
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
